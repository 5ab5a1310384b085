"""Chapter 10. One tick of the human motion simulator of CS 490: a figure reaches for a cursor.

One tick of a `Way` is, for the degrees of motion q with θ = C q and J of the hand,

    Δq = f(J, e / n) + rest

where f is a method on the joints in use, n the parts that the error is divided into, and rest the
way back to the rest pose by at most 1° a tick. A way is a method with two rules around it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import radians
from typing import NamedTuple

import numpy as np

from ikteach.arrays import Array, ArrayLike, Index, Mask
from ikteach.body import forward, locate
from ikteach.checks import common_batch, function, numbers, shown
from ikteach.checks import number as a_number
from ikteach.motion.reach.packages import (
    NONE,
    PACKAGES,
    Package,
    ReachingFigure,
    choose,
    look,
)
from ikteach.motion.rules import clip, hold
from ikteach.motion.step import step
from ikteach.names import unknown
from ikteach.solvers import SOLVERS, Solver, cramer, determinant, independence, name_of

EASE = radians(1)  # the most that a joint goes towards rest in a tick
ARRIVED = 0.01  # [m]
NEAR = 0.002  # [m]; from here on nothing is solved: CS 490's "too far" is no longer true
PARTS = 6  # n of CS 490 [ticks, or so]
MAX_STEP = radians(10)  # of a joint in a tick, the same for every way
SINGULAR = 0.01  # below this independence (`solvers.independence`) det counts as 0
WEAK = 1e-3  # share of σ_max below which a direction counts as lost to the null space

Origin = Callable[[ReachingFigure, Array], Array]
RestRule = Callable[[Array, Array], Array]


def here(body: ReachingFigure, theta: Array) -> Array:
    """Choose packages as seen from the shoulder now.

    They go by where the cursor is from the shoulder as it stands.
    """
    return theta[..., body.back]


def at_rest(body: ReachingFigure, theta: Array) -> Array:
    """Choose packages as seen from the shoulder at rest.

    They go by where the cursor is from there.
    """
    return np.broadcast_to(body.tree.rest[body.back], theta.shape[:-1])


def after_solve(J: Array, wish: Array) -> Array:
    """Let joints go to rest as they wish (..., d).

    The hand goes with them, wherever that takes it (CS 490).
    """
    return wish


def null_space(J: Array, wish: Array) -> Array:
    """Project a wish (..., d) into the null space: (I − J⁺J) wish.

    It leaves the hand where it is, to first order.

    J (..., 3, d). A part of the wish that other joints can make up for is done, the rest is left.
    """
    _, sigma, Vt = np.linalg.svd(J, full_matrices=False)
    kept = sigma > WEAK * sigma[..., :1]
    return wish - np.vecmat(np.where(kept, np.matvec(Vt, wish), 0), Vt)


@dataclass(frozen=True)
class Way:
    """A method of reaching, and the rules around it.

    solver    a function of (J, e); with `packaged` of the three joints of a package
    packaged  True: CS 490's packages; False: arm and back together, four degrees of motion
    origin    from where the cursor is seen when a package is chosen: `here` or `at_rest`
    rest      how joints return to rest: `after_solve`, or in the `null_space`
    """

    solver: Solver
    packaged: bool = False
    origin: Origin = at_rest
    rest: RestRule = null_space

    def __post_init__(self) -> None:
        for name in ("solver", "origin", "rest"):
            function(f"the {name} of a way", getattr(self, name))


class Ways(dict[str, Way]):
    """Ways by name.

    An unknown name is answered with the names that may have been meant.
    """

    @classmethod
    def of(cls, ways: Mapping[str, Way]) -> "Ways":
        """Check that these are ways by name, at least one."""
        if not (isinstance(ways, Mapping) and ways):
            raise TypeError(f"ways are {{name: Way}}, at least one, not {shown(ways)}")
        for name, way in ways.items():
            if not (isinstance(name, str) and name.strip()):
                raise ValueError(f"a way's name is a text, not {shown(name)}")
            checked_way(way, name)
        return cls(ways)

    def __missing__(self, name: str) -> Way:
        raise LookupError(unknown("method", name, self))


WAYS = Ways(
    {
        "cramer": Way(cramer, packaged=True, origin=here, rest=after_solve),
        "cramer, mended": Way(cramer, packaged=True),
        **{name: Way(solver) for name, solver in SOLVERS.items()},
    }
)


class Tick(NamedTuple):
    """The outcome of one tick for a batch of figures.

    theta         (..., n)  the new pose [rad]
    package       (...)     number of the package in use, NONE (-1) for none; without packages
                            0 where the right hand reaches and 1 where the left one does
    det           (...)     det J of a package; without packages √det JJᵀ [m³/rad³]; NaN for none
    independence  (...)     how far J of a package is from singular, 0..1; NaN without packages
    sigma         (...)     the smallest singular value of J in use [m/rad]; NaN for none
    distance      (...)     from the hand to the cursor after the tick [m]
    """

    theta: Array
    package: Index
    det: Array
    independence: Array
    sigma: Array
    distance: Array


def advance(
    body: ReachingFigure,
    theta: ArrayLike,
    cursor: ArrayLike,
    way: Way,
    *,
    parts: int = PARTS,
    max_step: float | None = MAX_STEP,
    backs: Mask | None = None,
) -> Tick:
    """Take one tick towards cursor (..., 3) [m], by one way.

    It starts from pose θ (..., n), for a whole batch.

    parts     n of CS 490: a tick goes 1/n of the rest of the way
    max_step  [rad]; no joint turns further in a tick (but for the neck, which just looks)
    backs     `backs_reach` of the cursor (..., 2), where it is known already
    ValueError if a shape is wrong, a number not finite, or `parts` is below 1.
    """
    theta, cursor = _checked(body, theta, cursor)
    checked_way(way)
    checked_parts(parts)
    shape = common_batch("theta and the cursor", theta.shape[:-1], cursor.shape[:-1])
    poses = np.broadcast_to(theta, (*shape, theta.shape[-1])).reshape(-1, theta.shape[-1]).copy()
    cursors = np.broadcast_to(cursor, (*shape, 3)).reshape(-1, 3)
    known = None if backs is None else np.broadcast_to(backs, (*shape, 2)).reshape(-1, 2)
    package = which(body, poses, cursors, way, known)
    told = np.full((3, len(poses)), np.nan)
    for number in np.unique(package):
        of = package == number
        poses[of], told[:, of] = _reach(body, poses[of], cursors[of], way, number, parts, max_step)
    poses[:, body.neck] = look(body, cursors, poses[:, body.back])
    distance = np.linalg.norm(cursors - hands(body, poses, cursors), axis=-1)
    det, independent, sigma = told.reshape(3, *shape)
    return Tick(
        poses.reshape(*shape, -1),
        package.reshape(shape),
        det,
        independent,
        sigma,
        distance.reshape(shape),
    )


def checked_parts(parts: int) -> int:
    """Check the number of parts of the error.

    The error is divided into them; ValueError for less than 1.
    """
    if not a_number("the number of parts", parts) >= 1:
        raise ValueError(f"the error is divided into 1 part or more, not {shown(parts)}")
    return parts


def checked_way(way: Way, name: str = "way") -> Way:
    """Check that this is a way."""
    if not isinstance(way, Way):
        raise TypeError(f"{shown(name)} must be a Way, as Way(dls) is, not {shown(way)}")
    return way


def which(
    body: ReachingFigure, theta: Array, cursor: Array, way: Way, backs: Mask | None = None
) -> Index:
    """Return the number of the package in use (...).

    Where the way has no packages, it is that of the side.
    """
    if way.packaged:
        return choose(body, cursor, way.origin(body, theta), backs)
    return np.where(cursor[..., 0] < 0, 0, 1)


def hands(body: ReachingFigure, theta: Array, cursor: Array) -> Array:
    """Return where the hand on the cursor's side is, (..., 3) [m]."""
    frames = forward(body.tree, theta)
    right, left = (locate(frames, body.hands[side])[..., 0, :] for side in "rl")
    return np.where(cursor[..., :1] < 0, right, left)


