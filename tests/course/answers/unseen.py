"""Wrong answers of many kinds, found by looking for what checks with fixed cases let through.

`UNSEEN`: (key, answer). Each must be refused; what is said of it is not told here, but it must hold
numbers, or name what is wrong.
"""

import itertools

import numpy as np

from ikteach import dls, gait, pseudoinverse, transpose
from ikteach.course.solutions import ch00, ch01, ch02, ch03, ch04, ch06, ch07, ch10
from ikteach.solvers.sdls import lengths


def reach_within(slack):
    return lambda x, y, a, b: abs(a - b) - slack <= np.hypot(x, y) <= a + b + slack


def cramer_if(singular, solved=None):
    def cramer3(J, r):
        if singular(J):
            raise ValueError("no inverse")
        return (solved or np.linalg.solve)(J, r)

    return cramer3


def classify_by(near=10.0, none=1e-9, part=1e-9, order="lpn"):
    def classify(J, e):
        size, x = np.linalg.norm(e), np.linalg.pinv(J) @ e
        found = {
            "l": ("lost", np.linalg.norm(J.T @ e) < none * size),
            "p": ("partly lost", np.linalg.norm(J @ x - e) > part * size),
            "n": ("near", np.linalg.norm(x) > near * size),
        }
        return next((found[one][0] for one in order if found[one][1]), "free")

    return classify


def classify_by_pose(J, e):
    sigma = np.linalg.svdvals(J)
    if sigma[-1] > 0.1:
        return "free"
    return "near" if sigma[-1] > 1e-9 else ch02.classify(J, e)


def safe_by_rank(J, e):
    lost = np.linalg.matrix_rank(J) < min(J.shape)
    return np.zeros(J.shape[1]) if lost else ch03.careful(J, e)


def safe_below(least):
    def careful(J, e):
        g = J @ (J.T @ e)
        return transpose(J, e) if np.linalg.norm(g) > least else np.zeros(J.shape[1])

    return careful


def cap_runs(dtheta, max_step, chains):
    done = []
    for _, run in itertools.groupby(zip(chains, dtheta, strict=True), key=lambda pair: pair[0]):
        part = np.array([turn for _, turn in run])
        done += list(part * min(1, max_step / max(abs(part).max(), 1e-300)))
    return np.array(done)


def cap_some(which):
    def cap(dtheta, max_step, chains):
        done = dtheta.copy()
        for chain in which(chains):
            ours = chains == chain
            if ours.any():
                done[ours] *= min(1, max_step / max(abs(dtheta[ours]).max(), 1e-300))
        return done

    return cap


def damped_by(factor):
    def damped(J, e, damping):
        U, s, Vt = np.linalg.svd(J, full_matrices=False)
        return Vt.T @ (factor(s, damping) * (U.T @ e))

    return damped


def gamma_by(n=None, rho=None, combine=None):
    def gamma(J, max_angle):
        U, s, Vt = np.linalg.svd(J, full_matrices=False)
        N = (n or (lambda U: lengths(U).sum(axis=0)))(U)
        M = abs(Vt) @ (rho or (lambda J: lengths(J).sum(axis=0)))(J) / s
        return (combine or (lambda N, M: np.minimum(1, N / M)))(N, M) * max_angle

    return gamma


def clamp_by(peak):
    return lambda phi, bound: phi * min(1, bound / max(peak(phi), 1e-300))


def moved(change):
    """The path of the solution, changed in z or in height."""

    def path(phase):
        y, z = ch07.path(phase).T
        return np.stack(change(np.mod(phase, 1), y, z), axis=-1)

    return path


def path_by_place(phase):
    """Asks how many phases there are, and not which."""
    return ch07.path(np.arange(len(phase)) / 400)


def path_slow(phase):
    return ch07.path(np.asarray(phase) / 2)


def mean_error(log):
    return log.groupby("method", observed=True)["error"].mean()


def path_two_cycles(phase):
    """Comes round once either way, and not for ever."""
    phase = np.where(phase >= 1, phase - 1, np.where(phase < 0, phase + 1, phase))
    return np.where(((phase >= 0) & (phase < 1))[:, None], ch07.path(phase), 0)


def cramer_unless(refused):
    """Solves, and looks at the outcome."""

    def cramer3(J, r):
        x = np.linalg.solve(J, r)
        if refused(J, x):
            raise ValueError("no inverse")
        return x

    return cramer3


def order_by(error, jitter):
    """Another measure than the mean, of one of the two."""

    def order(table, most):
        groups = table.groupby("method", observed=True)
        calm = jitter(groups["jitter"]) <= most
        return error(groups["error"])[calm].sort_values().index

    return order


