"""Inputs at random for each exercise, drawn without a look at what its check draws.

DRAWS  key -> a function of a random generator that gives the arguments of one call
RIGHT  key -> whether an answer is right in another way than the solution, by the exercise's words;
       for those exercises that have many right answers
"""

from functools import cache
from typing import Any

import numpy as np
import pandas as pd

from ikteach import figures, forward, gait, jacobian, locate, track
from ikteach.motion.mix import Mix
from ikteach.study.experiment import nearby, starts

Random = np.random.Generator


def _matrix(rng: Random, m: int = 0, n: int = 0) -> Any:
    """J with singular values within a factor of a hundred, in any unit."""
    m, n = m or int(rng.integers(1, 8)), n or int(rng.integers(1, 9))
    U, _, Vt = np.linalg.svd(rng.normal(size=(m, n)), full_matrices=False)
    return (U * 10.0 ** rng.uniform(-1, 1, min(m, n))) @ Vt * 10.0 ** rng.choice([-3, 0, 0, 2])


def _lost(rng: Random, n: int) -> Any:
    """A straight arm that points anywhere in the plane."""
    way = rng.uniform(0, 2 * np.pi)
    return np.outer([-np.sin(way), np.cos(way)], rng.uniform(0.2, 2, n))


def _error(rng: Random, m: int) -> Any:
    return rng.normal(size=m) * 10.0 ** rng.uniform(-6, 1)


def hand(rng: Random) -> Any:
    return rng.uniform(-4, 4, 3), rng.uniform(0.1, 2, 3)


def reach(rng: Random) -> Any:
    a, b = rng.uniform(0.1, 3, 2)
    share = 1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-2.9, 0)
    d, way = share * rng.choice([abs(a - b), a + b, a, b]), rng.uniform(0, 2 * np.pi)
    if rng.random() < 0.2:  # numbers that nothing rounds, just on an end
        a, b, d = 2.0, 0.5, rng.choice([1.5, 2.5])
        way = 0.0
    return d * np.cos(way), d * np.sin(way), a, b


def column(rng: Random) -> Any:
    v, p, s = rng.normal(size=(3, 3))
    return v / np.linalg.norm(v), p, s


def cramer(rng: Random) -> Any:
    J = _matrix(rng, 3, 3)
    if rng.random() < 0.3:
        J = rng.normal(size=(3, 2)) @ rng.normal(size=(2, 3)) * 10.0 ** rng.uniform(-3, 3)
    return J, rng.normal(size=3)


def classify(rng: Random) -> Any:
    if rng.random() < 0.4:
        J = _lost(rng, int(rng.integers(2, 5)))
        along = np.array([J[1, 0], -J[0, 0]])
        return J, (along if rng.random() < 0.5 else J[:, 0]) * 10.0 ** rng.uniform(-3, 1)
    m, n = rng.choice([(2, 2), (3, 6), (5, 3), (12, 20)])
    U, _, Vt = np.linalg.svd(rng.normal(size=(m, n)), full_matrices=False)
    sigma = 10.0 ** rng.uniform(-0.5, 0.5, min(m, n))
    sigma[-1] = 0.1 * 10.0 ** (rng.choice([-1, 1]) * rng.uniform(0.05, 2))
    part = rng.choice([0, 1, 2])
    e = U[:, -1] if part == 0 else U @ rng.normal(size=min(m, n)) if part == 1 else None
    return (U * sigma) @ Vt, rng.normal(size=m) if e is None else e


def volume(rng: Random) -> Any:
    return *rng.uniform(0.1, 3, 2), rng.uniform(-np.pi, np.pi)


def downhill(rng: Random) -> Any:
    J = _matrix(rng)
    return J, _error(rng, len(J))


def safe(rng: Random) -> Any:
    kind = rng.integers(5)
    if kind == 0:  # straight along x, so that zeros are zeros
        J = np.array([[0.0, 0.0], [rng.uniform(1, 3), rng.uniform(0.1, 1)]])
        return J, np.array([rng.normal(), rng.choice([0.0, 1.0]) * rng.normal()])
    if kind == 1:
        J = _matrix(rng)
        return J, np.zeros(len(J))
    return downhill(rng)


def left(rng: Random) -> Any:
    return rng.uniform(0, 4), rng.uniform(0, 1)


