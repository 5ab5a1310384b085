"""The figures of the course: a planar arm, Buss's Y and double Y, a human of 20 joints, the figure
of CS 490 with 16 degrees of motion, and a walker whose pelvis is free."""

from collections.abc import Sequence
from dataclasses import replace
from math import inf, radians, sqrt
from typing import NamedTuple

import numpy as np

from ikteach.body.tree import Effectors, Joint, Tree
from ikteach.checks import count, numbers, shown

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
TILTED = (sqrt(14) / 8, 1 / 8, 7 / 8)  # the one skew axis of Buss's trees

Vector = Sequence[float]

MOST = 1000  # links of an arm


class Figure(NamedTuple):
    """A body and its effectors."""

    tree: Tree
    effectors: Effectors


def planar_arm(links: int | Sequence[float] = 3) -> Figure:
    """Make an arm of links [m] in the plane z = 0, stretched along x.

    Given a number, each link is 1 m long.

    Its effector is "hand", at the end of the last link. Its joints turn without limits.
    ValueError for lengths that are no numbers above 0, or more than 1000 of them.
    """
    lengths = _lengths(links)
    joints: list[Joint] = []
    for i, offset in enumerate([0.0, *lengths[:-1]], start=1):
        parent = joints[-1].name if joints else None
        joints.append(Joint(f"joint{i}", parent, (offset, 0, 0), Z))
    tree = Tree.of(joints)
    hand = (joints[-1].name, (lengths[-1], 0, 0))
    return Figure(tree, Effectors.of(tree, {"hand": hand}))


def y_shape() -> Figure:
    """Make Buss's Y, 7 joints and 2 effectors.

    It has a trunk and two arms of three hinges each. There are no limits: his code writes ±π in
    every joint and asks for it nowhere.
    """
    rows = [  # name, parent, place in the world at θ = 0, axis
        ("trunk", None, (0, -0.5, 0), Z),
        ("right.1", "trunk", (0, 0.4, 0), Z),
        ("left.1", "trunk", (0, 0.4, 0), Z),
        ("right.2", "right.1", (0.5, 1.0, 0), X),
        ("left.2", "left.1", (-0.5, 1.0, 0), X),
        ("right.3", "right.2", (0.7, 1.3, 0), TILTED),
        ("left.3", "left.2", (-0.8, 1.5, 0), TILTED),
    ]
    return _in_world(rows, {"right": ("right.3", (0.7, 2, 0)), "left": ("left.3", (-0.8, 1.9, 0))})


def double_y() -> Figure:
    """Make Buss's double Y, 25 joints and 4 effectors.

    It has a trunk, two boughs and four branches.
    """
    fork, flat, steep = 0.5 / sqrt(2), 0.25, 0.25 * sqrt(3)
    rows: list[tuple[str, str | None, Vector, Vector]] = [
        ("trunk.1", None, (0, -1.5, 0), TILTED),
        ("trunk.2", "trunk.1", (0, -1, 0), X),
        ("trunk.3", "trunk.2", (0, -1, 0), Z),
    ]
    ends = {}
    for side, x, branches in ("right", 1, ("low", "high")), ("left", -1, ("high", "low")):
        rows.append((f"{side}.bough", "trunk.3", (0, -0.5, 0), Z))
        for branch in branches:
            rise = {"low": flat, "high": steep}[branch]
            name = f"{side}.{branch}"

            def place(links: int, x: int = x, rise: float = rise) -> Vector:
                """Return the point that is `links` links along the branch."""
                return (x * (fork + links * steep), -0.5 + fork + links * rise, 0)

            rows += [
                (f"{name}.1", f"{side}.bough", place(0), Y),
                (f"{name}.2", f"{name}.1", place(0), X),
                (f"{name}.3", f"{name}.2", place(1), Z),
                (f"{name}.4", f"{name}.3", place(2), X),
                (f"{name}.5", f"{name}.4", place(2), Y),
            ]
            ends[name] = (f"{name}.5", place(3))
    return _in_world(rows, ends)


