"""Chapter 2: which errors a pose can mend, and where an arm moves best."""

from collections.abc import Iterator

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures, forward, jacobian
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import NAME, WrongError, agree
from ikteach.solvers import manipulability

WORDS = ("free", "near", "partly lost", "lost")
FAR = 10.0  # [rad/m]: what of ‖J⁺e‖ / ‖e‖ is near

Case = tuple[Array, Array, str]  # J, e, when


def arm(bend: float, lengths: tuple[float, float] = (1.0, 1.0)) -> Array:
    """J (2, 2) of a two-link arm along x whose elbow is bent by so many degrees."""
    tree, effectors = figures.planar_arm(list(lengths))
    return jacobian(tree, forward(tree, [0, np.radians(bend)]), effectors)[:2]


def arms() -> Iterator[Case]:
    """The arm, straight and bent, and errors inward, across and between."""
    inward, across = np.array([-0.1, 0.0]), np.array([0.0, 0.1])
    yield arm(90), inward, "the arm bent by 90°, the error inward"
    yield arm(0), inward, "the arm straight, the error straight inward"
    yield arm(0), across, "the arm straight, the error across it: both joints help"
    yield arm(0), inward + across, "the arm straight, the error half inward and half across"
    yield arm(0), inward + 1e-3 * across, "the arm straight, the error hardly across it"
    yield arm(0), 1e-3 * inward + across, "the arm straight, the error hardly inward"
    for bend in (0.01, 0.1, 1, 5):
        yield arm(bend), inward, f"the arm bent by {bend:g}°, the error inward"
        yield arm(bend), across, f"the arm bent by {bend:g}°, the error across it"
    flat = np.vstack([arm(40), np.zeros(2)])  # an arm in the plane, its hand in space
    yield flat, np.array([0.1, 0.1, 0.0]), "the arm bent by 40°, the error in its plane"
    yield flat, np.array([0.1, 0.1, 0.1]), "the arm bent by 40°, the error half out of its plane"
    yield flat, np.array([0.0, 0.0, 0.1]), "the arm bent by 40°, the error out of its plane"


def drawn() -> Iterator[Case]:
    """J at random with a longest turn that is known, and for tall ones a part that is lost."""
    rng = np.random.default_rng(2)
    for m, n in ((2, 2), (3, 3), (3, 7), (12, 20), (4, 3), (20, 12)):
        U, V = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (m, n))
        rank = min(m, n)
        for ratio in (0.9, 5.0, 9.8, 10.2, 40.0, 3000.0):
            sigma = rng.uniform(1.0, 2.0, rank)
            a, b = rng.permutation(rank)[:2]
            part = rng.uniform(0.6, 0.9)  # of e along u_b, whose σ makes the turn that long
            rest = np.sqrt(1 - part**2)
            sigma[a] = max(sigma[a], 2 / ratio)
            sigma[b] = part / np.sqrt(ratio**2 - (rest / sigma[a]) ** 2)
            J = (U[:, :rank] * sigma) @ V[:, :rank].T
            e = rest * U[:, a] + part * U[:, b]
            yield J, e, f"a J of {m} × {n} whose answer turns by {ratio:g} rad per metre"
            if m > n:
                lost = U[:, rank:] @ rng.normal(size=m - rank)
                lost /= np.linalg.norm(lost)
                yield J, lost, f"a J of {m} × {n}, and an error that no joint mends"
                for share in (1e-3, 0.5, 0.999):
                    mixed = np.sqrt(1 - share**2) * e + share * lost
                    yield J, mixed, f"a J of {m} × {n} that cannot mend {share:g} of the error"


def truth(J: Array, e: Array) -> str:
    """The class by the singular values: of e that no joint mends, and how far the rest turns."""
    U, sigma, _ = np.linalg.svd(J, full_matrices=False)
    moving = sigma > 1e-12 * sigma.max(initial=0)
    parts = U.T[moving] @ e
    size = np.linalg.norm(e)
    if np.linalg.norm(parts) < 1e-9 * size:
        return "lost"
    if np.linalg.norm(e - U[:, moving] @ parts) > 1e-9 * size:
        return "partly lost"
    return "near" if np.linalg.norm(parts / sigma[moving]) > FAR * size else "free"


@exercise(
    "02.classify",
    returns=NAME,
    hints=[
        "How much of e can be mended at all? And how far must the joints turn for that?",
        "`lost`: Jᵀe = 0. `partly lost`: JJ⁺e is not e. Then "
        "`near`: ‖J⁺e‖ > 10 ‖e‖. Compare lengths "
        "with ‖e‖, never with 0: numbers are rounded.",
        "`dtheta = np.linalg.pinv(J) @ e` and `np.linalg.norm(J @ "
        "dtheta - e) > 1e-9 * size`, where "
        "`size = np.linalg.norm(e)`.",
    ],
    seconds=30,
)
def classify(answer: Answer) -> None:
    """classify(J, e) -> "free", "near", "partly lost" or "lost"."""
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(2, 2)))[0]
    for J, e, when in (*arms(), *drawn()):
        right, size = truth(J, e), np.linalg.norm(e)
        seen = [("", J, e), (", a thousandth of it", J, 1e-3 * e), (", 10 times", J, 10 * e)]
        if len(J) == 2:
            seen.append((", seen from other axes", turn @ J, turn @ e))
        for how, J_, e_ in seen:
            found = answer(J_, e_).casefold()
            if found not in WORDS:
                said = f"'free', 'near', 'partly lost' or 'lost', not {found!r}"
                raise WrongError(f"`{answer.name}` must say {said}.")
            there = np.linalg.pinv(J) @ e
            expect(
                found == right,
                f"It is '{right}' and not '{found}' with {when}{how}: ‖Jᵀe‖ / ‖e‖ is "
                f"{np.linalg.norm(J.T @ e) / size:.2g}, ‖JJ⁺e − e‖ / ‖e‖ is "
                f"{np.linalg.norm(J @ there - e) / size:.2g}, ‖J⁺e‖ / ‖e‖ is "
                f"{np.linalg.norm(there) / size:.4g} rad/m.",
            )


@exercise(
    "02.bend",
    returns=(),
    hints=[
        "The ellipse is the picture of a circle of Δθ: by what does a 2 × 2 matrix scale areas?",
        "√det(JJᵀ) of a square J is |det J|. With the elbow bent by β, the columns of J are the "
        "arrows of the whole arm and of the forearm: |det J| = a b |sin β|.",
        "`return a * b * abs(np.sin(bend))`",
    ],
)
def bend(answer: Answer) -> None:
    """volume(a, b, bend): √det(JJᵀ) of two links [m] whose elbow is bent by so much [rad]."""
    rng = np.random.default_rng(5)
    bends = [0.0, np.pi / 2, np.pi, -np.pi / 2, *rng.uniform(-2 * np.pi, 2 * np.pi, 16)]
    for angle in bends:
        a, b = rng.uniform(0.2, 2, 2).round(2)
        agree(
            answer(float(a), float(b), float(angle)),
            manipulability(arm(np.degrees(angle), (a, b))),
            f"With links of {a:g} m and {b:g} m, bent by {np.degrees(angle):.4g}°, √det(JJᵀ) is "
            "{wanted} m², not {found}.",
            size=a * b,
        )
