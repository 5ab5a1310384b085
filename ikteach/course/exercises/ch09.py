"""Chapter 9: a mix of methods, a method per effector; and a solver of one's own."""

from typing import Any

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures, forward, jacobian, locate
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import NAME, NotYetError, WrongError, kind, of_form
from ikteach.motion import gait, track
from ikteach.motion.mix import Mix
from ikteach.solvers import SOLVERS
from ikteach.study.experiment import nearby

FEET, SHAKE = 0.002, 3.0  # [m] and [degrees per tick²]: what no single method keeps to at once
FRAMES, SETTLING = 120, 30
POSES = 64  # to start from: some mixes are chaotic, and freeze from a few of them only


def walk(solver: Any) -> tuple[float, float]:
    """Mean distance of the feet [m] and jitter [degrees] of 4 s of walking, the first left out.

    The worst of many starts that differ by rounding alone.
    """
    tree, effectors = figures.human()
    targets = gait.walking(gait.walking.clock(FRAMES))
    run = track(tree, effectors, targets[:, None], solver, theta=nearby(tree.rest, POSES))
    feet = [name.startswith("foot") for name in effectors.names]
    distance = run.error[SETTLING:, :, feet].mean(axis=(0, 2))
    jitter = np.degrees(run.jitter[SETTLING:].mean(axis=0))
    return float(distance.max()), float(jitter.max())


@exercise(
    "09.mix",
    returns=None,
    value=True,
    hints=[
        "The feet can be reached, the hands cannot. Who is good at each of these?",
        "An undamped or selectively damped method for the feet, the calmest for the hands.",
        '`{"foot.l": "sdls", "foot.r": "sdls", "hand.r": …, "hand.l": …}`: now try the arms.',
    ],
    seconds=30,
)
def mix(value: Any) -> None:
    """my_mix: {effector: method} that keeps the feet near and the figure calm."""
    _, effectors = figures.human()
    chosen = named(value)
    for name in effectors.names:
        expect(name in chosen, f"{name!r} has no method in your mix.")
    for name, method in chosen.items():
        expect(name in effectors.names, f"There is no effector {name!r}.")
        expect(method in SOLVERS, f"{method!r} is none of {', '.join(SOLVERS)}.")
    feet, shake = walk(Mix.of(effectors, chosen))
    expect(
        feet < FEET,
        f"The feet are {1000 * feet:.2f} mm from their targets, and below {1000 * FEET:g} mm is "
        "wanted.",
    )
    expect(
        shake < SHAKE,
        f"The figure shakes by {shake:.2f}° per tick, and below {SHAKE:g}° is wanted.",
    )


def named(value: Any) -> dict[str, str]:
    """The mix with each method by its name."""
    try:
        pairs = {} if isinstance(value, str) else dict(value)
    except (TypeError, ValueError):
        pairs = {}
    if not pairs:
        raise WrongError(f"A mix is a dictionary {{effector: method}}, not {kind(value)}.")
    if any(method is ... for method in pairs.values()):
        raise NotYetError("name a method for every effector.")
    return {
        str(name): of_form(method, NAME, f"The method of {name!r} is")
        for name, method in pairs.items()
    }


BODIES = (figures.human, figures.planar_arm, figures.simulator)
STEPS, STARTS, CAP = 60, 5, np.radians(5)  # of a drive


@exercise(
    "09.solver",
    returns=lambda J, e: J.shape[1:],
    hints=[
        "Which direction of Δθ surely brings the effectors nearer: what is the slope of ‖e‖²?",
        "Downhill is Jᵀe. How far? α Jᵀe (chapter 3), or Jᵀ(JJᵀ + λ²I)⁻¹e (chapter 5).",
        "`return J.T @ np.linalg.solve(J @ J.T + 0.1**2 * np.eye(len(e)), e)`",
    ],
    seconds=30,
)
def solver(answer: Answer) -> None:
    """my_solver(J (m, n), e (m,)) -> Δθ (n,) drives any body towards its targets."""
    rng = np.random.default_rng(9)
    for body in BODIES:
        tree, effectors = body()
        for _ in range(6):
            theta = tree.rest + rng.uniform(-0.5, 0.5, len(tree))
            J = jacobian(tree, forward(tree, theta), effectors)
            e = rng.normal(size=len(J)) * 10.0 ** rng.uniform(-3, 0)
            dtheta = answer(J, e)
            gain = float(e @ (J @ dtheta))
            expect(
                gain > 0,
                f"With J {J.shape} and an error of {np.linalg.norm(e):.3g} m your step "
                f"{'leads away from' if gain < 0 else 'does not lead to'} the targets: "
                f"⟨e, JΔθ⟩ is {gain:.3g}, and it must be above 0.",
            )
        still = answer(J, np.zeros(len(J)))
        expect(
            abs(still).max() < 1e-9,
            f"Where the error is 0 your step is {abs(still).max():.3g} rad.",
        )
    tree, effectors = figures.planar_arm()
    straight = jacobian(tree, forward(tree, np.zeros(len(tree))), effectors)
    answer(straight, np.array([-0.1, 0, 0]))  # whatever it is, it must be a finite step
    for body in BODIES:
        before, after = driven(answer, body)
        expect(
            after < 0.25 * before,
            f"{STEPS} steps of at most 5° a joint leave a body of {len(body()[0])} joints "
            f"{100 * after:.1f} cm from targets that it can reach; it began {100 * before:.1f} cm "
            "away, and less than a quarter should be left.",
        )


def driven(solver: Any, body: Any) -> tuple[float, float]:
    """Median distance to targets that can be reached, before and after some steps [m]."""
    tree, effectors = body()
    rng = np.random.default_rng(90)
    goal, start = tree.rest + rng.uniform(-0.3, 0.3, (2, STARTS, len(tree)))
    targets = locate(forward(tree, np.clip(goal, tree.lower, tree.upper)), effectors)
    start = np.clip(start, tree.lower, tree.upper)
    before = np.linalg.norm(targets - locate(forward(tree, start), effectors), axis=-1)
    run = track(
        tree,
        effectors,
        np.broadcast_to(targets, (STEPS, *targets.shape)),
        one_by_one(solver),
        theta=start,
        max_step=CAP,
    )
    return float(np.median(before)), float(np.median(run.error[-1]))


def one_by_one(solver: Any) -> Any:
    """Make of a solver for one pose, J (m, n), one for a batch (..., m, n)."""

    def batch(J: Array, e: Array) -> Array:
        flat = zip(J.reshape(-1, *J.shape[-2:]), e.reshape(-1, e.shape[-1]), strict=True)
        made = [solver(one, error) for one, error in flat]
        return np.reshape(made, (*J.shape[:-2], J.shape[-1]))

    return batch