def projector(rng: Random) -> Any:
    lost = rng.integers(-4, 5, (5, 2)) @ rng.integers(-4, 5, (2, 6)).astype(float)
    return (lost if rng.random() < 0.3 else _matrix(rng),)


def cap(rng: Random) -> Any:
    n = int(rng.integers(1, 12))
    chains = rng.choice([-3, 0, 1, 4, 9], n)
    dtheta = rng.normal(size=n) * 10.0 ** rng.uniform(-2, 1)
    dtheta[chains == rng.choice(chains)] *= rng.choice([0, 1])
    return dtheta, 10.0 ** rng.uniform(-1.5, 0.5), chains


def damped(rng: Random) -> Any:
    J = _matrix(rng)
    return J, _error(rng, len(J)), 10.0 ** rng.uniform(-1, 1)


def safe_damping(rng: Random) -> Any:
    return _error(rng, int(rng.integers(1, 13))), 10.0 ** rng.uniform(-2, 1)


def unit(rng: Random) -> Any:
    return tuple(10.0 ** rng.uniform(-2, 2, 3))


def gamma(rng: Random) -> Any:
    return _matrix(rng, int(rng.choice([3, 6, 12]))), rng.uniform(0.05, 2)


def clamp(rng: Random) -> Any:
    phi = rng.normal(size=int(rng.integers(1, 15))) * 10.0 ** rng.uniform(-2, 1)
    return phi * rng.choice([0, 1, 1, 1]), 10.0 ** rng.uniform(-2, 1)


def pace(rng: Random) -> Any:
    A, omega = rng.normal(size=2) * 2
    return A, omega, A * rng.uniform(-1, 1)


def path(rng: Random) -> Any:
    return (rng.uniform(-2, 3, 50),)


def log(rng: Random) -> pd.DataFrame:
    """A log with the rows in any order, of methods of any name."""
    names = rng.permutation(["a", "b", "c", "d", "e"])[: rng.integers(2, 6)]
    rows = [
        {"frame": t, "method": m, "effector": e, "error": size * rng.exponential(), "jitter": shake}
        for m, size in zip(names, rng.uniform(0.8, 1.2, len(names)), strict=True)
        for t, shake in enumerate(rng.exponential(rng.uniform(0.5, 2), 12))
        for e in ("hand", "foot", "head")
    ]
    return pd.DataFrame(rows).sample(frac=1, random_state=int(rng.integers(1000)))


def order(rng: Random) -> Any:
    return log(rng), rng.uniform(0.5, 2)


def solver(rng: Random) -> Any:
    J = _matrix(rng)
    return J, _error(rng, len(J))


def null(rng: Random) -> Any:
    J = _matrix(rng, 3, int(rng.integers(3, 17)))
    J[2] *= rng.choice([0, 1])
    return J, rng.normal(size=J.shape[1])


def nod(rng: Random) -> Any:
    eyes, way = rng.uniform(0, 0.2), rng.uniform(-2.6, 2.6)  # not straight behind
    far = rng.uniform(0.25, 1.5)
    return far * np.sin(way), far * np.cos(way), eyes


def turn(rng: Random) -> Any:
    order = "".join(rng.permutation(list("XYZ"))[: rng.integers(1, 4)])
    return order, rng.uniform(-180, 180, len(order)).tolist()


def stands(rng: Random) -> Any:
    return rng.uniform(-4, 4, 50), float(rng.uniform(0.1, 0.95)), float(rng.uniform(-2, 2))


def score(rng: Random) -> Any:
    c, s = rng.integers(1, 5, 2)
    return rng.normal(0, 30, (c, s, 51)), rng.normal(0, 30, (c, 51))


def direction(rng: Random) -> Any:
    v, s = rng.normal(size=(2, 3))
    return v / np.linalg.norm(v), s, bool(rng.random() < 0.5)


def lock(rng: Random) -> Any:
    return "".join(rng.permutation(list("XYZ"))), float(rng.uniform(-4, 4))


def held(rng: Random) -> Any:
    C, R = (np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(2))
    return C, *rng.normal(size=(2, 3)), R, rng.normal(size=3)


