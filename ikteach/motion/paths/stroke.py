"""A stroke of the hand as a curve: closed, even and round; and how much of it can be reached."""

from dataclasses import replace

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.figures import Figure
from ikteach.checks import numbers, shown
from ikteach.motion.reachable import nearest
from ikteach.names import unknown

POINTS = 64  # of a curve that was drawn
FINE = 8  # places for each of them while it is made round
TRIES = 400  # poses whose places tell where most of a reach is
TREMBLE = 0.012  # standard deviation of what rounds it, as a share of its length


def closed(stroke: ArrayLike) -> Array:
    """Make a closed curve (`POINTS`, 3) of a stroke (T, 3) [m].

    From the last point it goes straight back to the first. Its points are evenly spaced, and what
    is shorter than the hand trembles is smoothed away. ValueError for fewer than two places.
    """
    drawn = numbers("the stroke", stroke)
    if drawn.ndim != 2 or drawn.shape[1] != 3 or not np.isfinite(drawn).all():
        raise ValueError(f"a stroke is points (T, 3), not {shown(stroke)}")
    return evenly(rounded(evenly(drawn, FINE * POINTS), TREMBLE), POINTS)


def evenly(points: ArrayLike, count: int) -> Array:
    """Go round a closed polygon (T, d) in `count` steps of one length.

    ValueError if all of it is in one place.
    """
    round_ = np.concatenate([points, np.asarray(points)[:1]])
    steps = np.linalg.norm(np.diff(round_, axis=0), axis=1)
    along = np.append(0, steps.cumsum())
    if not along[-1] > 0:
        raise ValueError("the points of the curve are all in one place")
    at = along[-1] * np.arange(count) / count
    return np.stack([np.interp(at, along, column) for column in round_.T], axis=-1)


def rounded(values: Array, sigma: float) -> Array:
    """Smooth values (T, ...) once round by a normal curve of that deviation [share of it]."""
    T = len(values)
    f = np.fft.rfftfreq(T, 1 / T).reshape(-1, *[1] * (values.ndim - 1))
    heard = np.exp(-0.5 * (2 * np.pi * f * sigma) ** 2)
    return np.fft.irfft(np.fft.rfft(values, axis=0) * heard, T, axis=0)


def anchored(tree: Tree) -> Tree:
    """Let no slide go on without end.

    For a body that floats reaches everything.
    """
    endless = tree.slide & np.isinf([tree.lower, tree.upper]).any(axis=0)
    lower, upper = (np.where(endless, tree.rest, end) for end in (tree.lower, tree.upper))
    return replace(tree, lower=lower, upper=upper)


def carried_alone(figure: Figure, effector: str) -> Figure:
    """Give one effector of a figure, on a body that stands.

    LookupError for an unknown name, ValueError for a direction.
    """
    tree, effectors = figure
    if effector not in effectors.names:
        raise LookupError(unknown("effector", effector, effectors.names))
    i = effectors.names.index(effector)
    if not effectors.w[i]:
        raise ValueError(f"{shown(effector)} is a direction, and goes along no curve")
    at = (tree.names[effectors.joints[i]], effectors.offsets[i].tolist())
    return Figure(anchored(tree), Effectors.of(tree, {effector: at}))


def missed(figure: Figure, effector: str, points: ArrayLike, *, within: float) -> Array:
    """Tell how far an effector stays from points (T, 3), (T,) [m].

    It is 0 where it comes within that distance [m]. A body that floats stands where it is. The
    errors are those of `carried_alone`.
    """
    goals = numbers("points", points)[:, None]
    far = nearest(*carried_alone(figure, effector), goals, within=within)[:, 0]
    return np.where(far <= within, 0.0, far)


def heart(figure: Figure, effector: str) -> Array:
    """Find the middle (3,) of where an effector gets to [m].

    A plane through it has room. Joints without limits turn half a turn to either side. The errors
    are those of `carried_alone`.
    """
    tree, end = carried_alone(figure, effector)
    lower = np.where(np.isfinite(tree.lower), tree.lower, tree.rest - np.pi)
    upper = np.where(np.isfinite(tree.upper), tree.upper, tree.rest + np.pi)
    theta = np.random.default_rng(0).uniform(lower, upper, (TRIES, len(tree)))
    return np.asarray(locate(forward(tree, theta), end)[:, 0].mean(axis=0))
