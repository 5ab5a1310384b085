"""Right answers in unusual forms and by unusual ways, which must pass: `RIGHT`, (key, answer)."""

import itertools
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd

from ikteach import SOLVERS, dls, gait, pseudoinverse, sdls, transpose
from ikteach.solvers.sdls import lengths


def hand_complex(theta, lengths):
    tip, way = 0j, 1
    for turn, length in zip(theta, lengths, strict=True):
        way = way * complex(np.cos(turn), np.sin(turn))
        tip += length * way
    return tip.real, tip.imag


def hand_matrices(theta, lengths):
    T = np.eye(3)
    for turn, length in zip(theta, lengths, strict=True):
        c, s = np.cos(turn), np.sin(turn)
        T = T @ [[c, -s, length * c], [s, c, length * s], [0, 0, 1]]
    return T[:2, 2:]  # a column


def hand_yields(theta, lengths):
    for way in (np.cos, np.sin):
        yield sum(a * way(t) for a, t in zip(lengths, itertools.accumulate(theta), strict=True))


def reach_cosine(x, y, a, b):
    return abs((x * x + y * y - a * a - b * b) / (2 * a * b)) <= 1


def reach_squares(x, y, a, b):
    return np.array([(a - b) ** 2 <= x**2 + y**2]) & (x**2 + y**2 <= (a + b) ** 2)


def reach_lenient(x, y, a, b):
    return int(abs(a - b) - 1e-9 <= np.linalg.norm([x, y]) <= a + b + 1e-9)


def column_coarse(v, p, s, h=0.05):
    def at(angle):
        r = s - p
        return (
            p
            + np.cos(angle) * r
            + np.sin(angle) * np.cross(v, r)
            + (1 - np.cos(angle)) * np.dot(v, r) * v
        )

    return (at(h) - at(-h)) / (2 * h)


def column_skew(v, p, s):
    x, y, z = v
    return (np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ (s - p)[:, None]).astype(np.float32)


def cramer_solve(J, r):
    if np.linalg.matrix_rank(J) < 3:
        raise ValueError("singular")
    return np.linalg.solve(J, r)


def cramer_cond(J, r):
    assert J.shape == (3, 3)
    if not np.linalg.norm(J) or np.linalg.cond(J) > 1e13:
        raise ValueError
    return (np.linalg.inv(J) @ r).tolist()


def cramer_triple(J, r):
    a, b, c = J.T
    volume = a @ np.cross(b, c)
    if abs(volume) <= 1e-11 * np.sqrt((a @ a) * (b @ b) * (c @ c)):
        raise ValueError("flat")
    return (np.array([r @ np.cross(b, c), a @ np.cross(r, c), a @ np.cross(b, r)]) / volume)[
        :, None
    ]


def classify_svd(J, e):
    U, s, _ = np.linalg.svd(J)
    rank = (s > 1e-10 * s[0]).sum()
    inside = U[:, :rank].T @ e
    if np.allclose(inside, 0, atol=1e-8 * np.linalg.norm(e)):
        return "Lost"
    if np.linalg.norm(U[:, rank:].T @ e) > 1e-8 * np.linalg.norm(e):
        return "Partly lost"
    far = np.linalg.norm(inside / s[:rank]) / np.linalg.norm(e)
    return np.array("near" if far > 10 else "free")


def classify_lstsq(J, e):
    e = e / np.linalg.norm(e)
    x = np.linalg.lstsq(J, e)[0]
    left = np.linalg.norm(e - J @ x)
    if left > 1 - 1e-9:
        return "lost"
    return "partly lost" if left > 1e-7 else ("free", "near")[int(np.linalg.norm(x) > 10)]


def classify_allclose(J, e):
    """With numpy's own tolerances."""
    x = np.linalg.pinv(J) @ e
    if np.linalg.norm(J.T @ e) < 1e-9 * np.linalg.norm(J) * np.linalg.norm(e):
        return "lost"
    if not np.allclose(J @ x, e):
        return "partly lost"
    return "near" if np.linalg.norm(x) > 10 * np.linalg.norm(e) else "free"


def volume_by_j(a, b, bend):
    J = np.array([[-b * np.sin(bend), -b * np.sin(bend)], [a + b * np.cos(bend), b * np.cos(bend)]])
    return np.sqrt(np.linalg.det(J @ J.T).clip(0))


def alpha_search(J, e):
    """Halves an interval in which the slope changes its sign."""
    g = J @ J.T @ e
    low, high = 0.0, 2 * (e @ e) / (J.T @ e @ J.T @ e) * 1e3
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if (e - middle * g) @ g > 0 else (low, middle)
    return [low]