WALK = gait.walking(gait.walking.clock(40))
SDLS = {"foot.l": "sdls", "foot.r": "sdls"}

UNSEEN = [
    ("00.hand", lambda t, a: ch00.hand(t, a) * [1, -1]),
    ("00.hand", lambda t, a: ch00.hand(np.mod(t, np.pi), a)),
    ("00.hand", lambda t, a: ch00.hand(t, np.array([1.0, 0.7, 0.4]))),
    ("00.hand", lambda t, a: ch00.hand(np.array([t[0], t[1], t[1]]), a)),
    ("00.hand", lambda t, a: ch00.hand(t, np.sort(a)[::-1])),
    ("00.reach", reach_within(0.05)),
    ("00.reach", reach_within(1e-3)),
    ("00.reach", reach_within(-1e-6)),
    ("00.reach", lambda x, y, a, b: abs(a - b) <= abs(x) + abs(y) <= a + b),
    ("00.reach", lambda x, y, a, b: x >= 0 and ch00.can_reach(x, y, a, b)),
    ("00.reach", lambda x, y, a, b: a == b or ch00.can_reach(x, y, a, b)),
    (
        "00.reach",
        lambda x, y, a, b: np.hypot(x, y) <= a + b and (a >= b or np.hypot(x, y) >= b - a),
    ),
    ("01.column", lambda v, p, s: np.cross(v, s - p) * (1 + 0.01)),
    ("01.column", lambda v, p, s: np.cross(v, s - p) + 0.01 * v),
    ("01.column", lambda v, p, s: abs(np.cross(v, s - p))),
    ("01.column", lambda v, p, s: np.cross(v, s) - p),
    ("01.cramer", np.linalg.solve),
    ("01.cramer", cramer_if(lambda J: abs(np.linalg.det(J)) <= 0.01)),
    ("01.cramer", cramer_if(lambda J: abs(np.linalg.det(J)) < 1e-12)),
    ("01.cramer", cramer_if(lambda J: np.linalg.det(J) == 0)),
    ("01.cramer", cramer_if(lambda J: np.linalg.det(J) < 1e-25)),
    ("01.cramer", cramer_if(lambda J: np.linalg.cond(J) > 100)),
    ("01.cramer", cramer_if(lambda J: np.linalg.matrix_rank(J, tol=1e-3) < 3)),
    ("01.cramer", cramer_if(lambda J: not J.all())),
    (
        "01.cramer",
        cramer_if(lambda J: np.linalg.matrix_rank(J) < 3, lambda J, r: r @ np.linalg.inv(J)),
    ),
    ("02.classify", classify_by(near=2)),
    ("02.classify", classify_by(near=100)),
    ("02.classify", classify_by(near=10.5)),
    ("02.classify", classify_by(near=9.5)),
    ("02.classify", classify_by(none=0.01)),
    ("02.classify", classify_by(none=1e-3)),
    ("02.classify", classify_by(part=0.1)),
    ("02.classify", classify_by(part=2e-3)),
    ("02.classify", classify_by(order="lnp")),
    ("02.classify", classify_by(order="pln")),
    ("02.classify", classify_by(order="ln")),
    ("02.classify", classify_by_pose),
    ("02.bend", lambda a, b, bend: a * b * abs(np.sin(bend)) ** 2),
    ("02.bend", lambda a, b, bend: a * b * bend),
    ("02.bend", lambda a, b, bend: a * b * np.sin(min(abs(bend), np.pi / 2))),
    ("02.bend", lambda a, b, bend: (a + b) / 2 * abs(np.sin(bend))),
    ("03.alpha", lambda J, e: (e @ J @ J.T @ e) / np.linalg.norm(J @ J.T @ e)),
    ("03.alpha", lambda J, e: 1 / np.linalg.norm(J, 2) ** 2),
    ("03.alpha", lambda J, e: ch03.alpha(J, e) * 0.99),
    ("03.safe", safe_by_rank),
    ("03.safe", safe_below(1e-9)),
    ("03.safe", safe_below(1e-14)),
    ("03.safe", lambda J, e: ch03.careful(J, e) if abs(e).max() > 1e-5 else 0 * J[0]),
    ("03.safe", lambda J, e: np.nan_to_num(J.T @ e / np.linalg.norm(J.T @ e))),
    ("03.gain", lambda gain, best: abs(1 - (1 - best) * gain)),
    ("03.gain", lambda gain, best: ch03.left(min(gain, 2), best)),
    ("03.gain", lambda gain, best: ch03.left(gain, 0.5)),
    ("04.projector", lambda J: np.eye(J.shape[1]) - np.linalg.pinv(J, rcond=0.1) @ J),
    ("04.projector", lambda J: np.eye(J.shape[1]) * (J.shape[1] > np.linalg.matrix_rank(J))),
    ("04.projector", lambda J: np.eye(J.shape[1]) - np.linalg.lstsq(J + 1e-6, J)[0]),
    ("04.cap", cap_runs),
    ("04.cap", cap_some(lambda chains: range(max(chains) + 1))),
    ("04.cap", cap_some(lambda chains: range(len(set(chains))))),
    ("04.cap", cap_some(lambda chains: np.unique(chains)[:3])),
    ("04.cap", lambda d, m, c: np.where(abs(d) > m, ch04.cap(d, m, c), d)),
    ("04.cap", lambda d, m, c: np.sign(d) * ch04.cap(abs(d), m, np.zeros(len(c)))),
    ("05.svd", damped_by(lambda s, d: s / (s**2 + d**2) * (s > 0.1))),
    ("05.svd", damped_by(lambda s, d: 1 / np.maximum(s, d))),
    ("05.svd", damped_by(lambda s, d: s / (s + d) ** 2)),
    ("05.svd", lambda J, e, damping: pseudoinverse(J, e)),
    ("05.bound", lambda e, longest: np.linalg.norm(e, 1) / (2 * longest)),
    ("05.bound", lambda e, longest: np.linalg.norm(e) / (2 * min(longest, 1))),
    ("05.bound", lambda e, longest: np.linalg.norm(e) ** 2 / (2 * longest)),
    ("05.bound", lambda e, longest: 1.01 * np.linalg.norm(e) / (2 * longest)),
    ("05.unit", lambda d, m, r: d * m / np.sqrt(r)),
    ("05.unit", lambda d, m, r: d * m if r == 1 else d * m / 57.3),
    ("05.unit", lambda d, m, r: d * m * (180 / np.pi)),
    ("06.gamma", gamma_by(n=lambda U: np.linalg.norm(U, axis=0))),
    ("06.gamma", gamma_by(rho=lambda J: np.linalg.norm(J, axis=0))),
    ("06.gamma", gamma_by(combine=lambda N, M: np.minimum(1, N / M.max()))),
    ("06.gamma", lambda J, a: ch06.gamma(J, a) * (1 - 0.05)),
    ("06.clamp", clamp_by(lambda phi: -phi.min())),
    ("06.clamp", clamp_by(lambda phi: abs(phi[-1]))),
    ("06.clamp", clamp_by(lambda phi: abs(phi[0]))),
    ("06.clamp", clamp_by(np.ptp)),
    ("06.clamp", clamp_by(lambda phi: abs(phi).sum())),
    ("06.clamp", lambda phi, bound: abs(ch06.clamp(phi, bound))),
    ("06.clamp", lambda phi, bound: ch06.clamp(phi, bound) if phi.size > 1 else phi),
    ("07.pace", lambda A, omega, z: abs(A) * omega),
    ("07.pace", lambda A, omega, z: omega * np.sqrt(A**2 - z**2)),
    ("07.pace", lambda A, omega, z: abs(A * omega) * (1 - abs(z / A))),
    ("07.pace", lambda A, omega, z: abs(A * omega * np.cos(omega * z))),
    ("07.path", moved(lambda p, y, z: (y, z + 100))),
    ("07.path", moved(lambda p, y, z: (y, z + 0.04 * (p > 0.8)))),
    ("07.path", moved(lambda p, y, z: (y, z + 0.003 * (p > 0.8)))),
    ("07.path", moved(lambda p, y, z: (y + 0.04 * ((p > 0.7) & (p < 0.9)), z))),
    ("07.path", moved(lambda p, y, z: (y, 2.6 * z))),
    ("07.path", moved(lambda p, y, z: (y, 0.3 * z))),
    ("07.path", moved(lambda p, y, z: (20 * y, z))),
    ("07.path", moved(lambda p, y, z: (0.48 * y, z))),
    ("07.path", moved(lambda p, y, z: (y + 0.001, z))),
    ("07.path", moved(lambda p, y, z: (y - 0.001 * np.sin(20 * p) ** 2, z))),
    ("07.path", moved(lambda p, y, z: (y, z + 0.02 * np.sin(np.pi * p / 0.3) * (p < 0.6)))),
    ("07.path", moved(lambda p, y, z: (y, np.zeros_like(z)))),
    ("07.path", path_by_place),
    ("07.path", path_slow),
    ("08.order", lambda table, most: list(mean_error(table[table["jitter"] <= most]).index)),
    ("08.order", lambda table, most: mean_error(table).sort_values().index),
    ("08.order", lambda table, most: mean_error(table[table["effector"] == "hand"]).index),
    ("08.experiment", lambda: (WALK, 0.1, lambda log: mean_error(log[log["frame"] > 0]).idxmin())),
    ("08.experiment", lambda: (WALK, 0.1, lambda log: mean_error(log).index[0])),
    ("08.experiment", lambda: (WALK, -0.1, lambda log: mean_error(log).idxmin())),
    ("08.experiment", lambda: (WALK, None, lambda log: mean_error(log).idxmin())),
    ("08.experiment", lambda: (WALK * np.nan, 0.1, lambda log: mean_error(log).idxmin())),
    ("08.experiment", lambda: {"targets": WALK, "cap": 0.1, "winner": mean_error}),
    ("09.mix", {**SDLS, "hand.r": "dls", "hand.l": ["transpose", "dls"]}),
    ("09.mix", {**SDLS, "hand.r": None, "hand.l": "dls"}),
    ("09.mix", ["sdls", "sdls", "dls", "dls"]),
    ("09.mix", {**SDLS, "hand.r": "pseudoinverse", "hand.l": "pseudoinverse"}),
    ("09.solver", lambda J, e: np.full(J.shape[1], 0.01)),
    ("09.solver", lambda J, e: np.sign(J.T @ e) * 1e-5),
    ("09.solver", lambda J, e: dls(J[:3], e[:3])),
    ("09.solver", lambda J, e: e.__imul__(0) if e.any() else 0 * J[0]),
    ("10.null", lambda J, wish: wish - J.T @ J @ wish),
    ("10.null", lambda J, wish: wish - np.linalg.pinv(J, rcond=0.5) @ J @ wish),
    ("10.null", lambda J, wish: 0.99 * ch10.to_rest(J, wish)),
    ("10.null", lambda J, wish: wish - J.T @ np.linalg.solve(J @ J.T, J @ wish)),
    (
        "10.nod",
        lambda y, z, eyes: np.clip(
            np.arcsin(eyes / np.hypot(y, z)) - np.arctan(y / z), *np.radians([-30, 60])
        ),
    ),
    (
        "10.nod",
        lambda y, z, eyes: np.clip(np.arctan(eyes / z) - np.arctan2(y, z), *np.radians([-30, 60])),
    ),
    ("10.nod", lambda y, z, eyes: np.clip(-np.arctan2(y - eyes, z), *np.radians([-30, 60]))),
    ("10.nod", lambda y, z, eyes: np.clip(ch10.nod(y, z, eyes), -0.5, 1)),
    ("10.nod", lambda y, z, eyes: np.clip(ch10.nod(y, z, 0.15), *np.radians([-30, 60]))),
    ("01.column", lambda v, p, s: ch01.column(v, s, p)),
    ("00.hand", lambda t, a: ch00.hand(np.clip(t, -np.pi, np.pi), a)),
    ("00.hand", lambda t, a: ch00.hand(t, np.minimum(a, 1.5))),
    ("00.reach", reach_within(1e-5)),
    ("01.cramer", cramer_unless(lambda J, x: abs(x).max() > 1e10)),
    ("01.cramer", cramer_unless(lambda J, x: np.linalg.cond(J) > 1e7)),
    ("01.cramer", cramer_unless(lambda J, x: np.isclose(np.linalg.det(J), 0, atol=1e-20))),
    ("02.bend", lambda a, b, bend: a * b * np.sin(abs(bend))),
    ("02.bend", lambda a, b, bend: a * b * np.sin(bend) * (1 if bend > 0 else -1)),
    ("04.projector", lambda J: np.eye(J.shape[1]) - np.linalg.pinv(J, rcond=1e-3) @ J),
    ("05.unit", lambda d, m, r: d * m / r if r > 1 else d * m),
    (
        "06.clamp",
        lambda phi, bound: ch06.clamp(phi, bound) if abs(phi).max() > 1.05 * bound else phi,
    ),
    ("07.path", path_two_cycles),
    ("08.order", order_by(lambda g: g.sum(), lambda g: g.mean())),
    ("08.order", order_by(lambda g: g.mean(), lambda g: g.sum() / g.size().iloc[0])),
    (
        "08.experiment",
        lambda: (WALK, 0.1, lambda log: log.groupby("method")["error"].sum().idxmin()),
    ),
]
