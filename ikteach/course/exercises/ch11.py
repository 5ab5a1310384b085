"""Chapter 11: the order of turns, who stands, and a gait's score."""

import numpy as np

from ikteach.body import Tree, forward
from ikteach.body.figures import ball
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree

ORDERS = ("Z", "XY", "ZXY", "YXZ", "XYZ", "ZYX", "YZX", "XZY")
NEAR = 1e-3  # [cycles] from where a foot comes down or leaves: there, either answer will do


@exercise(
    "11.turn",
    returns=lambda order, degrees: (3, 3),
    hints=[
        "The last channel turns the bone first: which matrix stands next to the vector?",
        "R = R₁ R₂ R₃ as the file has them; R_x = [[1, 0, 0], [0, c, −s], [0, s, c]], and so on "
        "round: x, y, z, x.",
        "For each: `i = 'XYZ'.index(letter); j, k = (i + 1) % 3, (i + 2) % 3`, "
        "`A = np.eye(3); A[j, j] = A[k, k] = c; A[k, j] = s; A[j, k] = -s`, `R = R @ A`",
    ],
)
def turn(answer: Answer) -> None:
    """turn(order, degrees) -> R (3, 3) of rotation channels in the order of the file."""
    rng = np.random.default_rng(11)
    for order in (*"XYZ", *ORDERS):
        tree = Tree.of(ball("joint", order=order))
        for degrees in (rng.uniform(-180, 180, len(order)).round(1), np.full(len(order), 90.0)):
            wanted = forward(tree, np.radians(degrees)).orientations[-1]
            given = degrees.tolist()
            found = answer(order, given)
            about = f"For {order} with {given}° "
            long = np.linalg.norm(found, axis=0)
            expect(
                bool(np.allclose(long, 1, atol=1e-4)),
                f"{about}the columns of yours are {', '.join(f'{x:.3g}' for x in long)} long: a "
                "turn keeps lengths.",
            )
            other = forward(Tree.of(ball("joint", order=order[::-1])), np.radians(degrees[::-1]))
            expect(
                np.allclose(found, wanted, atol=1e-4)
                or not np.allclose(found, other.orientations[-1], atol=1e-4),
                f"{about}yours is the product in the other order: the last channel stands next to "
                "the bone.",
            )
            expect(
                np.allclose(found, wanted, atol=1e-4)
                or not np.allclose(found, wanted.T, atol=1e-4),
                f"{about}yours turns the other way round.",
            )
            agree(found, wanted, f"{about}you say {{found}}, where {{wanted}} is right.", size=1)


@exercise(
    "11.stands",
    returns=lambda phase, duty, late: np.shape(phase),
    hints=[
        "How long ago, in cycles, did the foot come down last?",
        "It is (phase − late) mod 1, from 0 to 1 also for negative phases.",
        "`return np.mod(phase - late, 1) < duty`",
    ],
)
def stands(answer: Answer) -> None:
    """stands(phase (m,), duty, late) -> (m,) says whether the foot stands."""
    rng = np.random.default_rng(12)
    cases = [(0.6, 0.0), (0.6, 0.5), (0.35, 0.0), (0.75, -0.3), (0.52, 1.7)]
    cases += [(round(d, 2), round(s, 2)) for d, s in rng.uniform((0.2, -2), (0.9, 2), (6, 2))]
    for duty, late in cases:
        phase = np.concatenate([np.linspace(0, 1, 101), rng.uniform(-3, 3, 200)])
        since = np.mod(phase - late, 1)
        clear = (abs(since - duty) > NEAR) & (since > NEAR) & (since < 1 - NEAR)
        phase, since = phase[clear], since[clear]
        found = np.asarray(answer(phase, duty, late))
        expect(
            bool(np.isin(found, (0, 1)).all()),
            f"Yours has {found[~np.isin(found, (0, 1))][:1]}: a foot stands or does not.",
        )
        wrong = np.flatnonzero(found.astype(bool) != (since < duty))
        if len(wrong):
            at = phase[wrong[0]]
            does = "stands" if since[wrong[0]] < duty else "swings"
            share = found.astype(bool)[(phase >= 0) & (phase < 1)].mean()
            expect(
                False,
                f"With duty {duty:g} and late {late:g}, at the phase {at:.3f} the foot {does}: it "
                f"came down {since[wrong[0]]:.3f} cycles before. Yours stands for {share:.2f} of "
                "the cycle from 0 to 1.",
            )


@exercise(
    "11.score",
    returns=(),
    hints=[
        "Over what do you average: squares, or what is left of each side?",
        "norm[:, None] has a place for the sides; the mean is over all joints, sides and times.",
        "`return np.sqrt(np.mean((angles - norm[:, None]) ** 2))`",
    ],
)
def score(answer: Answer) -> None:
    """score(angles (c, s, 51), norm (c, 51)) -> how far they are apart [degrees]."""
    rng = np.random.default_rng(13)
    shapes = [(4, 2), (1, 1), (3, 2), (2, 2), (5, 3), (4, 2)]
    norms = [rng.normal(0, 20, (c, 51)) for c, _ in shapes]
    for (_, sides), norm in zip(shapes, norms, strict=True):
        same = np.repeat(norm[:, None], sides, axis=1)
        agree(
            float(answer(same, norm)),
            0.0,
            "On the norm itself the score is 0, and you say {found}°.",
            size=1.0,
        )
        agree(
            float(answer(same + 5.0, norm)),
            5.0,
            "Where all angles are 5° above the norm the score is {wanted}°, and you say {found}.",
        )
        if sides == 2:
            apart = same + np.array([7.0, -7.0])[:, None]
            agree(
                float(answer(apart, norm)),
                7.0,
                "Where one side is 7° above and the other 7° below the norm, the score is "
                "{wanted}°, and you say {found}: squares are averaged, not sides.",
            )
        angles = same + rng.normal(0, rng.uniform(1, 20), same.shape) * rng.uniform(
            0, 2, (1, 1, 51)
        )
        angles[0] += rng.uniform(5, 30)
        agree(
            float(answer(angles, norm)),
            float(np.sqrt(np.mean((angles - norm[:, None]) ** 2))),
            f"For angles {angles.shape} you say {{found}}°, and the root of the mean square is "
            "{wanted}°.",
        )