def _reach(
    body: ReachingFigure,
    theta: Array,
    cursor: Array,
    way: Way,
    number: int,
    parts: int,
    max_step: float | None,
) -> tuple[Array, Array]:
    """Move figures of one package: poses (b, n); det, independence and σ (3, b)."""
    if number == NONE:
        ease = EASE if max_step is None else min(EASE, a_number("max_step", max_step))
        home = np.clip(body.tree.rest - theta, -ease, ease)
        home[:, body.neck] = 0
        return theta + home, np.full((3, len(theta)), np.nan)
    package = PACKAGES[number] if way.packaged else arm_and_back(PACKAGES[number].side)
    used = body.columns(package.degrees)
    idle = homewards(body, theta, besides=package.degrees if way.packaged else ())

    def solve(J: Array, e: Array) -> Array:
        """Solve for Δθ on the degrees in use.

        The method answers for them, and the way to rest of the others is added.
        """
        ours = J @ used
        far = np.linalg.norm(e, axis=-1) > NEAR
        if way.packaged:  # and where det is near 0 the package takes no step
            far &= independence(ours) > SINGULAR
        dq = np.where(far[:, None], way.solver(ours, e / parts), 0)
        return dq @ used.T + way.rest(J @ body.C, idle) @ body.C.T

    solve.__name__ = name_of(way.solver)  # what `step` calls it where its answer is not finite
    done = step(
        body.tree,
        theta,
        body.hands[package.side],
        cursor[:, None, :],
        solve,
        max_step=max_step,
        limits=clip if way.packaged else hold,
    )
    return done.theta, figures_of(done.J @ used, way.packaged)