def human() -> Figure:
    """Make a human of 1.80 m with 20 hinges.

    The pelvis is at the origin, x points left, y up, z forward.

    Two hinges in the spine, four in each arm, five in each leg; the effectors are the balls of the
    feet and the hands, in the order of the thesis. Lengths are shares of the body's height after
    Winter (Biomechanics and Motor Control of Human Movement) and Drillis & Contini (1966); limits
    are clinical ranges of motion, but for the spine's 30°, which is chosen so that the thesis's
    statement holds: the targets of running are out of reach (`ikteach.motion.gait`).
    """
    tree = Tree.of(
        [
            _hinge("spine.bend", None, (0, 0.1476, 0), X, -25, 30),
            _hinge("spine.twist", "spine.bend", (0, 0, 0), Y, -30, 30),
            *_arm("l", 1),
            *_arm("r", -1),
            *_leg("l", 1),
            *_leg("r", -1),
        ]
    )
    return Figure(tree, _feet_and_hands(tree))


HEEL, BALL = (0, -0.0702, -0.0684), (0, -0.0702, 0.1286)  # in the frame of a human's ankle [m]
HAND = (0, -0.3612, 0)  # from the elbow [m]
TOE = (0, 0, 0.0767)  # its tip, from the ball of the foot [m]
GAZE = 0.3  # length of the pelvis's directions: 1° off weighs as much as 5 mm [m]


def ball(
    name: str,
    parent: str | None = None,
    offset: Vector = (0.0, 0.0, 0.0),
    *,
    order: str = "YXZ",
    lower: float | Vector = -inf,
    upper: float | Vector = inf,
) -> list[Joint]:
    """Make a ball joint: hinges about two or three axes.

    order         letters of X, Y and Z, that of the ground's side first: R = R_y R_x R_z for "YXZ".
                  Where the middle one stands at 90° the outer ones turn alike: the joint locks
    lower, upper  limits of all, or of each [rad]

    The rows are called "<name>.x" and so on, at one place. ValueError for other letters.
    """
    axes = {"X": X, "Y": Y, "Z": Z}
    if not isinstance(order, str) or not (0 < len(order) == len(set(order) & set(axes))):
        raise ValueError(f"the order of a ball has X, Y, Z, each once, not {shown(order)}")
    lows, highs = (_each(end, value, order) for end, value in (("lower", lower), ("upper", upper)))
    rows: list[Joint] = []
    for letter, low, high in zip(order, lows, highs, strict=True):
        above, place = (rows[-1].name, (0.0, 0.0, 0.0)) if rows else (parent, offset)
        row = f"{name}.{letter.lower()}"
        rows.append(Joint(row, above, place, axes[letter], lower=low, upper=high))
    return rows


def _each(name: str, values: float | Vector, order: str) -> list[float]:
    """Give a limit of each hinge, from that of all."""
    array = numbers(name, values)
    if array.shape not in ((), (len(order),)):
        raise ValueError(f"{name} of a ball is one number, or {len(order)}, not {shown(values)}")
    return np.broadcast_to(array, len(order)).tolist()


def floating(figure: Figure, *, name: str = "root", order: str = "YXZ") -> Figure:
    """Put six rows below all that hangs from the ground.

    Three slides "<name>.x.slide" and so on, then the ball "<name>.y", "<name>.x", "<name>.z", all
    without limits and at the origin. The effectors stay what they are.
    """
    root: list[Joint] = []
    for letter, axis in zip("xyz", (X, Y, Z), strict=True):
        above = root[-1].name if root else None
        root.append(Joint(f"{name}.{letter}.slide", above, axis=axis, slide=True))
    root += ball(name, root[-1].name, order=order)
    top = root[-1].name
    rows = [replace(j, parent=top) if j.parent is None else j for j in figure.tree.joints()]
    tree = Tree.of([*root, *rows])
    return Figure(tree, _effectors_on(tree, figure))


def walker() -> Figure:
    """Make a human with a free pelvis and bending toes, 30 rows.

    The human's 20 hinges; six rows of the pelvis (`floating`); in each foot one that tilts it
    sideways and one at its ball that bends the toes. Hips, knees and elbows are bent at rest: a
    straight knee is singular, and at its limit. The effectors are what a walk has targets for
    (`ikteach.motion.paths.walk`): the pelvis, the heels and balls of the feet, and which way the
    pelvis points up and ahead. Trunk, arms and toes follow a wish.
    """
    tree = floating(human(), name="pelvis").tree
    bent = {"hip.bend": 15, "knee": 20, "elbow": 20}
    rows = [replace(row, rest=radians(bent.get(row.name[:-2], 0))) for row in tree.joints()]
    points: dict[str, tuple[str, Vector]] = {"pelvis": ("pelvis.z", (0, 0, 0))}
    for side, x in ("l", 1), ("r", -1):
        foot, toes = f"foot.{side}", f"toes.{side}"
        rows.append(_hinge(foot, f"ankle.{side}", (0, 0, 0), (0, 0, x), -20, 35))
        rows.append(_hinge(toes, foot, BALL, (-1, 0, 0), -30, 70))
        points |= {f"heel.{side}": (foot, HEEL), f"ball.{side}": (foot, BALL)}
    tree = Tree.of(rows)
    up, ahead = ("pelvis.z", (0, GAZE, 0)), ("pelvis.z", (0, 0, GAZE))
    directions = {"pelvis.up": up, "pelvis.ahead": ahead}
    return Figure(tree, Effectors.of(tree, points, directions=directions))


