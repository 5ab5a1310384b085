"""Chapter 3. The transpose: the best α, a step that is safe at zero, and how far is too far."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures, forward, jacobian
from ikteach.course.checking import Answer, exercise, expect
from ikteach.course.forms import agree, numbers_apart
from ikteach.solvers import transpose


def straight() -> Array:
    """J (3, 3) of an arm that is stretched out along x."""
    tree, effectors = figures.planar_arm(3)
    return jacobian(tree, forward(tree, tree.rest), effectors)


def problems() -> list[tuple[Array, Array]]:
    """Some (J, e) with Jᵀe not 0: many shapes and sizes, and an arm that lost a direction."""
    rng = np.random.default_rng(3)
    shapes = [(3, 3), (3, 5), (6, 4), (12, 20), (1, 2)]
    plain = [(rng.normal(size=s), rng.normal(size=s[0])) for s in shapes]
    arm = straight()
    errors = ([0.0, 0.1, 0.0], [-0.1, 0.1, 0.0], [-0.1, 1e-3, 0.0])
    lost = [(arm, np.array(e)) for e in errors]
    small = [(1e-6 * J, 1e-6 * e) for J, e in (plain[1], lost[0])]
    J, e = plain[1]
    return [*plain, *lost, *small, (1000 * J, 1000 * e), (J, 1e-6 * e), (1e-3 * J, e)]


def about(J: Array, e: Array) -> str:
    return f"For a J of {J.shape[0]} × {J.shape[1]} with ‖e‖ = {np.linalg.norm(e):.3g}"


@exercise(
    "03.alpha",
    returns=(),
    hints=[
        "What kind of curve is ‖e − αJJᵀe‖² as a function of α, and where is it lowest?",
        "With g = JJᵀe it is ⟨e,e⟩ − 2α⟨e,g⟩ + α²⟨g,g⟩: a parabola, "
        "lowest where its derivative is 0.",
        "`g = J @ (J.T @ e)` and `return (e @ g) / (g @ g)`",
    ],
)
def alpha(answer: Answer) -> None:
    for J, e in problems():
        g = J @ (J.T @ e)
        a, best = float(answer(J, e)), float(e @ g / (g @ g))

        def left(share: float, e: Array = e, g: Array = g) -> float:
            return float(np.linalg.norm(e - share * g) / np.linalg.norm(e))

        expect(
            a > 0,
            f"{about(J, e)} your α is {a:.3g}: the best α goes downhill, "
            f"it is above 0, {best:.3g}.",
        )
        expect(
            left(a) < 1,
            f"{about(J, e)} your α = {a:.3g} is too large: the linear model leaves "
            f"{left(a):.4g} ‖e‖, more than no step at all.",
        )
        agree(
            a,
            best,
            f"{about(J, e)} your α is {{found}}, and {{wanted}} leaves less of ‖e − αJJᵀe‖.",
            near=1e-3,
        )


@exercise(
    "03.safe",
    returns=lambda J, e: J.shape[1:],
    hints=[
        "What is divided by what when Jᵀe is zero? And is it ever zero where e is not?",
        "α = ⟨e,g⟩ / ⟨g,g⟩ with g = JJᵀe: where g is zero return zeros. Add nothing to ⟨g,g⟩: it "
        "changes every other step.",
        "`if not g.any(): return np.zeros(J.shape[1])`",
    ],
)
def safe(answer: Answer) -> None:
    for J, e in problems():
        wanted = transpose(J, e)
        agree(
            answer(J, e),
            wanted,
            f"{about(J, e)} Jᵀe is not zero, its length is {np.linalg.norm(J.T @ e):.3g}, and your "
            "step is not α Jᵀe with the best α: it is {found}, where {wanted} is wanted.",
        )
    inward = np.array([-1.0, 0.0, 0.0])
    for J, e, where in (
        (straight(), np.zeros(3), "there is no error"),
        (straight(), inward, "the arm is straight and its target straight inward"),
        (1e-6 * straight(), 1e-6 * inward, "the arm is straight, and all is a millionth as long"),
        (np.zeros((3, 4)), inward, "no joint can move the hand"),
    ):
        step = answer(J, e)
        expect(
            abs(step).max() < 1e-9,
            f"Where {where}, Jᵀe is zero and so is the step; yours is {abs(step).max():.3g} rad.",
        )


@exercise(
    "03.gain",
    returns=(),
    hints=[
        "What is left is a parabola in the gain: what is its value at gain 0, and at gain 1?",
        "It is lowest at gain 1, where it is `best`, and 1 at gain 0: so 1 − (1 − best) · gain · "
        "(2 − gain). At which other gain is it 1 again?",
        "`return 1 - (1 - best) * gain * (2 - gain)`",
    ],
)
def gain(answer: Answer) -> None:
    """left(gain, best): what of ‖e‖² a step leaves, where that with gain 1 leaves `best`."""
    gains = [0.0, 1.0, 2.0, *np.random.default_rng(33).uniform(0, 3, 4).round(2)]
    for J, e in problems():
        step, size = J @ transpose(J, e), float(e @ e)
        best = float((e - step) @ (e - step)) / size
        for share in map(float, gains):
            wanted = float((e - share * step) @ (e - share * step)) / size
            found = float(answer(share, best))
            texts = numbers_apart(found, wanted)
            expect(
                abs(found - wanted) < 1e-3,
                f"Where the best step leaves {best:.4g} of ‖e‖², one with gain {share:g} leaves "
                f"{texts[1]} of it, not {texts[0]}.",
            )
