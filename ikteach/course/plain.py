"""Formulas in the fewest lines: one pose, hinges alone, no checks. Each is shown equal to its own.

The package's functions take many poses at once, and refuse what does not fit; these are for the
reader. `source` shows both.
"""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body import Effectors, Frames, Tree, forward, jacobian, locate
from ikteach.body.figures import human
from ikteach.body.tree import GROUND
from ikteach.solvers import dls, pseudoinverse, transpose
from ikteach.study.experiment import starts

POSES = 20


def plain_forward(tree: Tree, theta: Array) -> tuple[Array, Array]:
    """Find R_j = R_parent R(v_j, θ_j) and p_j = p_parent + R_parent o_j, from the ground up."""
    R, p = np.zeros((len(tree), 3, 3)), np.zeros((len(tree), 3))
    for j, parent in enumerate(tree.parents):
        R_parent, p_parent = (
            (np.eye(3), np.zeros(3)) if parent == GROUND else (R[parent], p[parent])
        )
        R[j] = R_parent @ turn(tree.axes[j], theta[j])
        p[j] = p_parent + R_parent @ tree.offsets[j]
    return R, p


def turn(v: Array, angle: float) -> Array:
    """Write R(v, θ) = vvᵀ + sin θ [v]× + cos θ (I − vvᵀ) (Rodrigues)."""
    across = np.cross(v, np.eye(3)).T  # [v]×
    return np.outer(v, v) + np.sin(angle) * across + np.cos(angle) * (np.eye(3) - np.outer(v, v))


def plain_jacobian(frames: Frames, effectors: Effectors) -> Array:
    """Write v_j × (s_i − p_j) where joint j carries effector i, and else 0."""
    s, p, v = locate(frames, effectors), frames.positions, frames.axes
    J = np.zeros((len(s), 3, len(p)))
    for i, j in np.argwhere(effectors.carried):
        J[i, :, j] = np.cross(v[j], s[i] - p[j])
    return J.reshape(-1, len(p))


def plain_transpose(J: Array, e: Array) -> Array:
    """Go down Jᵀe as far as the model gains."""
    toward = J @ J.T @ e
    alpha = (e @ toward) / (toward @ toward)
    return alpha * J.T @ e


def plain_pseudoinverse(J: Array, e: Array) -> Array:
    """Add (u_iᵀe / σ_i) v_i over all σ_i above a hundredth of the largest."""
    U, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    kept = sigma > 0.01 * sigma[0]
    return Vt[kept].T @ (U[:, kept].T @ e / sigma[kept])


def plain_dls(J: Array, e: Array, damping: float = 0.1) -> Array:
    """Solve Δθ = Jᵀ (JJᵀ + λ²I)⁻¹ e."""
    A = J @ J.T + damping**2 * np.eye(len(e))
    return J.T @ np.linalg.solve(A, e)


def of_forward(tree: Tree, effectors: Effectors, theta: Array, e: Array) -> float:
    """Compare joints and orientations."""
    R, p = plain_forward(tree, theta)
    frames = forward(tree, theta)
    return float(max(abs(frames.orientations - R).max(), abs(frames.positions - p).max()))


def of_jacobian(tree: Tree, effectors: Effectors, theta: Array, e: Array) -> float:
    """Compare all entries of J."""
    frames = forward(tree, theta)
    return float(abs(jacobian(tree, frames, effectors) - plain_jacobian(frames, effectors)).max())


def of_solver(ours: Any, plain: Any, tree: Tree, effectors: Effectors, *pose: Array) -> float:
    """Compare two steps, in parts of the longer one's length."""
    theta, e = pose
    J = jacobian(tree, forward(tree, theta), effectors)
    theirs = plain(J, e)
    return float(abs(ours(J, e) - theirs).max() / abs(theirs).max())


PLAIN: Mapping[Any, tuple[list[Any], Callable[..., float]]] = {
    forward: ([plain_forward, turn], of_forward),
    jacobian: ([plain_jacobian], of_jacobian),
    transpose: ([plain_transpose], partial(of_solver, transpose, plain_transpose)),
    pseudoinverse: ([plain_pseudoinverse], partial(of_solver, pseudoinverse, plain_pseudoinverse)),
    dls: ([plain_dls], partial(of_solver, dls, plain_dls)),
}


def largest_difference(thing: Any) -> float:
    """Compare a function with its plain version, on many poses."""
    tree, effectors = human()
    errors = 0.1 * np.random.default_rng(3).normal(size=(POSES, 3 * len(effectors)))
    _, compare = PLAIN[thing]
    poses = zip(starts(tree, POSES + 1)[1:], errors, strict=True)
    return max(compare(tree, effectors, theta, e) for theta, e in poses)
