"""Inverse kinematics as a first program writes it: 4 × 4 matrices and loops over joints.

The foil of the speed bench. It computes the same pose and is easy to read; what it lacks is the
shape of the data: every product is of one joint, and every one is a call.
"""

import numpy as np

from ikteach.body.tree import GROUND


def translation(offset):
    """The homogeneous matrix (4, 4) that moves by offset."""
    T = np.eye(4)
    T[:3, 3] = offset
    return T


def rotation(axis, angle):
    """Rodrigues' rotation as a homogeneous matrix (4, 4)."""
    x, y, z = axis
    c, s = np.cos(angle), np.sin(angle)
    t = 1 - c
    return np.array(
        [
            [t * x * x + c, t * x * y - s * z, t * x * z + s * y, 0],
            [t * x * y + s * z, t * y * y + c, t * y * z - s * x, 0],
            [t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0],
            [0, 0, 0, 1],
        ]
    )


def forward(tree, theta):
    """The matrix (4, 4) of every joint, one after the other."""
    matrices = []
    for j, parent in enumerate(tree.parents):
        T = np.eye(4) if parent == GROUND else matrices[parent]
        T = T @ translation(tree.offsets[j])
        if tree.slide[j]:
            T = T @ translation(theta[j] * tree.axes[j])
        else:
            T = T @ rotation(tree.axes[j], theta[j])
        matrices.append(T)
    return matrices


def locate(effectors, matrices):
    """Positions of the effectors, a list of (3,)."""
    return [
        (matrices[j] @ np.append(offset, 1))[:3]
        for j, offset in zip(effectors.joints, effectors.offsets, strict=True)
    ]


def jacobian(tree, effectors, matrices, points):
    """J (3k, n), one column of one effector at a time, up its chain."""
    J = np.zeros((3 * len(effectors), len(tree)))
    for i, point in enumerate(points):
        j = effectors.joints[i]
        while j != GROUND:
            axis = matrices[j][:3, :3] @ tree.axes[j]
            column = axis if tree.slide[j] else np.cross(axis, point - matrices[j][:3, 3])
            J[3 * i : 3 * i + 3, j] = column
            j = tree.parents[j]
    return J


def dls_step(tree, effectors, theta, targets, damping):
    """One step of damped least squares: the new pose (n,)."""
    matrices = forward(tree, theta)
    points = locate(effectors, matrices)
    J = jacobian(tree, effectors, matrices, points)
    e = np.concatenate([t - s for t, s in zip(targets, points, strict=True)])
    y = np.linalg.solve(J @ J.T + damping**2 * np.eye(len(e)), e)
    return theta + J.T @ y
