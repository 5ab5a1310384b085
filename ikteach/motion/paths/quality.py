"""How natural is a gait? Measures of a run, beside the distance to its targets.

A run is a `Track` on a treadmill: the ground goes back by `path.pace`. The sole of a foot is
measured at heel and ball (and at the tip, where toes bend), whatever the effectors were.
"""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from pathlib import Path as FilePath
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Mask, frozen
from ikteach.body import Effectors, Tree, forward, locate
from ikteach.body.figures import BALL, HAND, HEEL, TOE
from ikteach.checks import numbers, shown
from ikteach.motion.path import Motion
from ikteach.motion.track import Track

NORMS = FilePath(__file__).parents[2] / "data" / "gait_norms.csv"
SPEEDS = ("Slow", "Free", "Fast")  # of the norms
CURVES = ("hip", "knee", "ankle", "pelvis")
ROWS = {"hip": "hip.bend.{}", "knee": "knee.{}", "ankle": "ankle.{}", "pelvis": "pelvis.x"}
TOUCH = 0.005  # height below which a sole is on the ground [m]
LOW = 0.01  # height below which a sole is near the ground [m]
MARKS = 1000  # phases in a period at which a foot may come down
FINER = 50  # times to a frame at which a foot may come down
SHORTEST = 0.4  # time between two of them [s]


class Soles(NamedTuple):
    """Points of two feet in time, over still ground.

    places   (T, 2, p, 3)  heel, ball, and tip if there is one, of the left foot and the right [m]
    heights  (T, 2, p)     over the ground [m]
    stands   (T, 2, p)     whether each is to stand
    stride   time of a stride [s]
    """

    places: Array
    heights: Array
    stands: Mask
    stride: float

    def ways(self, foot: int, point: Array) -> Array:
        """Find how far a point (T,) of a foot goes in each frame, (T − 1,) [m]."""
        row = np.arange(1, len(point))
        gone = self.places[row, foot, point[1:]] - self.places[row - 1, foot, point[1:]]
        return np.hypot(gone[:, 0], gone[:, 2])


def soles(run: Track, path: Motion) -> Soles:
    """Follow the soles of a run; ValueError or LookupError without feet."""
    if run.theta.ndim != 2:
        raise ValueError(f"one run is measured at a time, theta (T, n), not {run.theta.shape}")
    points = soles_of(run.tree)
    course = path.on(run.tree, run.effectors)
    places = locate(forward(run.tree, run.theta), points)
    places = places.reshape(len(places), 2, -1, 3).copy()
    heights = places[..., 1] - course.floor
    places[..., 2] += (course.size * path.pace * run.times)[:, None, None]
    down = path.stands(path.rate * run.times)
    stands = [down[:, _columns(path, name)].any(axis=1) for name in points.names]
    stride = np.mean([np.diff(strikes(path, run.times, side)).mean() for side in "lr"])
    return Soles(places, heights, np.stack(stands, -1).reshape(heights.shape), float(stride))


def soles_of(tree: Tree) -> Effectors:
    """Return heel, ball, tip of the left, then right foot."""
    points: dict[str, tuple[str, Sequence[float]]] = {}
    for side in "lr":
        foot = f"foot.{side}" if f"foot.{side}" in tree.names else f"ankle.{side}"
        points |= {f"heel.{side}": (foot, HEEL), f"ball.{side}": (foot, BALL)}
        if f"toes.{side}" in tree.names:
            points[f"toe.{side}"] = (f"toes.{side}", TOE)
    return Effectors.of(tree, points)


def _columns(path: Motion, point: str) -> list[int]:
    """Find the targets that say whether a point stands: its own, or that of the foot as a whole.

    Toes stand with the ball.
    """
    kind, _, side = point.partition(".")
    wanted = {f"foot.{side}", f"ball.{side}" if kind == "toe" else point}
    return [i for i, name in enumerate(path.names) if name in wanted]


def strikes(path: Motion, run_times: Array, side: str) -> Array:
    """Find the times at which a foot is to come down [s].

    It is between the first and the last time of a run's frames (T,) [s].
    ValueError if there are not two of them, or fewer than ten frames between them.
    """
    feet = [i for point in ("heel", "ball") for i in _columns(path, f"{point}.{side}")]
    if not feet:
        raise ValueError(f"{shown(path.name)} has no targets for the feet")
    times = np.linspace(run_times[0], run_times[-1], FINER * len(run_times))
    down = np.atleast_1d(path.stands(path.rate * times)[:, feet].any(axis=1))
    # A gap of less than that is no swing: where a recorded foot rolls, no point of it may be still.
    found = times[1:][down[1:] & ~down[:-1]]
    found = found[np.append(True, np.diff(found) > SHORTEST)] if len(found) else found
    if len(found) < 2 or np.diff(found).min() < 10 * np.diff(run_times).max():
        raise ValueError(
            f"the run has no whole stride of {shown(path.name)} of ten frames or more: from where a"
            " foot comes down to where it comes down again"
        )
    return np.asarray(found)


