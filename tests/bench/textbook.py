"""Inverse kinematics as a first program writes it: loops over joints, small vectors.

The foil of the speed bench. It computes the same pose and is easy to read; what it lacks is the
shape of the data: every product is of three numbers at a time, and every one is a call.
"""

import numpy as np

from ikteach.body.tree import GROUND


def rotation(axis, angle):
    """Rodrigues' rotation matrix (3, 3)."""
    x, y, z = axis
    c, s = np.cos(angle), np.sin(angle)
    t = 1 - c
    return np.array(
        [
            [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
            [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
        ]
    )


def forward(tree, theta):
    """Positions, axes and rotations of the joints, one after the other."""
    positions, axes, rotations = [], [], []
    for j, parent in enumerate(tree.parents):
        R = np.eye(3) if parent == GROUND else rotations[parent]
        p = np.zeros(3) if parent == GROUND else positions[parent]
        axis = R @ tree.axes[j]
        p = p + R @ tree.offsets[j]
        if tree.slide[j]:
            p = p + theta[j] * axis
        else:
            R = R @ rotation(tree.axes[j], theta[j])
        positions.append(p)
        axes.append(axis)
        rotations.append(R)
    return positions, axes, rotations


def jacobian(tree, effectors, positions, axes, points):
    """J (3k, n), one column of one effector at a time."""
    J = np.zeros((3 * len(effectors), len(tree)))
    for i, point in enumerate(points):
        for j in range(len(tree)):
            if effectors.carried[i, j]:
                column = axes[j] if tree.slide[j] else np.cross(axes[j], point - positions[j])
                J[3 * i : 3 * i + 3, j] = column
    return J


def dls_step(tree, effectors, theta, targets, damping):
    """One step of damped least squares: the new pose (n,)."""
    positions, axes, rotations = forward(tree, theta)
    points = [
        positions[j] + rotations[j] @ offset
        for j, offset in zip(effectors.joints, effectors.offsets, strict=True)
    ]
    J = jacobian(tree, effectors, positions, axes, points)
    e = np.concatenate([t - s for t, s in zip(targets, points, strict=True)])
    y = np.linalg.solve(J @ J.T + damping**2 * np.eye(len(e)), e)
    return theta + J.T @ y