def _effectors_on(tree: Tree, figure: Figure) -> Effectors:
    """Make a figure's effectors anew, on a tree that has its joints too."""
    names, old = figure.tree.names, figure.effectors
    each = {
        name: (names[joint], offset)
        for name, joint, offset in zip(
            old.names, old.joints.tolist(), old.offsets.tolist(), strict=True
        )
    }
    points = {name: each[name] for name, w in zip(old.names, old.w, strict=True) if w}
    directions = {name: at for name, at in each.items() if name not in points}
    return Effectors.of(tree, points, directions=directions)


def heels(tree: Tree) -> Effectors:
    """Return the heels of `human().tree`, for footprints: they reach for nothing."""
    return Effectors.of(tree, {f"heel.{side}": (f"ankle.{side}", HEEL) for side in "lr"})


# Rows that one angle turns. The tree keeps a row each, so that `forward` and `jacobian` need not
# know; who moves the figure gives both the same angle (`ikteach.motion.reach.packages.coupling`).
TOGETHER = (("back.lower", "back.upper"),)


def simulator() -> Figure:
    """Make the figure of CS 490.

    It has 16 degrees of motion in 17 hinges, and its pelvis is at the origin.

    Each shoulder has two hinges (about y, which swings the arm round, then about x, which raises
    it), each elbow, knee and ankle one, each hip two, the neck one, which nods. The back has two
    segments that one angle turns together: two rows, `TOGETHER` one degree of motion. Lengths and
    limits are those of `human()` but for the neck's −30° to 60°, which are CS 490's, and the
    shoulder's about y and the back's, which are clinical ranges too. At rest the elbows are a
    little bent: where an arm is straight, three of its hinges are not independent.
    """
    tree = Tree.of(
        [
            _hinge("back.lower", None, (0, 0.1, 0), X, -12, 40),
            _hinge("back.upper", "back.lower", (0, 0.2, 0), X, -12, 40),
            _hinge("neck", "back.upper", (0, 0.27, 0), X, -30, 60),
            *_simulator_arm("l", 1),
            *_simulator_arm("r", -1),
            *_simulator_leg("l", 1),
            *_simulator_leg("r", -1),
        ]
    )
    return Figure(tree, _feet_and_hands(tree))


def planar_model(links: int = 3) -> Figure:
    """Make a planar arm of one to three links.

    The earlier stage of CS 490, with limits. The links are 0.5, 0.4 and 0.3 m long; the effector
    "hand" is at the end of the last. ValueError for another number of links.
    """
    lengths, limits, rest = (0.5, 0.4, 0.3), (180, 150, 120), (60, -60, -45)
    try:
        links = count("links", links, most=3)
    except ValueError:
        raise ValueError(f"the planar model has 1, 2 or 3 links, not {shown(links)}") from None
    joints = [
        Joint(
            f"joint{i + 1}",
            f"joint{i}" if i else None,
            (lengths[i - 1] if i else 0, 0, 0),
            Z,
            lower=radians(-limits[i]),
            upper=radians(limits[i]),
            rest=radians(rest[i]),
        )
        for i in range(links)
    ]
    tree = Tree.of(joints)
    hand = (joints[-1].name, (lengths[links - 1], 0, 0))
    return Figure(tree, Effectors.of(tree, {"hand": hand}))


def _lengths(links: int | Sequence[float]) -> list[float]:
    """Find the lengths of an arm's links [m]."""
    try:
        lengths = np.ones(count("links", links, 1, MOST)) if np.ndim(links) == 0 else links
        lengths = numbers("links", lengths)
        fits = lengths.ndim == 1 and 1 <= len(lengths) <= MOST
        fits = fits and bool(((lengths > 0) & (lengths < inf)).all())  # NaN is neither
    except ValueError:  # not even numbers
        fits = False
    if not fits:
        allowed = f"a number of links from 1 to {MOST}, or their lengths, above 0 and finite"
        raise ValueError(f"an arm needs {allowed}, not {shown(links)}")
    return list(map(float, np.asarray(lengths)))