def safe_where(J, e):
    way = J.T @ e
    g = J @ way
    with np.errstate(all="ignore"):
        return np.nan_to_num((way @ way) / (g @ g)) * way


def safe_tiny(J, e):
    g = J @ (J.T @ e)
    return (e @ g) / max(g @ g, np.finfo(float).tiny) * (J.T @ e)


def projector_svd(J):
    _, s, Vt = np.linalg.svd(J)
    null = Vt[(s > 1e-9 * s.max(initial=0)).sum() :]
    return (null.T @ null).astype(np.float32)


def cap_dict(dtheta, max_step, chains):
    peaks = {}
    for turn, chain in zip(dtheta, chains, strict=True):
        peaks[chain] = max(peaks.get(chain, 0), abs(turn))
    pairs = zip(dtheta, chains, strict=True)
    return (turn * min(1, max_step / peaks[chain]) if turn else 0.0 for turn, chain in pairs)


def cap_in_place(dtheta, max_step, chains):
    done = np.array(dtheta)
    for chain in set(chains):
        ours = np.flatnonzero(chains == chain)
        done[ours] /= max(1, np.linalg.norm(done[ours], np.inf) / max_step)
    return done.astype(np.float32)


def capped(turns, most):
    return turns * min(1, most / max(turns.abs().max(), 1e-300))


def damped_stacked(J, e, damping):
    """As an ordinary least squares problem."""
    n = J.shape[1]
    A, b = np.vstack([J, damping * np.eye(n)]), np.concatenate([e, np.zeros(n)])
    return np.linalg.lstsq(A, b)[0]


def damped_normal(J, e, damping):
    return np.linalg.inv(J.T @ J + damping**2 * np.eye(J.shape[1])) @ J.T @ e[:, None]


def gamma_loops(J, max_angle):
    U, s, Vt = np.linalg.svd(J, full_matrices=False)
    made = []
    for i, sigma in enumerate(s):
        N = sum(np.linalg.norm(part) for part in U[:, i].reshape(-1, 3))
        M = sum(
            abs(Vt[i, j]) / sigma * sum(np.linalg.norm(part) for part in J[:, j].reshape(-1, 3))
            for j in range(J.shape[1])
        )
        made.append(max_angle if N > M else N / M * max_angle)
    return pd.Series(made)


def gamma_arrays(J, max_angle):
    U, s, Vt = np.linalg.svd(J)
    k = len(s)
    M = (abs(Vt[:k]) * lengths(J).sum(axis=0)).sum(axis=1) / s
    return np.clip(lengths(U[:, :k]).sum(axis=0) / M, 0, 1) * max_angle


def gamma_without_min(J, max_angle):
    """N is never above M: a whole is no longer than the sum of its parts."""
    U, s, Vt = np.linalg.svd(J, full_matrices=False)
    return lengths(U).sum(axis=0) / (abs(Vt) @ lengths(J).sum(axis=0) / s) * max_angle


def clamp_loop(phi, bound):
    peak = max(map(abs, phi))
    return [x * bound / peak if peak > bound else x for x in phi]


def pace_by_angle(A, omega, z):
    return [abs(A * omega * np.cos(np.arcsin(z / A)))]


def pace_by_differences(A, omega, z, h=1e-6):
    T = np.arcsin(z / A) / omega
    return abs(A * np.sin(omega * (T + h)) - A * np.sin(omega * (T - h))) / (2 * h)


def path_smooth(phase, lift=0.06, stance=0.6, start=0.25):
    """A lift that begins so gently that its first millimetre is hardly one."""
    p = np.mod(phase, 1)
    s = np.clip((p - stance) / (1 - stance), 0, 1)
    z = np.where(p < stance, start - 2 * start * p / stance, start * (6 * s**2 - 4 * s**3 - 1))
    return np.stack([lift * 64 * s**3 * (1 - s) ** 3, z], axis=-1)


def path_table(phase):
    """Corners, joined by straight lines; the swing first."""
    at = [0, 0.1, 0.2, 0.4, 1]
    p = np.mod(phase, 1)
    return np.c_[
        np.interp(p, at, [0, 0.08, 0.08, 0, 0]), np.interp(p, at, [-0.3, 0, 0.3, 0.3, -0.3])
    ]


def path_matched(phase):
    """Leaves the ground and comes down with the speed of the ground: a cubic of Hermite."""
    p, A = np.mod(np.asarray(phase, np.float32), 1), 0.2
    s = np.clip((p - 0.55) / 0.45, 0, 1)
    slope = -2 * A / 0.55 * 0.45
    z = -A + 2 * A * (3 * s**2 - 2 * s**3) + slope * (s - 3 * s**2 + 2 * s**3)
    return np.array([0.1 * np.sin(np.pi * s) ** 4, np.where(p < 0.55, A - 2 * A * p / 0.55, z)]).T


