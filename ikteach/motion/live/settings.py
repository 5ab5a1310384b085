"""All that can be set about a session, as it is at first, and the same in plain words."""

import inspect
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from ikteach.arrays import Array, frozen
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.extent import extent
from ikteach.body.figures import Figure, human, walker
from ikteach.body.forward import pose
from ikteach.checks import shown
from ikteach.motion.gait import LIMBS, stature, walking
from ikteach.motion.mix import Mix
from ikteach.motion.path import Course, Motion, swinging
from ikteach.motion.paths.walk import Walk
from ikteach.motion.step import step
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, Solver, dls, name_of, transpose

DAMPING = inspect.signature(dls).parameters["damping"].default  # for a human [m/rad]
# The options of `step` that a session takes: all but the mobility, which is the gait's wound, the
# wish, which is the gait's too, and the frames, which are those of the poses.
OPTIONS = [
    name
    for name, parameter in inspect.signature(step).parameters.items()
    if parameter.kind is parameter.KEYWORD_ONLY and name not in ("mobility", "wish", "frames")
]
SESSION = (
    "figure",
    "gait",
    "methods",
    "method",
    "dt",
    "keep",
    "keep_events",
    "iterations",
    "start",
)  # options of a session


@dataclass(frozen=True, eq=False)
class Settings:
    """All that can be set about a session.

    It is also all that undo puts back.

    gait     the motion of the targets, and
    course   the same in the place and size of the body
    methods  {name: solver}
    method   the name of the one that is shown
    options  of `step`, the same for all methods
    caps     {method: max_step [rad] or None} of methods that have their own
    by_hand  the targets (k, 3) that were put by hand [m], None where the gait moves them
    iterations  steps a tick
    """

    gait: Motion
    course: Course
    methods: dict[str, Solver]
    method: str
    options: Mapping[str, Any] = field(default_factory=dict)
    caps: Mapping[str, float | None] = field(default_factory=dict)
    by_hand: Array | None = None
    iterations: int = 1

    def options_of(self, method: str) -> dict[str, Any]:
        """Give the options of `step` for one method."""
        own = {"max_step": self.caps[method]} if method in self.caps else {}
        return {**self.options, **own}

    def options_of_all(self) -> dict[str, Any]:
        """Return the options of one `step` of all methods.

        For M methods max_step is (M,) [rad] or None.
        """
        caps = [self.options_of(name).get("max_step") for name in self.methods]
        if all(cap is None for cap in caps):
            return {**self.options, "max_step": None}
        return {**self.options, "max_step": [np.inf if cap is None else cap for cap in caps]}


def figure_of(value: Any) -> Figure:
    """Check a figure, or a pair of its parts.

    TypeError or ValueError says why it is none.
    """
    if value is None:
        return human()
    if not (isinstance(value, tuple) and len(value) == 2):
        raise TypeError(
            "a figure is its tree and its effectors, as figures.human() gives them, not "
            f"{'a Tree alone' if isinstance(value, Tree) else shown(value)}"
        )
    tree, effectors = value
    if not isinstance(tree, Tree):
        raise TypeError(f"the tree must be a Tree, not {shown(tree)}")
    if not isinstance(effectors, Effectors):
        raise TypeError(f"the effectors must be Effectors, not {shown(effectors)}")
    joints = effectors.carried.shape[-1]
    if joints != len(tree):
        raise ValueError(f"these effectors are of a tree of {joints} joints, not of {len(tree)}")
    return Figure(tree, effectors)


def motion_of(tree: Tree, effectors: Effectors, gait: Any = None) -> tuple[Motion, Course]:
    """Return a motion, and its course for this figure.

    If none is given, it is the usual motion of the figure: one that can walk walks, a walker with a
    free pelvis as naturally as it can, and the targets of any other go where its own joints would
    swing them. TypeError for anything but a motion,
    ValueError for a motion of other effectors.
    """
    if gait is None:
        walks = set(effectors.names) == set(LIMBS) or stature(tree, effectors)
        free = set(effectors.names) == set(Walk.names) and set(walker().tree.names) <= set(
            tree.names
        )
        gait = walking if walks else Walk() if free else swinging(tree, effectors)
    if not isinstance(gait, Motion):
        raise TypeError(f"a motion is a Gait or a Path, such as gait.walking, not {shown(gait)}")
    return gait, gait.on(tree, effectors)


def pose_of(tree: Tree, start: Any = None) -> Array:
    """Check a pose to start from; None is the rest pose.

    ValueError if it is none, or beyond a limit.
    """
    if start is None:
        return tree.rest
    theta = pose(tree, start)
    if theta.ndim != 1:
        raise ValueError(f"the start is one pose ({len(tree)},), not {theta.shape}")
    out = (theta < tree.lower) | (theta > tree.upper)
    if out.any():
        raise ValueError(f"the start has {shown(tree.names[out.argmax()])} beyond its limits")
    return frozen(theta)


def usual_methods(tree: Tree, effectors: Effectors) -> dict[str, Solver]:
    """Return the four methods.

    The λ of dls is in proportion to the body: a length per radian. A slide without limits, as a
    free pelvis has three, says nothing of its size.
    """
    known = stature(tree, effectors)
    endless = tree.slide & (np.isinf(tree.lower) | np.isinf(tree.upper))
    lower, upper = (np.where(endless, tree.rest, end) for end in (tree.lower, tree.upper))
    radius = extent(replace(tree, lower=lower, upper=upper), effectors).radius
    size = known[0] if known else radius / extent(*human()).radius
    return {**SOLVERS, **({} if size == 1 else {"dls": partial(dls, damping=DAMPING * size)})}


def check_options(options: Mapping[str, Any], known: Iterable[str] = ()) -> None:
    """Check the names of options.

    LookupError for the first that is neither an option of `step` nor one of these names.
    """
    names = [*known, *OPTIONS]
    for name in options:
        if name not in names:
            raise LookupError(unknown("option", name, names))


def try_options(tree: Tree, effectors: Effectors, options: Mapping[str, Any]) -> None:
    """Take a step to where the figure is.

    The errors are those of `step`.
    """
    at = locate(forward(tree, tree.rest), effectors)
    step(tree, tree.rest, effectors, at, transpose, **options)


def in_words(value: Any) -> Any:
    """Write settings as a file can hold them.

    A file holds numbers, words, lists and dictionaries of them. A function becomes its name, one
    with bound options {"function": name, option: value}.
    """
    if isinstance(value, Mix):
        return {"function": "mix", **in_words(value.methods)}
    if isinstance(value, Mapping):
        return {str(name): in_words(one) for name, one in value.items()}
    if isinstance(value, partial):
        return {"function": name_of(value), **in_words(value.keywords)}
    if callable(value):
        return name_of(value)
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [in_words(one) for one in value]
    return value
