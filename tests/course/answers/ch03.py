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
        (lambda J, e: best(J, e) / 2, "leaves less"),
        (lambda J, e: 1 / best(J, e), "leaves"),
        (lambda J, e: (e @ e) / (J.T @ e @ J.T @ e), "leaves less"),
        (lambda J, e: -best(J, e), "goes downhill"),
        (lambda J, e: 0.1, "leaves less"),
    ],
    "03.gain": [
        (lambda gain, best: 1 - (1 - best) * gain, "leaves"),
        (lambda gain, best: best + (1 - gain) ** 2, "leaves"),
        (lambda gain, best: (1 - gain) ** 2, "leaves"),
        (lambda gain, best: 2, "leaves"),
        (lambda gain, best: 1 - (1 - best) * gain * (2 - gain) / 2, "leaves"),
        (lambda gain, best: np.sqrt(1 - (1 - best) * gain * (2 - gain)), "leaves"),
    ],
    "03.safe": [
        (slow, "NaN"),
        (nudged, "not α Jᵀe"),
        (only_without_error, "NaN"),
        (lambda J, e: np.zeros(J.shape[1]), "not α Jᵀe"),
        (lambda J, e: 0.5 * slow(J, e), "not α Jᵀe"),
    ],
}
