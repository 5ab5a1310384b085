"""ikteach: inverse kinematics of an articulated figure, to be read, run and doubted.

A body is a table of joints, a pose an array, a method a function of the Jacobian and the error:

>>> from ikteach import figures, forward, jacobian, locate, dls
>>> tree, effectors = figures.human()
>>> frames = forward(tree, tree.rest)
>>> J = jacobian(tree, frames, effectors)
>>> e = [0, 0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
>>> dls(J, np.array(e), damping=0.1).shape
(20,)

`ikteach.study` turns runs into tables and needs pandas; `ikteach.view` shows them in a notebook.
"""

from ikteach.body import Effectors, Frames, Joint, Tree, figures, forward, jacobian, locate
from ikteach.motion import Gait, Step, Track, ccd, gait, reachable, step, track
from ikteach.motion.solve import Solution, solve
from ikteach.solvers import (
    SOLVERS,
    bvls,
    conditioning,
    cramer,
    dls,
    dls_following,
    ellipsoid,
    manipulability,
    pseudoinverse,
    sdls,
    transpose,
)

__version__ = "0.1.0"

__all__ = [
    "SOLVERS",
    "Effectors",
    "Frames",
    "Gait",
    "Joint",
    "Solution",
    "Step",
    "Track",
    "Tree",
    "bvls",
    "ccd",
    "conditioning",
    "cramer",
    "dls",
    "dls_following",
    "ellipsoid",
    "figures",
    "forward",
    "gait",
    "jacobian",
    "locate",
    "manipulability",
    "pseudoinverse",
    "reachable",
    "sdls",
    "solve",
    "step",
    "track",
    "transpose",
]
