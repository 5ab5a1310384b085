"""Chapter 10. The earlier stage of CS 490: an arm in the plane that reaches for a cursor.

It has three joints or fewer. Cramer's rule wants three, and three wishes: the cursor's x and y, and
for the direction of the last link, θ₁ + θ₂ + θ₃, that from the shoulder to the cursor. Then

    J = [[∂x/∂θ], [∂y/∂θ], [1 1 1]]        det J = L₁ L₂ sin θ₂

A general method has no need of the third wish: it shares two among all joints.
"""

import numpy as np

from ikteach.arrays import Array, ArrayLike
from ikteach.body import forward, locate
from ikteach.body.figures import Figure, planar_model
from ikteach.motion.methods import Methods, methods_of
from ikteach.motion.reach.packages import NONE
from ikteach.motion.reach.reaching import Reaching
from ikteach.motion.reach.ways import MAX_STEP, NEAR, PARTS, SINGULAR, Tick, figures_of
from ikteach.motion.reachable import reachable
from ikteach.motion.rules import clip, hold
from ikteach.motion.step import step
from ikteach.solvers import SOLVERS, Solvers, ask, cramer, independence

ROOM = np.array([[-1.3, -1.0, 0.0], [1.3, 1.3, 0.0]])  # where a cursor can be [m]


def square(figure: Figure, theta: Array, J: Array, e: Array) -> tuple[Array, Array]:
    """Fill the empty row of z in J and e.

    The direction of the last link goes there. J (3, 3) and e (3,), before and after, are of the
    hand, at pose θ (3,) of an arm that stands at the origin.
    """
    x, y, _ = e + locate(forward(figure.tree, theta), figure.effectors)[0]
    turn = _wrapped(np.arctan2(y, x) - theta.sum())
    return np.vstack([J[:2], np.ones(3)]), np.array([e[0], e[1], turn])


def arrives(figure: Figure, cursor: Array) -> bool:
    """Check whether three links can put the hand to cursor.

    The cursor is (3,) [m], and the last link points from the origin. By the law of cosines
    for two links, with the elbow to either side, within the limits.
    """
    tree = figure.tree
    L1, L2, L3 = *tree.offsets[1:, 0], figure.effectors.offsets[0, 0]
    aim = np.arctan2(cursor[1], cursor[0])
    x, y = cursor[:2] - L3 * np.array([np.cos(aim), np.sin(aim)])
    cos2 = (x * x + y * y - L1 * L1 - L2 * L2) / (2 * L1 * L2)
    if abs(cos2) > 1:
        return False
    two = np.arccos(cos2) * np.array([1, -1])
    one = np.arctan2(y, x) - np.arctan2(L2 * np.sin(two), L1 + L2 * np.cos(two))
    theta = _wrapped(np.stack([one, two, aim - one - two], axis=-1))
    return bool(((theta >= tree.lower) & (theta <= tree.upper)).all(axis=-1).any())


def _wrapped(angle: Array) -> Array:
    """Find the same angle from −π to π."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


class PlanarReach(Reaching):
    """An arm in the plane z = 0 that reaches.

    `links` is 3, 2 or 1, and Cramer's rule is for three.

    Its ways are solvers. It can be shown by the same widget as `Reach`.
    """

    def __init__(
        self,
        links: int = 3,
        methods: Methods = SOLVERS,
        *,
        method: str | None = None,
        parts: int = PARTS,
        max_step: float | None = MAX_STEP,
        dt: float = 1 / 30,
        cursor: ArrayLike = (0.5, 0.6, 0.0),
    ) -> None:
        self.figure = planar_model(links)
        self.tree, self.effectors = self.figure
        named = methods_of(methods)
        if links == 3:
            named = {"cramer": cramer} | named
        elif "cramer" in named:
            raise ValueError(f"Cramer's rule is for an arm of three links, not of {links}")
        method = method or ("dls" if "dls" in named else next(iter(named)))
        super().__init__(Solvers(named), ROOM, method, parts, max_step, dt, cursor)

    @property
    def within(self) -> bool:
        """Whether the hand can be at the cursor.

        It counts with all that the shown method wishes.
        """
        return self._aimed if self.method == "cramer" else self._somehow

    @property
    def words(self) -> str:
        """The meaning of white or red here, in words."""
        if self.within:
            return "within reach of the arm"
        return "out of reach" + (" with the last link pointing outward" if self._somehow else "")

    def _look(self) -> None:
        self._aimed = "cramer" in self.ways and arrives(self.figure, self.cursor)
        self._somehow = self._aimed or bool(reachable(*self.figure, self.cursor[None])[0])

    def _advance(self, name: str) -> Tick:
        theta = self.standing[name].tick.theta
        packaged = name == "cramer"

        def solve(J: Array, e: Array) -> Array:
            if packaged:
                J, e = square(self.figure, theta, J, e)
            lost = packaged and not (self._aimed and independence(J) > SINGULAR)
            if lost or np.linalg.norm(e) <= NEAR:
                return np.zeros(len(theta))
            return ask(self.ways[name], J, e / self.parts)

        done = step(
            self.tree,
            theta,
            self.effectors,
            self.cursor[None],
            solve,
            max_step=self.max_step,
            limits=clip if packaged else hold,
        )
        gap = self.cursor - locate(forward(self.tree, done.theta), self.effectors)[0]
        J = square(self.figure, theta, done.J, done.e)[0] if packaged else done.J[:2]
        det, independent, sigma = figures_of(J, packaged)
        package = np.asarray(NONE if packaged and not self._aimed else 0)
        return Tick(done.theta, package, det, independent, sigma, np.asarray(np.linalg.norm(gap)))
