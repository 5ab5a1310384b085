"""Effectors that are pulled in the scene, by mouse or keys: the joints' sliders follow."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body import forward, locate
from ikteach.motion import step
from ikteach.solvers import dls_following
from ikteach.view.live.bench import Bench
from ikteach.view.live.joints import Joints
from ikteach.view.webgl.scene import Scene
from ikteach.view.webgl.targets import Targets

STEPS = 8  # of the solver, per move of the hand
LARGEST = np.radians(20)  # [rad] a joint turns in one of them


def handles_of(scene: Scene, joints: Joints) -> Targets:
    """Make handles at the effectors of the rest pose."""
    tree, effectors = joints.figure
    return Targets(scene, locate(forward(tree, tree.rest), effectors), slot=None)


def pull(bench: Bench, handles: Targets, joints: Joints) -> None:
    """Have the sliders follow a pulled effector.

    The others stay if they can.
    """
    tree, effectors = joints.figure

    @handles.on_change
    def pulled(index: int, position: Array) -> None:
        theta = joints.theta(bench.values)
        goals = locate(forward(tree, theta), effectors)
        goals[index] = position
        for _ in range(STEPS):
            theta = step(tree, theta, effectors, goals, dls_following, max_step=LARGEST).theta
        joints.put(theta)