DRAWS = {
    "00.hand": hand,
    "00.reach": reach,
    "01.column": column,
    "01.cramer": cramer,
    "02.classify": classify,
    "02.bend": volume,
    "03.alpha": downhill,
    "03.safe": safe,
    "03.gain": left,
    "04.projector": projector,
    "04.cap": cap,
    "05.svd": damped,
    "05.bound": safe_damping,
    "05.unit": unit,
    "06.gamma": gamma,
    "06.clamp": clamp,
    "07.pace": pace,
    "07.path": path,
    "08.order": order,
    "09.solver": solver,
    "10.null": null,
    "10.nod": nod,
    "11.turn": turn,
    "11.stands": stands,
    "11.score": score,
    "12.column": direction,
    "12.sigma": lock,
    "12.fixed": held,
}


def read(key: str, result: Any) -> Any:
    """The outcome of a call as it can be compared."""
    if key == "08.order":
        return [str(name) for name in result]
    if key == "08.experiment":
        targets, cap, winner = result
        return [targets, cap, *(str(winner(one)) for one in _logs())]
    return result


@cache
def _logs() -> list[pd.DataFrame]:
    return [log(np.random.default_rng(seed)) for seed in range(20)]


def _goes(answer: Any) -> bool:
    """The words of 07.path, on samples so dense that what is between them does not matter."""
    phase = np.arange(40_000) / 40_000
    y, z = np.asarray(answer(phase)).T
    there = np.asarray(answer(phase - 3))
    stands = y < 1e-6
    both = stands & np.roll(stands, -1)
    steps = (np.roll(z, -1) - z)[both]
    slip = abs(steps - np.median(steps)).sum() / abs(steps).sum()
    smooth = max(abs(np.diff(y)).max(), abs(np.diff(z)).max()) < 2e-3
    return bool(
        np.allclose(there, np.stack([y, z], -1), atol=1e-4)
        and y.min() > -1e-6
        and 0.03 <= y.max() <= 0.6
        and abs(z).max() <= 0.6
        and (stands | np.roll(stands, 20_000)).all()
        and smooth
        and steps.mean() < 0
        and slip < 0.05
        and 0.2 <= abs(steps).sum() <= 1.2
    )


def _races(answer: Any) -> bool:
    """The words of 08.experiment."""
    targets, cap, winner = answer()
    return bool(
        targets.shape[1:] == (4, 3)
        and len(targets) / 30 >= gait.running.period
        and np.ptp(targets) > 0
        and 0 < float(cap) <= np.pi
        and all(str(winner(one)) == nearest(one) for one in _logs())
    )


def nearest(table: pd.DataFrame) -> str:
    """The method with the least mean error."""
    return str(table.groupby("method")["error"].mean().sort_values().index[0])


def _mixes(answer: Any) -> bool:
    """The words of 09.mix, from other starts."""
    tree, effectors = figures.human()
    targets = gait.walking(gait.walking.clock(150))[:, None]
    poses = nearby(tree.rest, 24, seed=5)
    run = track(tree, effectors, targets, Mix.of(effectors, dict(answer)), theta=poses)
    feet = [name.startswith("foot") for name in effectors.names]
    shake = np.degrees(run.jitter[30:].mean(axis=0)).max()
    return bool(run.error[30:, :, feet].mean(axis=(0, 2)).max() < 0.0021 and shake < 3.1)


def _drives(answer: Any) -> bool:
    """The words of 09.solver: nearer on every J, and near on a body that its check does not ask."""
    rng = np.random.default_rng(77)
    for _ in range(40):
        J, e = solver(rng)
        lost = np.linalg.norm(J.T @ e) < 1e-6 * np.linalg.norm(J) * np.linalg.norm(e)
        if not (lost or e @ (J @ answer(J, e)) > 0):
            return False
    tree, effectors = figures.planar_arm(4)
    goal, begin = starts(tree, 3, spread=0.4)[1:]
    targets = np.tile(locate(forward(tree, goal), effectors), (80, 1, 1))
    run = track(tree, effectors, targets, answer, theta=begin, max_step=np.radians(5))
    J = jacobian(tree, forward(tree, begin), effectors)
    return bool(
        run.error[-1].max() < 0.5 * run.error[0].max() and not np.any(answer(J, np.zeros(3)))
    )


RIGHT = {
    "07.path": _goes,
    "08.experiment": _races,
    "09.mix": _mixes,
    "09.solver": _drives,
}
