import numpy as np

from ikteach.solvers import dls


def by(factor):
    def damped(J, e, damping):
        U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
        return Vt.T @ (factor(sigma, damping) * (U.T @ e))

    return damped


WRONG = {
    "05.svd": [
        (by(lambda s, d: 1 / s), "longer than"),
        (by(lambda s, d: s / (s**2 + d)), "does not make"),
        (by(lambda s, d: 1 / (s + d)), "longer than"),
        (by(lambda s, d: s / (s**2 + 4 * d**2)), "does not make"),
        (lambda J, e, damping: dls(J, e, damping=0.5), "longer than"),
    ],
    "05.bound": [
        (lambda e, longest: np.linalg.norm(e) / longest, "a smaller one is too"),
        (lambda e, longest: longest / (2 * np.linalg.norm(e)), "times the longest"),
        (lambda e, longest: abs(e).max() / (2 * longest), "times the longest"),
        (lambda e, longest: 0.1, "times the longest"),
    ],
    "05.unit": [
        (lambda damping, per_metre, per_radian: damping, "another Δθ"),
        (lambda damping, per_metre, per_radian: damping * per_metre, "another Δθ"),
        (lambda damping, per_metre, per_radian: damping * per_metre * per_radian, "another Δθ"),
        (lambda damping, per_metre, per_radian: damping / per_metre / per_radian, "another Δθ"),
        (lambda damping, per_metre, per_radian: damping * per_metre**2 / per_radian, "another Δθ"),
    ],
}