def order_sorted(table, most):
    ours = dict(iter(table.groupby("method", observed=True)))
    calm = [name for name, part in ours.items() if np.mean(part["jitter"]) <= most]
    return tuple(sorted(calm, key=lambda name: ours[name].error.mean()))


def order_numpy(table, most):
    names = np.unique(np.asarray(table["method"], str))
    errors, shakes = (
        np.array([table.loc[table["method"] == name, what].mean() for name in names])
        for what in ("error", "jitter")
    )
    return names[errors.argsort()][shakes[errors.argsort()] <= most]


def experiment_list():
    def best(log):
        means = {m: np.mean(log["error"][log["method"] == m]) for m in log["method"].unique()}
        return min(means, key=means.get)

    return [gait.walking(np.arange(50) / 30).tolist(), Fraction(1, 10), best]


def experiment_yields():
    yield gait.running.at(np.linspace(0, 7, 40))
    yield np.array([0.2], np.float32)
    yield lambda log: log.pivot_table("error", "method", observed=True)["error"].idxmin()


def experiment_function():
    """Names the winner by the function of that name."""
    return (
        gait.running(np.arange(30) / 30),
        np.float32(0.3),
        lambda log: np.array([log.groupby("method", observed=True).error.mean().idxmin()]),
    )


def solver_transpose(J, e):
    g = J @ (J.T @ e)
    return 0.7 * (e @ g) / (g @ g) * (J.T @ e) if g.any() else np.zeros(J.shape[1])


def solver_lm(J, e):
    A = np.vstack([J, 0.05 * np.eye(J.shape[1])])
    return np.linalg.lstsq(A, np.r_[e, np.zeros(J.shape[1])])[0].tolist()


def null_lstsq(J, wish):
    return wish - np.linalg.lstsq(J, J @ wish)[0]


def null_basis(J, wish):
    _, s, Vt = np.linalg.svd(J)
    free = Vt[(s > 1e-9 * s[0]).sum() :]
    return (free.T @ (free @ wish)).tolist()


def nod_search(y, z, eyes):
    """Takes the line of sight to the cursor by halving, and by no formula."""

    def over(angle):
        return y * np.cos(angle) + z * np.sin(angle) - eyes

    if z <= 0:
        return np.radians(-30 if y > 0 else 60)
    low, high = np.radians([-30.0, 60.0])
    for _ in range(60):
        low, high = (
            ((low + high) / 2, high) if over((low + high) / 2) < 0 else (low, (low + high) / 2)
        )
    return np.float32(low)


def nod_degrees(y, z, eyes):
    far = np.sqrt(y**2 + z**2)
    return [np.deg2rad(min(60, max(-30, np.rad2deg(np.arctan2(-y, z) + np.arcsin(eyes / far)))))]


HANDS = {"hand.r": transpose, "hand.l": transpose}