def _simulator_arm(side: str, x: int) -> list[Joint]:
    y_axis, x_axis = f"shoulder.y.{side}", f"shoulder.x.{side}"
    return [
        _hinge(y_axis, "back.upper", (x * 0.2322, 0.2184, 0), (0, x, 0), -40, 135),
        _hinge(x_axis, y_axis, (0, 0, 0), (-1, 0, 0), -60, 180),
        _hinge(f"elbow.{side}", x_axis, (0, -0.3348, 0), (-1, 0, 0), 0, 150, rest=20),
    ]


def _simulator_leg(side: str, x: int) -> list[Joint]:
    x_axis, z_axis, knee = f"hip.x.{side}", f"hip.z.{side}", f"knee.{side}"
    return [
        _hinge(x_axis, None, (x * 0.0835, 0, 0), (-1, 0, 0), -30, 120),
        _hinge(z_axis, x_axis, (0, 0, 0), (0, 0, x), -30, 45),
        _hinge(knee, z_axis, (0, -0.441, 0), X, 0, 140),
        _hinge(f"ankle.{side}", knee, (0, -0.4428, 0), (-1, 0, 0), -50, 20),
    ]


def _arm(side: str, x: int) -> list[Joint]:
    # The mirror image of a rotation about y or z turns the other way round, one about x does not.
    bend, out, turn = (f"shoulder.{way}.{side}" for way in ("bend", "out", "turn"))
    return [
        _hinge(bend, "spine.twist", (x * 0.2322, 0.3708, 0), (-1, 0, 0), -60, 180),
        _hinge(out, bend, (0, 0, 0), (0, 0, x), -30, 180),
        _hinge(turn, out, (0, 0, 0), (0, -x, 0), -90, 70),
        _hinge(f"elbow.{side}", turn, (0, -0.3348, 0), (-1, 0, 0), 0, 150),
    ]


def _leg(side: str, x: int) -> list[Joint]:
    bend, out, turn = (f"hip.{way}.{side}" for way in ("bend", "out", "turn"))
    knee = f"knee.{side}"
    return [
        _hinge(bend, None, (x * 0.0835, 0, 0), (-1, 0, 0), -30, 120),
        _hinge(out, bend, (0, 0, 0), (0, 0, x), -30, 45),
        _hinge(turn, out, (0, 0, 0), (0, -x, 0), -45, 45),
        _hinge(knee, turn, (0, -0.441, 0), X, 0, 140),
        _hinge(f"ankle.{side}", knee, (0, -0.4428, 0), (-1, 0, 0), -50, 20),
    ]


def _feet_and_hands(tree: Tree) -> Effectors:
    """Find the balls of the feet and the hands, in the order of the thesis."""
    points = {
        "foot.l": ("ankle.l", BALL),
        "foot.r": ("ankle.r", BALL),
        "hand.r": ("elbow.r", HAND),
        "hand.l": ("elbow.l", HAND),
    }
    return Effectors.of(tree, points)


def _hinge(
    name: str,
    parent: str | None,
    offset: Vector,
    axis: Vector,
    lower: float,
    upper: float,
    rest: float = 0.0,
) -> Joint:
    """Make a hinge with its limits and its rest in degrees."""
    return Joint(
        name,
        parent,
        offset,
        axis,
        lower=radians(lower),
        upper=radians(upper),
        rest=radians(rest),
    )


def _in_world(
    rows: Sequence[tuple[str, str | None, Vector, Vector]], ends: dict[str, tuple[str, Vector]]
) -> Figure:
    """Make a figure of rows by their places in the world at θ = 0, as Buss has them."""
    places: dict[str | None, Vector] = {name: place for name, _, place, _ in rows}
    places[None] = (0, 0, 0)

    def offset(place: Vector, parent: str | None) -> Vector:
        return [a - b for a, b in zip(place, places[parent], strict=True)]

    tree = Tree.of(
        Joint(name, parent, offset(place, parent), axis) for name, parent, place, axis in rows
    )
    points = {name: (joint, offset(place, joint)) for name, (joint, place) in ends.items()}
    return Figure(tree, Effectors.of(tree, points))
