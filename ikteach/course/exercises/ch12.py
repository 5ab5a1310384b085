"""Chapter 12: the column of a direction, the lock of three hinges, and what fixed joints hold."""

import numpy as np

from ikteach.body import Joint, Tree, forward
from ikteach.body.figures import ball
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree, parts
from ikteach.motion.paths.walk import turned

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


@exercise(
    "12.column",
    returns=lambda v, s, slide: np.shape(v),
    hints=[
        "How does an arrow change that turns about v, and how one that is only moved?",
        "It turns with the speed v × s, wherever it is; moved along, it stays the same arrow.",
        "`return np.zeros(3) if slide else np.cross(v, s)`",
    ],
)
def column(answer: Answer) -> None:
    """column(v (3,), s (3,), slide) -> (3,) is the column of J for a direction."""
    rng = np.random.default_rng(12)
    for slide in (False, True) * 5:
        v, s = rng.normal(size=(2, 3)).round(2)
        v = v / np.linalg.norm(v)
        found, wanted = np.asarray(answer(v, s, slide)), np.zeros(3) if slide else np.cross(v, s)
        what = f"For a {'slide' if slide else 'hinge'} along {v.round(2)} and s = {s}"
        expect(
            slide or not np.allclose(found, -wanted, rtol=1e-4, atol=1e-9),
            f"{what} yours turns the other way round.",
        )
        if slide:
            expect(
                np.allclose(found, 0, atol=1e-9),
                f"{what} you say {found.round(3)}: a direction that is moved along is still the "
                "same direction.",
            )
        agree(found, wanted, f"{what} you say {{found}}, where {{wanted}} is right.", size=1)


@exercise(
    "12.sigma",
    returns=(),
    hints=[
        "Where the middle one stands at 0 the axes are at right angles: what is σ then? At 90°?",
        "Two axes at an angle whose cosine is c, and the third at right angles to both: "
        "σ² is 1 + |c|, 1 and 1 − |c|; and c is ± sin(middle).",
        "`return np.sqrt(1 - abs(np.sin(middle)))`",
    ],
)
def sigma(answer: Answer) -> None:
    """sigma(order, middle) -> the smallest singular value of three axes as they stand."""
    rng = np.random.default_rng(13)
    angles = [0.0, np.pi / 2, -np.pi / 2, np.pi, 0.3, -0.3, 1.4, 2.8, *rng.uniform(-4, 4, 8)]
    for i, middle in enumerate(angles):
        order = ORDERS[i % 6]
        tree = Tree.of(ball("joint", order=order))
        theta = np.array([rng.uniform(-3, 3), middle, rng.uniform(-3, 3)])
        axes = np.matvec(forward(tree, theta).orientations, tree.axes)
        agree(
            float(answer(order, float(middle))),
            float(np.linalg.svdvals(axes)[-1]),
            f"For {order} with the middle hinge at {np.degrees(middle):.1f}° you say {{found}}, "
            "and the axes that `forward` gives have {wanted}.",
            size=1.0,
        )


@exercise(
    "12.fixed",
    returns=parts("an offset", "an axis"),
    hints=[
        "In whose frame is xyz, and in whose is a?",
        "xyz is seen from the link: it is C xyz in the row, from d on. a is seen from the turned "
        "origin: R a in the link, C R a in the row.",
        "`return d + C @ xyz, C @ R @ a`",
    ],
)
def fixed(answer: Answer) -> None:
    """fixed(C (3, 3), d, xyz (3,), R (3, 3), a) -> offset (3,) and axis (3,) in the row."""
    rng = np.random.default_rng(14)
    for _ in range(6):
        turns = [
            turned("x", np.asarray(x)) @ turned("y", np.asarray(y)) @ turned("z", np.asarray(z))
            for x, y, z in rng.uniform(-180, 180, (2, 3))
        ]
        C, R = turns
        d, xyz, a = rng.normal(size=(3, 3)).round(2)
        a /= np.linalg.norm(a)
        given = tuple(np.asarray(one, dtype=float) for one in answer(C, d, xyz, R, a))
        expect(
            all(one.shape == (3,) for one in given),
            f"Offset and axis are (3,) each, and yours are {given[0].shape} and {given[1].shape}.",
        )
        # The same by the tree itself: the link as a row that does not turn.
        rows = [Joint("row"), Joint("link", "row", d.tolist())]
        place = forward(Tree.of(rows), np.zeros(2)).positions[1] + C @ xyz
        agree(
            given[0],
            place,
            "Of the offset you say {found}, where {wanted} is right: xyz is seen from the link, "
            "whose origin is at d.",
            size=1.0,
        )
        agree(
            given[1],
            C @ (R @ a),
            "Of the axis you say {found}, where {wanted} is right: a is seen from the turned "
            "origin, and that from the link.",
            size=1.0,
        )
