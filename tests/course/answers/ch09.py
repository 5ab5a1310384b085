"""Wrong answers to chapter 9 (see `tests.course.answers`)."""

import numpy as np


def everywhere(method):
    return dict.fromkeys(("foot.l", "foot.r", "hand.r", "hand.l"), method)


WRONG = {
    "09.mix": [
        (everywhere("transpose"), "mm from their targets"),
        (everywhere("sdls"), "shakes by"),
        (everywhere("pseudoinverse"), "shakes by"),
        (everywhere("dls") | {"foot.l": "newton"}, "is none of"),
        ({"foot.l": "sdls"}, "has no method"),
        (everywhere("sdls") | {"head": "dls"}, "no effector"),
        (everywhere(["sdls"]), "a list, where a name is wanted"),
        ("sdls", "a dictionary"),
        (everywhere("pseudoinverse") | {"hand.l": "sdls"}, "shakes by"),  # it may freeze
    ],
    "09.solver": [
        (lambda J, e: -J.T @ e, "leads away from"),
        (lambda J, e: np.zeros(J.shape[1]), "does not lead to"),
        (lambda J, e: 1e-4 * J.T @ e, "less than a quarter should be left"),
        (lambda J, e: J.T @ np.linalg.solve(J @ J.T, e), "LinAlgError"),
        (lambda J, e: J @ e, "raised ValueError"),
        (lambda J, e: J.T @ e / np.linalg.norm(e), "NaN"),
        (lambda J, e: J.T @ e + 0.01, "Where the error is 0"),
        (lambda J, e: J.T @ (J @ (J.T @ e)) / 0, "infinite"),
    ],
}
