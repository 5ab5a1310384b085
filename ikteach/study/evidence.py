"""Chapter 8. What the sentences of the thesis are held against, beside the runs of `trials`."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from ikteach.arrays import Array
from ikteach.body import Effectors, Tree, forward, jacobian, locate
from ikteach.body.figures import human, planar_arm
from ikteach.motion import BUSS_CAPS, clip, gait, hold, ignore
from ikteach.motion.reachable import NEAR, nearest
from ikteach.motion.rules import LimitRule
from ikteach.solvers import SOLVERS, Solver, dls, sdls, transpose
from ikteach.study.experiment import Round, arrivals, starts, step_times, turns
from ikteach.study.runs import after
from ikteach.study.trials import TargetsOfTime, Trials, trials

IN_REACH = replace(gait.walking, name="in reach", x_hand=0.3)  # walking, and the hands arrive too
MOTIONS = {**gait.MOTIONS, "in reach": IN_REACH}
SMALL = replace(gait.walking, name="slow", speed=gait.walking.speed / 4)  # 1.4 cm in a frame
LIMITS: Mapping[str, LimitRule] = {"hold": hold, "clip": clip}
DAMPINGS = (0.05, 0.1, 0.2, 0.4, 0.8)  # λ [m/rad]
RATE = 30  # frames per second
CIRCLE = Round(centre=(-0.45, 0.25, 0.35), radius=0.12)  # which the right hand can follow
ROUNDS = 25  # of timing
MOST = 300  # steps, after which nobody waits for an arrival
BENDS = (4.0, 5.0, 6.0)  # of an arm that is nearly straight [°]

# The thesis's own settings: half of the best α (4.4.1), γ_max = 4/π (4.4.5), the pose put back to
# its limits (5.1.1), a cap for the pseudoinverse alone (4.4.2), here those of Buss, on whose code
# it builds. Its λ it does not print.
OWN: Mapping[str, Any] = {
    "methods": {
        **SOLVERS,
        "transpose": partial(transpose, gain=0.5),
        "sdls": partial(sdls, max_angle=4 / np.pi),
    },
    "limits": {"clip": clip},
    "caps": {"own": BUSS_CAPS},
}


class Evidence(NamedTuple):
    """Tables with a row per cell: factors, and what was measured.

    runs        of `trials`, and own, with the thesis's own settings
    single      of `trials`, of one hand with one target
    small       of `trials`, of a walk whose targets move by small increments
    reach       miss: how near any pose comes to a target [m]
    leaps       leap: how far a target moves in one frame [m]
    arrivals    steps, seconds until targets that can be met
    times       step, solve: seconds of one step, and of the solver alone
    operations  operations: multiplications of one step, by formula
    near        turn: the largest turn in a step of an arm that is nearly straight [°]
    feet        slip: how far a foot slides in a stance [m], clearance: how far it lifts [m]
                met: share of frames with d ≤ 0
    algebra     what a formula of the thesis comes to
    """

    runs: pd.DataFrame
    own: pd.DataFrame
    single: pd.DataFrame
    small: pd.DataFrame
    reach: pd.DataFrame
    leaps: pd.DataFrame
    arrivals: pd.DataFrame
    times: pd.DataFrame
    operations: pd.DataFrame
    near: pd.DataFrame
    feet: pd.DataFrame
    algebra: pd.DataFrame


def gather(ours: Trials, own: Trials) -> Evidence:
    """Measure what the sentences speak of beside these experiments.

    ours, own  `trials` of the human with MOTIONS, and with the thesis's OWN settings
    """
    tree, effectors = human()
    walk = gait.walking(gait.walking.clock(20))
    times = _times(tree, effectors, walk)
    return Evidence(
        runs=ours.table,
        own=own.table,
        single=_alone(tree, one_hand(tree), {"circle": CIRCLE}),
        small=_alone(tree, effectors, {"slow": SMALL}, seconds=1 + SMALL.period),
        reach=_reach(tree, effectors),
        leaps=_leaps(),
        arrivals=_arrivals(tree, effectors, times),
        times=times,
        operations=_operations(3 * len(effectors), len(tree)),
        near=_near(),
        feet=_feet(ours),
        algebra=pd.concat([_straight(), _drawn(ours), _by_the_model(tree, effectors)]),
    )


def with_damping(dampings: Iterable[float] = DAMPINGS) -> list[tuple[str, float, Solver]]:
    """List each method at each λ: (method, λ, solver). But for DLS, λ changes nothing."""
    return [
        (name, one, partial(dls, damping=one) if name == "dls" else solver)
        for name, solver in SOLVERS.items()
        for one in dampings
    ]


def one_hand(tree: Tree) -> Effectors:
    """Take the right hand alone."""
    whole = human().effectors
    hand = whole.names.index("hand.r")
    joint = tree.names[whole.joints[hand]]
    return Effectors.of(tree, {"hand.r": (joint, whole.offsets[hand].tolist())})


def _alone(
    tree: Tree, effectors: Effectors, motion: Mapping[str, TargetsOfTime], **options: Any
) -> pd.DataFrame:
    """Run the methods on one motion, with equal caps."""
    caps = {"equal": dict.fromkeys(SOLVERS, np.radians(30))}
    same: dict[str, Any] = {"starts": starts(tree, 5), "limits": LIMITS, "dampings": DAMPINGS}
    return trials(tree, effectors, motion, caps=caps, **same, **options).table


def _reach(tree: Tree, effectors: Effectors, phases: int = 8) -> pd.DataFrame:
    """Search how near any pose comes to each target, at phases of each motion."""
    angles = np.linspace(0, 2 * np.pi, phases, endpoint=False)
    targets = np.stack([motion.at(angles) for motion in MOTIONS.values()])
    miss = nearest(tree, effectors, targets, within=NEAR)
    cells = product(MOTIONS, range(phases), effectors.names)
    return pd.DataFrame(cells, columns=["motion", "round", "effector"]).assign(miss=miss.ravel())


def _leaps() -> pd.DataFrame:
    """Find the largest leap of a target in one frame."""
    times = np.arange(RATE * 2) / RATE
    far = {
        name: np.linalg.norm(np.diff(motion(times), axis=0), axis=-1).max()
        for name, motion in MOTIONS.items()
    }
    return pd.DataFrame({"motion": [*far], "leap": [*far.values()]})


def _times(tree: Tree, effectors: Effectors, targets: Array) -> pd.DataFrame:
    """Time a step of each method, and the solver alone, in turns."""
    frames = forward(tree, tree.rest)
    J, s = jacobian(tree, frames, effectors), locate(frames, effectors)
    errors = [np.ravel(goal - s) for goal in targets]

    def solves(solver: Solver) -> None:
        for e in errors:
            solver(J, e)

    alone = turns({name: partial(solves, solver) for name, solver in SOLVERS.items()}, ROUNDS)
    # Without limits every method has the same to do around the solver.
    step = step_times(tree, effectors, targets, rounds=ROUNDS, limits=ignore)
    solve = {name: seconds.min() / len(targets) for name, seconds in alone.items()}
    return pd.DataFrame({"step": step, "solve": solve}).rename_axis("method").reset_index()


def _arrivals(tree: Tree, effectors: Effectors, times: pd.DataFrame) -> pd.DataFrame:
    """Count the steps to targets that can be met, and the seconds that they take."""
    each = times.set_index("method")["step"]
    parts = []
    for rule, (method, damping, solver) in product(LIMITS, with_damping()):
        steps = arrivals(tree, effectors, solver, poses=12, most=MOST, limits=LIMITS[rule])
        steps = np.minimum(steps, MOST)
        cell = {"method": method, "damping": damping, "limits": rule, "start": range(len(steps))}
        parts.append(pd.DataFrame({**cell, "steps": steps, "seconds": steps * each[method]}))
    return pd.concat(parts, ignore_index=True)


def _operations(m: int, n: int) -> pd.DataFrame:
    """Count multiplications and additions of one step with a J (m, n), m < n.

    Golub & Van Loan, Matrix Computations, 8.6: an SVD with U, σ and the rows of Vᵀ that count.
    """
    svd = 14 * n * m**2 + 8 * m**3
    counts = {
        "transpose": 4 * m * n + 4 * m,
        "pseudoinverse": svd + 2 * m**2 + 2 * m * n,
        "dls": n * m**2 + m**3 / 3 + 2 * m**2 + 2 * m * n,  # JJᵀ is symmetric; Cholesky
        "sdls": svd + 2 * m**2 + 9 * m * n + 6 * m**2,  # M, φ, their bounds and their sum
    }
    return pd.DataFrame({"method": [*counts], "operations": [*counts.values()]})


def _bent(bend: float) -> tuple[Array, Array]:
    """Find J (2, 3) of an arm along x that is bent by some degrees, and an error inward."""
    tree, hand = planar_arm(3)
    frames = forward(tree, np.radians([0, bend, 0]))
    J, s = jacobian(tree, frames, hand)[:2], locate(frames, hand)[0, :2]
    return J, -0.1 * s / np.linalg.norm(s)


def _near() -> pd.DataFrame:
    """Find the largest turn in a step near a singular pose."""
    rows = []
    for bend, (method, damping, solver) in product(BENDS, with_damping()):
        J, e = (np.concatenate([part, part[:1] * 0]) for part in _bent(bend))  # z: sdls needs it
        turn = np.degrees(abs(solver(J, e)).max())
        rows.append({"method": method, "damping": damping, "bend": bend, "turn": turn})
    return pd.DataFrame(rows)


def _feet(ours: Trials) -> pd.DataFrame:
    """Measure how feet stand and lift, in each run of walking."""
    walk = gait.walking
    rows = ours.table.loc[ours.table["motion"] == "walking"]
    feet = []
    for row in rows.index:
        run = after(ours.run(row), ours.settle)
        T, foot = run.times, run.positions[:, 1]
        back = np.diff(run.targets[:, 1, 2]) < 0  # the target swings back: the foot stands
        height = foot[1:, 1]
        slid = abs(np.diff(foot[:, 2] + walk.pace * T))[back].sum()
        stances = back.sum() * (T[1] - T[0]) / (walk.period / 2)
        met = (run.error[:, :2] <= 0).mean()
        feet.append((slid / stances, height[~back].mean() - height[back].mean(), met))
    return rows.assign(**dict(zip(("slip", "clearance", "met"), np.transpose(feet), strict=True)))


def _straight() -> pd.DataFrame:
    """Ask the formulas of 4.3.2, 4.4.2 and 4.4.4 of a straight arm and of a bent one."""
    rows = []
    for pose, bend in ("straight", 0.0), ("bent", 40.0):
        J, _ = _bent(bend)
        sigma = np.linalg.svdvals(J)
        rows.append({"pose": pose, "weakest": sigma[-1] / sigma[0], "formula": _formula_gap(J)})
    n, m = len(human().tree), 3 * len(human().effectors)
    U = np.eye(m, n)  # of T's shape, and as near to orthogonal as that shape can be
    rows.append({"pose": "any", "unitary": np.linalg.norm(U.T @ U - np.eye(n))})
    axes = np.ptp(gait.walking(np.linspace(0, 1, 50)), axis=0).max(axis=0) > 0
    rows.append({"pose": "any", "axes": axes.sum()})
    return pd.DataFrame(rows)


def _formula_gap(J: Array) -> float:
    """Tell how far Jᵀ(JJᵀ)⁻¹ is from the pseudoinverse, as share of it; infinite if it is none."""
    right = np.linalg.pinv(J)
    try:
        return float(np.linalg.norm(J.T @ np.linalg.inv(J @ J.T) - right) / np.linalg.norm(right))
    except np.linalg.LinAlgError:
        return np.inf


def _drawn(ours: Trials) -> pd.DataFrame:
    """Measure how far the right foot of a wounded body is drawn from where it is logged."""
    tree = human().tree
    weight = np.where(np.array(tree.names) == "knee.r", 0.3, 1.0)
    rows = ours.table.loc[(ours.table["motion"] == "walking") & (ours.table["limits"] == "hold")]
    drawn = []
    for row in rows.index:
        run = after(ours.run(row), ours.settle)
        foot = locate(forward(tree, gait.displayed(run.theta, times=weight)), run.effectors)
        drawn.append(np.linalg.norm(foot - run.positions, axis=-1)[:, 1].mean())
    return rows[["method", "damping", "caps", "start"]].assign(drawn=drawn)


def _by_the_model(tree: Tree, effectors: Effectors) -> pd.DataFrame:
    """Compare what half of α and all of it leave of e, and J at targets with J at effectors."""
    poses = starts(tree, 5)
    frames = forward(tree, poses)
    J = jacobian(tree, frames, effectors)
    e = (gait.walking(0.2) - locate(frames, effectors)).reshape(len(poses), -1)
    other = jacobian(tree, frames, effectors, at=gait.walking(0.2))
    moved = np.linalg.norm(other - J, axis=(-2, -1)) / np.linalg.norm(J, axis=(-2, -1))
    left = [
        np.linalg.norm(e - np.matvec(J, transpose(J, e, gain=gain)), axis=-1) for gain in (0.5, 1)
    ]
    measured = {"half": left[0] / left[1], "at_targets": moved}
    return pd.DataFrame({"start": range(len(poses)), **measured})
