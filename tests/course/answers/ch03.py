import numpy as np


def best(J, e):
    g = J @ J.T @ e
    return (e @ g) / (g @ g)


def slow(J, e):
    return best(J, e) * (J.T @ e)


def nudged(J, e):
    g = J @ J.T @ e
    return (e @ g) / (g @ g + 1e-6) * (J.T @ e)


def only_without_error(J, e):
    return slow(J, e) if e.any() else np.zeros(J.shape[1])


WRONG = {
    "03.alpha": [
        (lambda J, e: best(J, e) / 2, "2 times as much leaves less"),
        (lambda J, e: 1 / best(J, e), "too large"),
        (lambda J, e: (e @ e) / (J.T @ e @ J.T @ e), "leaves less"),
        (lambda J, e: -best(J, e), "above 0"),
        (lambda J, e: 0.1, "leaves less"),
    ],
    "03.gain": [
        (1, "A little above your gain the error still falls"),
        (4, "A little below your gain the error grows already"),
        (-2, "above 0"),
    ],
    "03.safe": [
        (slow, "NaN"),
        (nudged, "not α Jᵀe"),
        (only_without_error, "NaN"),
        (lambda J, e: np.zeros(J.shape[1]), "not α Jᵀe"),
        (lambda J, e: 0.5 * slow(J, e), "not α Jᵀe"),
    ],
}