def slip(run: Track, path: Motion) -> Array:
    """Return how far the standing points of each foot slip, (2,) [m].

    It is the largest distance over the ground from where a point came to stand, the mean over all
    times that a point stands.
    """
    found = soles(run, path)
    far = np.full(2, np.nan)
    for foot in range(2):
        each = [
            np.hypot(*(part - part[0])[:, [0, 2]].T).max()
            for point in range(found.heights.shape[-1])
            for a, b in spans(found.stands[:, foot, point])
            for part in [found.places[a:b, foot, point]]
        ]
        far[foot] = np.mean(each) if each else np.nan
    return far


def drag(run: Track, path: Motion) -> Array:
    """Return each foot's way along the ground in a stride, (2,) [m].

    It is the way of its lowest point, wherever that is nearer to the ground than 1 cm.
    """
    found = soles(run, path)
    way = np.zeros(2)
    for foot in range(2):
        heights = found.heights[:, foot]
        low = heights.min(axis=1) < LOW
        ways = found.ways(foot, heights.argmin(axis=1))[low[1:] & low[:-1]]
        way[foot] = ways.sum() * found.stride / (run.times[-1] - run.times[0])
    return way


def clearance(run: Track, path: Motion) -> Array:
    """Return how high each swinging foot's lowest point is, (2,) [m].

    It is the least height in the middle half of a swing, the mean over swings.
    """
    found = soles(run, path)
    least = np.full(2, np.nan)
    for foot in range(2):
        low = found.heights[:, foot].min(axis=1)
        each = [
            low[a + (b - a) // 4 : b - (b - a) // 4].min()
            for a, b in spans(np.atleast_1d(~found.stands[:, foot].any(axis=1)))
        ]
        least[foot] = np.mean(each) if each else np.nan
    return least


def double_support(run: Track, path: Motion) -> float:
    """Return the share of time in which both feet stand.

    A foot stands where its lowest point is nearer to the ground than 5 mm and goes over it at less
    than half the pace.
    """
    found = soles(run, path)
    both = np.ones(len(run.times), dtype=bool)
    for foot in range(2):
        heights = found.heights[:, foot]
        way = np.gradient(found.places[:, foot], run.times, axis=0)
        point = heights.argmin(axis=1)
        fast = np.hypot(way[..., 0], way[..., 2])[np.arange(len(point)), point]
        both &= (heights.min(axis=1) < TOUCH) & (fast < abs(path.pace) / 2)
    return float(both.mean())


def arm_swing(run: Track, path: Motion) -> Array:
    """Return how each hand swings with its foot, r (2,).

    It is the correlation of their places ahead of the pelvis, −1 where they swing against each
    other as in a walk.
    """
    tree = run.tree
    points: dict[str, tuple[str, Sequence[float]]] = {}
    for part, joint, offset in ("foot", "ankle", (0, 0, 0)), ("hand", "elbow", HAND):
        points |= {f"{part}.{side}": (f"{joint}.{side}", offset) for side in "lr"}
    z = locate(forward(tree, run.theta), Effectors.of(tree, points))[..., 2]
    return np.array([np.corrcoef(z[:, side], z[:, 2 + side])[0, 1] for side in range(2)])


def spans(on: Mask) -> list[tuple[int, int]]:
    """Find the spans [a, b) in which `on` (T,) holds.

    Those that are cut off by the ends are left out.
    """
    edges = (np.flatnonzero(on[1:] != on[:-1]) + 1).tolist()
    return [(a, b) for a, b in pairwise(edges) if on[a]]


@lru_cache(maxsize=3)
def norms(speed: str = "Free") -> dict[str, Array]:
    """Return the norms {curve: (51,)} [degrees], at 0, 2 … 100 % of the cycle.

    speed  "Slow", "Free" or "Fast"

    hip, knee, ankle and pelvis of children; of a pelvis tilted by about 12°. Source: Schwartz,
    Rozumalski & Trost 2008, J. Biomech. 41:1639 (CC BY-SA 4.0; `ikteach/data/README.md`).
    ValueError for another speed.
    """
    if speed not in SPEEDS:
        raise ValueError(f"norms are of {', '.join(SPEEDS)}, not of {shown(speed)}")
    table = np.genfromtxt(NORMS, delimiter=",", names=True)
    return {name: frozen(table[f"schwartz2008_{speed}_{name}_mean"]) for name in CURVES}


def deviations(speed: str = "Free") -> dict[str, Array]:
    """Return the standard deviations of the norms, {curve: (51,)} [degrees]."""
    norms(speed)
    table = np.genfromtxt(NORMS, delimiter=",", names=True)
    return {name: frozen(table[f"schwartz2008_{speed}_{name}_sd"]) for name in CURVES}


def sagittal(tree: Tree, theta: Array) -> dict[str, Array]:
    """Return the sagittal angles of poses θ (..., n), {curve: (..., 2)} [degrees].

    Of the left and of the right side. A body whose pelvis cannot tilt has 0 there. LookupError for
    one without hips, knees or ankles by a human's names.
    """
    found = {}
    for curve, row in ROWS.items():
        still = curve == "pelvis" and row not in tree.names
        sides = [] if still else [tree.index(row.format(side)) for side in "lr"]
        found[curve] = np.degrees(theta[..., sides]) if sides else np.zeros((*theta.shape[:-1], 2))
    return found


def cycle(path: Motion, phase: ArrayLike) -> Array:
    """Return how far each foot's cycle is at phases (...), (..., 2).

    The share from where the left foot, or the right one, comes down to where it does so again.
    ValueError for a motion that does not say when feet stand.
    """
    way = float(np.sign(path.rate))
    here, around = way * numbers("the phase", phase), 2 * np.pi
    shares: list[Array] = []
    for side in "lr":
        begins = _begins(path, side)
        since = np.asarray((here[..., None] - begins) % around)
        last = since.argmin(axis=-1)
        long = (np.roll(begins, -1) - begins) % around
        long = np.where(long > 0, long, around)[last]  # a foot that comes down once
        shares.append(since.min(axis=-1) / long)
    return np.stack(shares, axis=-1)


def _begins(path: Motion, side: str) -> Array:
    """Find the phases of one period at which a foot comes down, forwards in time [rad]."""
    feet = [i for point in ("heel", "ball") for i in _columns(path, f"{point}.{side}")]
    fine = np.linspace(0, 2 * np.pi, MARKS, endpoint=False)
    down = np.atleast_1d(path.stands(np.sign(path.rate) * fine)[:, feet].any(axis=1))
    found = fine[down & ~np.roll(down, 1)]
    apart = SHORTEST * abs(path.rate)
    found = found[np.diff(found, prepend=found[-1:] - 2 * np.pi) > apart]
    if not len(found):
        raise ValueError(f"{shown(path.name)} does not say when feet stand")
    return np.asarray(found)


def curves(run: Track, path: Motion) -> dict[str, Array]:
    """Return the sagittal angles of a run over its cycle, {curve: (2, 51)} [degrees].

    They are means over strides, of the left and of the right side, each from where its foot comes
    down. A body whose pelvis cannot tilt has 0 there. ValueError without a whole stride.
    """
    found = {name: np.zeros((2, 51)) for name in CURVES}
    moved = sagittal(run.tree, run.theta)
    for i, side in enumerate("lr"):
        begins = strikes(path, run.times, side)
        times = begins[:-1, None] + np.diff(begins)[:, None] * np.arange(51) / 50
        for curve, angle in moved.items():
            found[curve][i] = np.interp(times, run.times, angle[:, i]).mean(axis=0)
    return found


def gait_score(run: Track, path: Motion, *, speed: str = "Free") -> float:
    """Return how far a gait is from the norm, 0 on it [degrees].

    The root of the mean square of hip, knee, ankle and pelvic tilt against `norms(speed)`, over the
    cycle and both sides. A small score is no proof of a natural gait: it knows nothing of slipping,
    of clearance, of arms. After Schwartz & Rozumalski 2008, Gait & Posture 28:351, of the sagittal
    plane alone.
    """
    return score_of(curves(run, path), speed)


def score_of(found: dict[str, Array], speed: str = "Free") -> float:
    """Return the score of angles {curve: (..., 51)} [degrees]."""
    means = norms(speed)
    return float(np.sqrt(np.mean([(found[name] - means[name]) ** 2 for name in CURVES])))
