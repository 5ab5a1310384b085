"""Chapter 6. SDLS: the bound of each direction, and a clamp that keeps the way."""

import numpy as np

from ikteach.arrays import Array
from ikteach.body import figures, forward, jacobian
from ikteach.course.checking import Answer, exercise, expect
from ikteach.solvers.response import directions


def jacobians() -> list[Array]:
    """Some J, of the human near rest and at random, none with singular values that repeat."""
    tree, effectors = figures.human()
    rng = np.random.default_rng(6)
    poses = tree.rest + rng.uniform(-0.4, 0.4, (3, len(tree)))
    human = jacobian(tree, forward(tree, poses), effectors)
    return [*human, rng.normal(size=(6, 9)), rng.normal(size=(6, 4))]


@exercise(
    "06.gamma",
    returns=lambda J, max_angle: (min(J.shape),),
    hints=[
        "N = lengths(U).sum(axis=0) and ρ = lengths(J).sum(axis=0): one length an effector, summed.",
        "M_i = Σ_j |v_ji| ρ_j / σ_i. In arrays: `abs(Vt) @ rho / sigma`. Then γ = min(1, N/M) γ_max.",
    ],
)
def gamma(answer: Answer) -> None:
    for J in jacobians():
        for max_angle in (np.pi / 4, 0.1):
            found = answer(J, max_angle)
            expect(found >= 0, "A bound is below 0: what has a sign that should have none?")
            expect(found <= max_angle * (1 + 1e-12), "A bound is above γ_max: where is the min?")
            expect(
                np.allclose(answer(100 * J, max_angle), found, rtol=1e-7, atol=1e-12),
                "In centimetres the bounds are others, but they are angles: M must be divided by σ.",
            )
            expect(
                np.allclose(answer(J[:, ::-1], max_angle), found, rtol=1e-7, atol=1e-12),
                "With the joints in another order the bounds are others.",
            )
            wanted = directions(J, np.zeros(len(J)), max_angle=max_angle).gamma
            i = int(abs(found - wanted).argmax())
            expect(
                np.allclose(found, wanted, rtol=1e-7, atol=1e-12),
                f"γ of direction {i + 1} is {found[i]:.4g} where {wanted[i]:.4g} is wanted.",
            )


@exercise(
    "06.clamp",
    returns=lambda phi, bound: phi.shape,
    hints=[
        "Only one number is to be found: by what share the whole of φ shrinks.",
        "`phi * min(1, bound / abs(phi).max())`, with a thought for φ = 0.",
    ],
)
def clamp(answer: Answer) -> None:
    rng = np.random.default_rng(7)
    for n, size, bound in ((4, 1.0, 0.2), (20, 5.0, 0.7), (6, 0.01, 0.5), (5, 1.0, 10.0)):
        phi = size * rng.uniform(0.3, 1, n) * rng.choice([-1, 1], n)
        phi[-1] = -1.5 * size  # the largest is a negative one
        done = answer(phi, bound)
        peak = abs(phi).max()
        expect(abs(done).max() <= bound * (1 + 1e-12), "An entry of φ exceeds the bound.")
        expect(
            np.allclose(done * peak, phi * abs(done).max(), atol=1e-12),
            "The direction of φ has changed: all entries must shrink by the same share.",
        )
        expect(
            abs(abs(done).max() - min(peak, bound)) < 1e-9,
            "φ within the bound must stay as it is, and beyond it just meet it.",
        )
    expect(not answer(np.zeros(3), 0.1).any(), "φ = 0 must stay 0.")
    expect(not answer(np.ones(3), 0.0).any(), "With a bound of 0 nothing may move.")
