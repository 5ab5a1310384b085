"""Chapter 6. SDLS: the bound of each direction, and a clamp that keeps the way."""

from collections.abc import Iterator

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures, forward, jacobian
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree, numbers_apart
from ikteach.solvers.response import directions


def jacobians() -> list[Array]:
    """Some J, of the human near rest and at random, none with singular values that repeat."""
    tree, effectors = figures.human()
    rng = np.random.default_rng(6)
    poses = tree.rest + rng.uniform(-0.4, 0.4, (3, len(tree)))
    human = jacobian(tree, forward(tree, poses), effectors)
    sharp = np.diag(10.0 ** np.linspace(-2, 1, 6)) @ rng.normal(size=(6, 9))
    return [
        *human,
        rng.normal(size=(6, 9)),
        rng.normal(size=(6, 4)),
        rng.normal(size=(3, 5)),
        sharp,
    ]


@exercise(
    "06.gamma",
    returns=lambda J, max_angle: (min(J.shape),),
    hints=[
        "How far are the effectors to go along uᵢ, and how far would the joints throw them for it?",
        "N = lengths(U).sum(axis=0), ρ = lengths(J).sum(axis=0), Mᵢ = Σⱼ |vⱼᵢ| ρⱼ / σᵢ, and "
        "γ = min(1, N/M) γ_max.",
        "`M = abs(Vt) @ lengths(J).sum(axis=0) / sigma`; `return np.minimum(1, N / M) * max_angle`",
    ],
)
def gamma(answer: Answer) -> None:
    for J in jacobians():
        for max_angle in (np.pi / 4, 0.1):
            found = answer(J, max_angle)
            about = f"For a J of {J.shape[0]} × {J.shape[1]} and γ_max = {max_angle:.3g}"
            expect(
                found >= 0,
                f"{about} a bound is {found.min():.3g}, below 0: what has a sign that should not?",
            )
            expect(
                found <= max_angle * (1 + 1e-4),
                f"{about} a bound is {found.max():.4g}, above γ_max: where is the min?",
            )
            agree(
                answer(100 * J, max_angle),
                found,
                f"{about} a bound is {{wanted}} in metres and {{found}} in centimetres, but it is "
                "an angle: divide M by σ.",
                size=max_angle,
            )
            agree(
                answer(J[:, ::-1], max_angle),
                found,
                f"{about} a bound is {{wanted}}, and {{found}} with the joints in another order.",
                size=max_angle,
            )
            agree(
                found,
                directions(J, np.zeros(len(J)), max_angle=max_angle).gamma,
                f"{about} γ is {{found}}, where {{wanted}} is wanted.",
                size=0.01 * max_angle,
            )


def unclamped() -> Iterator[tuple[Array, float]]:
    """φ and a bound: the largest entry anywhere and of either sign; within, beyond and just on."""
    rng = np.random.default_rng(7)
    for n in (1, 2, 4, 20, 5, 3, 7):
        for _ in range(4):
            phi = rng.uniform(-1, 1, n) * 10.0 ** rng.uniform(-2, 1)
            peak = float(abs(phi).max())
            for share in (0.1, 0.9, 0.99, 1.0, 1.01, 20.0):
                yield phi, peak * share
    yield np.zeros(3), 0.1
    yield np.ones(3), 0.0


@exercise(
    "06.clamp",
    returns=lambda phi, bound: phi.shape,
    hints=[
        "Only one number is to be found: which, and from which entry of φ?",
        "The whole of φ shrinks by the share min(1, bound / max |φⱼ|), with a thought for φ = 0.",
        "`peak = abs(phi).max()` and `return phi * min(1, bound / peak) if peak else phi`",
    ],
    seconds=20,
)
def clamp(answer: Answer) -> None:
    for phi, bound in unclamped():
        done, peak = answer(phi, bound), float(abs(phi).max())
        wanted = phi * (bound / peak if peak > bound else 1)
        i = int(abs(done - wanted).argmax())
        was, now, right = numbers_apart(phi[i], done[i], wanted[i])
        about = (
            f"With bound {bound:.4g} entry {i + 1} of φ, {was} of at most {peak:.4g}, became {now}"
        )
        near = max(1e-4 * min(peak, bound), 1e-9 * peak)
        expect(
            abs(done).max() <= bound + near,
            f"{about}, and {right} is right: an entry of φ exceeds the bound.",
        )
        expect(
            abs(done * peak - phi * abs(done).max()).max() <= near * peak,
            f"{about}, and {right} is right: all entries must shrink by the same share.",
        )
        expect(
            abs(done - wanted).max() <= near,
            f"{about}, and {right} is right: φ within the bound must stay as it is, and beyond it "
            "just meet it.",
        )