def figures_of(J: Array, packaged: bool) -> Array:
    """Return det, independence and smallest σ of J (..., 3, m) in use: (3, ...); see `Tick`."""
    sigma = np.linalg.svdvals(J)
    if packaged:
        return np.stack([determinant(J), independence(J), sigma[..., -1]])
    volume = sigma.prod(axis=-1)
    return np.stack([volume, np.full_like(volume, np.nan), sigma[..., -1]])


def arm_and_back(side: str) -> Package:
    """Join arm and back into one package.

    It has four degrees of motion; the general methods reach with it.
    """
    arm, back = PACKAGES["rl".index(side)], "back"
    return Package(f"{arm.name} and back together", side, (*arm.degrees, back))


def homewards(body: ReachingFigure, theta: Array, besides: tuple[str, ...] = ()) -> Array:
    """Return the wish (..., d) of all degrees to rest.

    Each wishes a step of at most `EASE`. Those named in `besides`, and the neck, wish nothing.
    """
    wish = np.clip(body.tree.rest - theta, -EASE, EASE)[..., body.rows]
    for name in (*besides, "neck"):
        wish[..., body.degrees.index(name)] = 0
    return wish


def _checked(body: ReachingFigure, theta: ArrayLike, cursor: ArrayLike) -> tuple[Array, Array]:
    theta, cursor = numbers("theta", theta), numbers("the cursor", cursor)
    n = len(body.tree)
    if theta.shape[-1:] != (n,):
        raise ValueError(f"{n} joints need theta of shape (..., {n}), not {theta.shape}")
    if cursor.shape[-1:] != (3,):
        raise ValueError(f"a cursor is x, y and z, not of shape {cursor.shape}")
    if not (np.isfinite(theta).all() and np.isfinite(cursor).all()):
        raise ValueError("angles and cursor must be finite numbers")
    return theta, cursor
