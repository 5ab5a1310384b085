"""Every method and variant against Buss's C++, in every reference case, to 1e-11."""

from functools import partial
from math import pi, radians

import numpy as np
import pytest
from numpy.testing import assert_allclose
from reference import CASES, mobility, model

from ikteach import dls, forward, jacobian, locate, pseudoinverse, sdls, step, transpose
from ikteach.motion import BUSS_CAPS, ignore
from ikteach.solvers.sdls import hard, soft

close = partial(assert_allclose, rtol=1e-11, atol=1e-11)

half = partial(transpose, gain=0.5)
paper, buss = partial(sdls, clamp=hard), partial(sdls, clamp=soft)
thesis = partial(sdls, clamp=hard, max_angle=4 / pi)
# The answer of each variant, as: solver, step cap [rad], error clamp [m].
VARIANTS = {
    "transpose": (transpose, BUSS_CAPS["transpose"], None),
    "transpose_thesis_uncapped": (half, None, None),
    "pinv": (pseudoinverse, BUSS_CAPS["pseudoinverse"], None),
    "pinv_uncapped": (pseudoinverse, None, None),
    "dls_0.6": (partial(dls, damping=0.6), BUSS_CAPS["dls"], None),
    "dls_1.1": (partial(dls, damping=1.1), BUSS_CAPS["dls"], None),
    "dls_svd_0.6": (partial(dls, damping=0.6), radians(45), None),
    "dls_0.6_uncapped": (partial(dls, damping=0.6), None, None),
    "dls_clamped_0.7_c0.4": (partial(dls, damping=0.7), BUSS_CAPS["dls"], 0.4),
    "sdls": (buss, None, None),
    "sdls_clamp0.4": (buss, None, 0.4),
    "sdls_paper": (paper, None, None),
    "sdls_paper_clamp0.4": (paper, None, 0.4),
    "sdls_thesis_4overpi": (thesis, None, None),
}
SCALARS = {"transpose_JTe", "transpose_alpha", "transpose_beta", "pinv_rank_kept"}
ACTIVE = [(name, active) for name in CASES for active in ("end", "target")]


def J_and_e(case, active):
    """What a solver is given in this case."""
    tree, effectors = model(case["model"])
    frames = forward(tree, case["theta"])
    at = case["targets"] if active == "target" else None
    J = jacobian(tree, frames, effectors, at=at) * mobility(case)
    return J, (np.array(case["targets"]) - locate(frames, effectors)).ravel()


def answers(case, active):
    return case["out"]["active"][active]


def test_there_are_87_cases_and_every_answer_is_asked_for():
    assert len(CASES) == 87
    for name, active in ACTIVE:
        assert answers(CASES[name], active)["dTheta"].keys() == VARIANTS.keys() | SCALARS
        # No singular values repeat: the answer of SDLS is unique in every one.
        assert not CASES[name]["flags"][active]["degenerate_singular_values"]


@pytest.mark.parametrize("name", CASES)
def test_places_axes_error_and_both_jacobians(name):
    case = CASES[name]
    out = case["out"]
    tree, effectors = model(case["model"])
    frames = forward(tree, case["theta"])
    close(locate(frames, effectors), out["effectors"])
    close(frames.positions, out["joint_positions"])
    close(frames.axes, out["joint_axes"])
    for active in ("end", "target"):
        J, e = J_and_e(case, active)
        close(J, out[f"J_{active}"])
        close(e, out["dS"])


@pytest.mark.parametrize(("name", "active"), ACTIVE)
@pytest.mark.parametrize("variant", VARIANTS)
def test_step(name, active, variant):
    case = CASES[name]
    tree, effectors = model(case["model"])
    solver, cap, clamp = VARIANTS[variant]
    done = step(
        tree, case["theta"], effectors, case["targets"], solver,
        max_step=cap, max_error=clamp, mobility=mobility(case),
        limits=ignore, at_targets=active == "target",
    )  # fmt: skip
    wanted = answers(case, active)["dTheta"][variant]
    undefined = wanted[0] is None  # Jᵀe = 0, divided by 0 in the C++: no step is the right answer
    close(done.dtheta, np.zeros(len(tree)) if undefined else wanted)
    after = answers(case, active)["effectors_after"].get(variant)
    if after is not None and not undefined:
        close(locate(forward(tree, done.theta), effectors).ravel(), after)


@pytest.mark.parametrize(("name", "active"), ACTIVE)
def test_what_the_answers_are_made_of(name, active):
    J, e = J_and_e(CASES[name], active)
    wanted = answers(CASES[name], active)["dTheta"]
    JTe = J.T @ e
    close(JTe, wanted["transpose_JTe"])
    if wanted["transpose_alpha"] is not None:
        close(transpose(J, e) @ JTe, wanted["transpose_alpha"] * (JTe @ JTe))
    assert np.linalg.matrix_rank(pseudoinverse(J, np.eye(len(e)))) == wanted["pinv_rank_kept"]


@pytest.mark.parametrize(("name", "active"), ACTIVE)
def test_bounds_inside_sdls(name, active):
    """γ_i and max|σ_i⁻¹ α_i v_i|, as a clamp that is handed in sees them."""
    case = CASES[name]
    seen = []

    def spy(phi, bound):
        seen.append((abs(phi).max(axis=-1), bound))
        return hard(phi, bound)

    J, e = J_and_e(case, active)
    sdls(J, e, clamp=spy)
    peaks, bounds = seen[0]
    for i, wanted in enumerate(answers(case, active)["sdls_internals"]):
        if wanted["abs_sigma"] > 1e-10:
            close(bounds[i], wanted["gamma"])
            close(bounds[i], min(1, wanted["N"] / wanted["M"]) * pi / 4)
            close(peaks[i], wanted["max_abs_alpha_v_over_sigma"])
