import numpy as np

from ikteach.solvers.sdls import lengths


def parts(J):
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    N = lengths(U).sum(axis=0)
    rho = lengths(J).sum(axis=0)
    return N, rho, sigma, Vt


def unbounded(J, max_angle):
    N, rho, sigma, Vt = parts(J)
    return N / (abs(Vt) @ rho / sigma) * 3 * max_angle


def signed(J, max_angle):
    N, rho, sigma, Vt = parts(J)
    return np.minimum(1, N / (Vt @ rho / sigma)) * max_angle


def without_sigma(J, max_angle):
    N, rho, _, Vt = parts(J)
    return np.minimum(1, N / (abs(Vt) @ rho)) * max_angle


def without_n(J, max_angle):
    _, rho, sigma, Vt = parts(J)
    return np.minimum(1, 1 / (abs(Vt) @ rho / sigma)) * max_angle


def upside_down(J, max_angle):
    N, rho, sigma, Vt = parts(J)
    return np.minimum(1, abs(Vt) @ rho / sigma / N) * max_angle


WRONG = {
    "06.gamma": [
        (unbounded, "above γ_max"),
        (signed, "below 0"),
        (without_sigma, "in centimetres"),
        (without_n, "is wanted"),
        (upside_down, "is wanted"),
        (lambda J, max_angle: np.full(min(J.shape), max_angle), "is wanted"),
    ],
    "06.clamp": [
        (lambda phi, bound: np.clip(phi, -bound, bound), "by the same share"),
        (lambda phi, bound: phi * min(1, bound / max(phi.max(), 1e-12)), "exceeds the bound"),
        (lambda phi, bound: phi * bound / max(abs(phi).max(), 1e-12), "must stay as it is"),
        (
            lambda phi, bound: phi * min(1, bound / max(np.linalg.norm(phi), 1e-12)),
            "must stay as it is",
        ),
        (lambda phi, bound: phi / abs(phi).max() * min(abs(phi).max(), bound), "NaN"),
    ],
}
