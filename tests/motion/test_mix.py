"""A method for each effector."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from strategies import SEEDS, SHAPES, anybody

from ikteach import SOLVERS, dls, figures, step, track
from ikteach.motion.gait import walking
from ikteach.motion.mix import Mix
from ikteach.solvers import name_of

TREE, EFFECTORS = figures.human()
WALK = walking(walking.clock(20))


def system(body, seed, shape=()):
    rng = np.random.default_rng(seed)
    k, n = len(body.effectors), len(body.tree)
    J = rng.normal(size=(*shape, k, 3, n)) * body.effectors.mask
    return J.reshape(*shape, 3 * k, n), rng.normal(size=(*shape, 3 * k))


@given(anybody(), SEEDS, SHAPES, st.sampled_from(list(SOLVERS)))
def test_a_mix_of_one_method_is_that_method(body, seed, shape, method):
    J, e = system(body, seed, shape)
    mix = Mix.of(body.effectors, dict.fromkeys(body.effectors.names, method))
    carrying = body.effectors.carried.any(axis=0)  # the SVD gives the others rounding, the mix 0
    alone = SOLVERS[method](J, e)
    assert_array_equal(mix(J, e)[..., carrying], alone[..., carrying])
    assert_allclose(mix(J, e), alone, atol=1e-12 * max(1, abs(alone).max()))


@given(anybody(), SEEDS, st.data())
def test_each_joint_takes_the_mean_over_its_effectors(body, seed, data):
    J, e = system(body, seed)
    names = body.effectors.names
    chosen = {name: data.draw(st.sampled_from(list(SOLVERS))) for name in names}
    steps = np.array([SOLVERS[chosen[name]](J, e) for name in names])
    carried = body.effectors.carried
    wanted = (steps * carried).sum(axis=0) / np.maximum(carried.sum(axis=0), 1)
    assert_allclose(Mix.of(body.effectors, chosen)(J, e), wanted, rtol=1e-12, atol=1e-12)


def test_legs_by_one_method_and_arms_by_another():
    """The human's legs share no joint with its arms, so that each half is its method's own."""
    feet, hands = ("foot.l", "foot.r"), ("hand.l", "hand.r")
    mix = Mix.of(EFFECTORS, dict.fromkeys(feet, "dls") | dict.fromkeys(hands, "transpose"))
    runs = {method: track(TREE, EFFECTORS, WALK, method) for method in ("dls", "transpose", mix)}
    legs = EFFECTORS.carried[:2].any(axis=0)
    assert_allclose(runs[mix].theta[0, legs], runs["dls"].theta[0, legs], atol=1e-12)
    assert_array_equal(
        step(TREE, TREE.rest, EFFECTORS, WALK[0], mix).wanted[~legs],
        step(TREE, TREE.rest, EFFECTORS, WALK[0], "transpose").wanted[~legs],
    )
    assert runs[mix].method == name_of(mix) == "mix"
    assert repr(mix) == "Mix(foot.l: dls, foot.r: dls, hand.r: transpose, hand.l: transpose)"


def test_solvers_with_their_options_bound():
    soft = partial(dls, damping=0.5)
    mix = Mix.of(EFFECTORS, dict.fromkeys(EFFECTORS.names, soft))
    assert len(mix.solvers) == 1
    J, e = system(figures.human(), 3)
    assert_array_equal(mix(J, e), soft(J, e))


def test_what_cannot_be_mixed():
    with pytest.raises(LookupError, match=r"no effector 'foot'; did you mean"):
        Mix.of(EFFECTORS, {"foot": "dls"})
    with pytest.raises(ValueError, match=r"every effector; 'foot.r' has none"):
        Mix.of(EFFECTORS, {"foot.l": "dls"})
    with pytest.raises(LookupError, match="no method 'dsl'"):
        Mix.of(EFFECTORS, dict.fromkeys(EFFECTORS.names, "dsl"))