RIGHT = [
    ("00.hand", hand_complex),
    ("00.hand", hand_matrices),
    ("00.hand", hand_yields),
    ("00.hand", lambda t, a: np.float32([a @ np.cos(t.cumsum()), a @ np.sin(t.cumsum())])),
    ("00.reach", reach_cosine),
    ("00.reach", reach_squares),
    ("00.reach", reach_lenient),
    (
        "00.reach",
        lambda x, y, a, b: np.bool_(
            max(x * x + y * y, 0) ** 0.5 <= a + b and (x * x + y * y) ** 0.5 >= max(a - b, b - a)
        ),
    ),
    ("01.column", column_coarse),
    ("01.column", column_skew),
    ("01.column", lambda v, p, s: np.cross(p - s, v)),
    ("01.cramer", cramer_solve),
    ("01.cramer", cramer_cond),
    ("01.cramer", cramer_triple),
    ("02.classify", classify_svd),
    ("02.classify", classify_lstsq),
    ("02.bend", volume_by_j),
    ("02.bend", lambda a, b, bend: [np.hypot(0, a * b * np.sin(bend))]),
    ("02.bend", lambda a, b, bend: a * b * np.sqrt(1 - np.cos(bend) ** 2)),
    ("03.alpha", alpha_search),
    ("03.alpha", lambda J, e: np.linalg.lstsq((J @ J.T @ e)[:, None], e)[0]),
    ("03.alpha", lambda J, e: np.float32(np.sum((J.T @ e) ** 2) / np.sum((J @ J.T @ e) ** 2))),
    ("03.safe", safe_where),
    ("03.safe", safe_tiny),
    ("03.safe", transpose),
    ("03.gain", lambda gain, best: best + (1 - best) * (1 - gain) ** 2),
    ("03.gain", lambda gain, best: np.polyval([1 - best, 2 * (best - 1), 1], [gain])),
    ("04.projector", projector_svd),
    ("04.projector", lambda J: np.eye(J.shape[1]) - J.T @ np.linalg.pinv(J.T)),
    ("04.projector", lambda J: np.eye(J.shape[1]) - np.linalg.lstsq(J, J)[0]),
    ("04.projector", lambda J: (np.eye(len(J.T)) - np.linalg.pinv(J, rcond=1e-6) @ J).tolist()),
    ("04.cap", cap_dict),
    ("04.cap", cap_in_place),
    ("05.svd", damped_stacked),
    ("05.svd", damped_normal),
    ("05.svd", lambda J, e, damping: dls(J, e, damping=damping).astype(np.float32)),
    ("05.bound", lambda e, longest: np.sqrt(e @ e) / longest / 2),
    ("05.bound", lambda e, longest: [np.float32(np.linalg.norm(e)) / np.float32(2 * longest)]),
    ("05.unit", lambda damping, per_metre, per_radian: Decimal(damping * per_metre / per_radian)),
    ("05.unit", lambda d, m, r: np.array([[d * (m / r)]])),
    ("06.gamma", gamma_without_min),
    ("06.gamma", gamma_loops),
    ("06.gamma", gamma_arrays),
    ("06.clamp", clamp_loop),
    ("06.clamp", lambda phi, bound: phi / max(1, abs(phi).max() / max(bound, 1e-300))),
    ("07.pace", pace_by_angle),
    ("07.pace", pace_by_differences),
    ("07.pace", lambda A, omega, z: np.sqrt(omega**2 * (A - z) * (A + z)).astype(np.float32)),
    ("07.path", path_smooth),
    ("07.path", path_table),
    ("07.path", path_matched),
    ("07.path", lambda phase: path_smooth(phase, lift=0.03, stance=0.5, start=0.1)),
    ("07.path", lambda phase: path_smooth(phase + 0.3, lift=0.3, stance=0.9, start=0.5).tolist()),
    ("08.order", order_sorted),
    ("08.order", order_numpy),
    ("08.order", lambda table, most: iter(order_sorted(table, most))),
    ("08.experiment", experiment_list),
    ("08.experiment", experiment_yields),
    ("08.experiment", experiment_function),
    ("09.mix", {"foot.l": sdls, "foot.r": sdls, **HANDS}),
    ("09.mix", {"foot.l": "SDLS", "foot.r": " sdls", **HANDS}),
    ("09.mix", [("foot.l", "sdls"), ("foot.r", "sdls"), *HANDS.items()]),
    (
        "09.mix",
        pd.Series(
            {"foot.l": "sdls", "foot.r": "sdls", "hand.r": "transpose", "hand.l": "transpose"}
        ),
    ),
    ("09.solver", solver_transpose),
    ("09.solver", solver_lm),
    *(("09.solver", SOLVERS[name]) for name in SOLVERS),
    ("09.solver", lambda J, e: np.linalg.pinv(J, rcond=0.05) @ e),
    ("09.solver", lambda J, e: np.float32(pseudoinverse(J, e))[:, None]),
    ("10.null", null_lstsq),
    ("10.null", null_basis),
    ("10.null", lambda J, w: np.float32(np.eye(len(w)) - np.linalg.pinv(J) @ J) @ np.float32(w)),
    ("10.nod", nod_search),
    ("10.nod", nod_degrees),
    (
        "00.hand",
        lambda t, a: np.cumsum(a * np.exp(1j * np.cumsum(t))).view(float).reshape(-1, 2)[-1],
    ),
    (
        "00.reach",
        lambda x, y, a, b: 2 * max(np.hypot(x, y), a, b) <= np.hypot(x, y) + a + b + 1e-12,
    ),
    ("02.classify", classify_allclose),
    ("03.safe", lambda J, e: np.linalg.pinv((J @ J.T @ e)[:, None]) @ e * (J.T @ e)),
    ("04.cap", lambda d, m, c: pd.Series(d).groupby(c).transform(capped, m)),
    ("08.order", lambda table, most: dict.fromkeys(order_sorted(table, most)).keys()),
    ("09.solver", lambda J, e: np.linalg.lstsq(J, e, rcond=0.05)[0]),
]
