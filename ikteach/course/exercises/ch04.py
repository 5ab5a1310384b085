"""Chapter 4. The pseudoinverse: what the null space is, and a cap that spares the feet."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree, numbers_apart
from ikteach.motion import gait, track


def ranked() -> Iterator[tuple[Array, int]]:
    """J and its rank: wide, tall, with a rank that is lost, nearly lost, and in other units."""
    rng = np.random.default_rng(4)
    for shape in ((3, 7), (6, 4), (1, 3), (5, 5)):
        yield rng.normal(size=shape), min(shape)
    lost = rng.integers(-3, 4, (6, 2)) @ rng.integers(-3, 4, (2, 9)).astype(float)
    yield lost, 2
    yield 1e-6 * lost, 2
    yield 1e-6 * rng.normal(size=(3, 7)), 3
    yield np.diag([1.0, 3e-4, 1.0]) @ rng.normal(size=(3, 6)), 3
    yield np.zeros((3, 4)), 0


@exercise(
    "04.projector",
    returns=lambda J: (J.shape[1], J.shape[1]),
    hints=[
        "J⁺J keeps the part of Δθ that moves the effectors. What keeps the rest?",
        "P = I − J⁺J; J⁺ is not Jᵀ(JJᵀ)⁻¹ where J lost a rank, for JJᵀ has no inverse there.",
        "`return np.eye(J.shape[1]) - np.linalg.pinv(J) @ J`",
    ],
)
def projector(answer: Answer) -> None:
    for J, rank in ranked():
        P = answer(J)
        n, size = J.shape[1], float(abs(J).max()) or 1.0
        about = f"For a J of {J.shape[0]} × {n} and rank {rank}"
        for name, what, meaning in (
            ("JP", J @ P / size, "what P lets through moves effectors"),
            ("P² − P", P @ P - P, "P² is not P, and to project twice must change nothing"),
            ("P − Pᵀ", P - P.T, "P is not symmetric: it does not project at right angles"),
        ):
            largest = float(abs(what).max())
            expect(
                largest < 1e-4,
                f"{about} {name} is not zero, its largest entry is {largest:.2g}: {meaning}.",
            )
        expect(
            abs(np.trace(P) - (n - rank)) < 1e-3,
            f"{about} the trace of P is {np.trace(P):.4g}; it counts the free directions, and "
            f"{n - rank} of {n} are free.",
        )


def uncapped() -> Iterator[tuple[Array, float, Array]]:
    """dtheta, max_step and chains: numbers in any order, peaks of either sign, on the bound too."""
    rng = np.random.default_rng(5)
    layouts = [[2, 2, 0, 0, 0, 1, 1], [7, -1, 7, 3, -1, 3, 7], [5], [1, 1, 1], [0, 1, 2, 0, 1, 2]]
    for _ in range(8):
        layouts.append(list(rng.choice([-2, 0, 3, 11], rng.integers(2, 12))))
    for layout in layouts:
        for size in (0.01, 1.0, 50.0):
            chains, bound = np.array(layout), float(rng.choice([0.05, 0.1, 0.7]))
            dtheta = size * rng.uniform(-1, 1, len(chains)) * 10.0 ** rng.integers(-1, 2)
            yield dtheta, bound, chains
            dtheta = dtheta.copy()
            dtheta[chains == chains[0]] *= bound / abs(dtheta[chains == chains[0]]).max()
            yield dtheta, bound, chains  # a chain just on the bound
            yield np.where(chains == chains[-1], 0, dtheta), bound, chains  # one that stands


def per_chain(dtheta: Array, bound: float, chains: Array) -> Array:
    """The joints of each chain, shortened together."""
    done = dtheta.copy()
    for chain in set(chains.tolist()):
        peak = abs(dtheta[chains == chain]).max()
        done[chains == chain] *= bound / peak if peak > bound else 1
    return done


@exercise(
    "04.cap",
    returns=lambda dtheta, max_step, chains: dtheta.shape,
    hints=[
        "Which joints decide by how much the others of their chain are shortened?",
        "Multiply the joints of one chain by min(1, max_step / their largest |Δθ|).",
        "`for chain in np.unique(chains): ours = chains == chain; peak = abs(dtheta[ours]).max()`",
    ],
    seconds=20,
)
def cap(answer: Answer) -> None:
    for dtheta, bound, chains in uncapped():
        done, wanted = answer(dtheta, bound, chains), per_chain(dtheta, bound, chains)
        i = int((abs(done - wanted) / (abs(wanted) + 1e-9)).argmax())
        ours = chains == chains[i]
        was, now, right = numbers_apart(dtheta[i], done[i], wanted[i])
        peak = abs(dtheta[ours]).max()
        where = (
            f"With max_step {bound:g} and chains {chains.tolist()}, "
            f"joint {i + 1} was to turn by {was}"
        )
        expect(
            abs(done).max() <= bound * (1 + 1e-4),
            f"{where}. Now a joint turns by {abs(done).max():.5g}, further than max_step.",
        )
        if abs(done[ours]).max() > 0:
            share = done[ours] * peak - dtheta[ours] * abs(done[ours]).max()
            expect(
                abs(share).max() <= 1e-4 * peak * bound,
                f"{where}, you say {now}, and {right} is right: the joints "
                f"of a chain shrink by the "
                "same share, or the hand goes elsewhere.",
            )
        expect(
            np.allclose(done, wanted, rtol=1e-4, atol=1e-7 * bound),
            f"{where}, and the largest turn of its chain is {peak:.4g}: you say {now}, and {right} "
            f"is right. It is "
            f"{'shortened too much' if abs(done[i]) < abs(wanted[i]) else 'made longer'}.",
        )
    agree(answer(np.zeros(7), 0.1, np.arange(7)), np.zeros(7), "A step of zero became {found}.")
    left = float(feet(answer).max())
    expect(
        left < 1e-3,
        f"With both hands out of reach a foot stays {1000 * left:.2f} mm from a target that it can "
        "reach; less than 1 mm is wanted.",
    )


def feet(cap: Answer) -> Array:
    """Distance of each foot [m] after 2 s of standing, with both hands out of reach."""
    tree, effectors = figures.human()
    targets = np.tile(replace(gait.walking, x_hand=1.2).at(0.3), (60, 1, 1))
    run = track(tree, effectors, targets, "pseudoinverse", max_step=np.radians(5), cap=cap)
    return run.error[-1, :2]
