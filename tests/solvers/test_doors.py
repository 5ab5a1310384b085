"""What goes into a solver and what comes out of it: anything made of numbers, or a sentence."""

from fractions import Fraction
from functools import partial, wraps

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ikteach import SOLVERS, cramer, dls_following, figures, step, track
from ikteach.motion.gait import walking
from ikteach.motion.live.session import Session
from ikteach.motion.mix import Mix, PerPose
from ikteach.solvers import (
    adjugate,
    ask,
    conditioning,
    determinant,
    ellipsoid,
    independence,
    manipulability,
    name_of,
)
from ikteach.solvers.response import directions, factors, response

J, E = np.array([[1.0, 0, 2], [0, 3, 1], [1, 1, 0]]), np.array([1.0, 0, 2])
TWO = {
    **SOLVERS,
    "following": dls_following,
    "cramer": cramer,
    "directions": directions,
    "factors": lambda J, e: factors(J, e, np.ones(3)),
    "response": lambda J, e: response(SOLVERS["dls"], J, e),
}
ONE = [ellipsoid, manipulability, conditioning, determinant, adjugate, independence]


def masked(array, at):
    """The array with one number masked."""
    mask = np.zeros(np.shape(array), dtype=bool)
    mask[at] = True
    return np.ma.array(array, mask=mask)


KINDS = {
    "integers": lambda a: a.astype(int),
    "int8": lambda a: a.astype(np.int8),
    "lists": lambda a: a.tolist(),
    "tuples": lambda a: tuple(map(tuple, a)) if a.ndim > 1 else tuple(a),
    "float32": lambda a: a.astype(np.float32),
    "float16": lambda a: a.astype(np.float16),
    "big-endian": lambda a: a.astype(">f8"),
    "objects": lambda a: a.astype(object),
    "fractions": lambda a: np.vectorize(Fraction, otypes=[object])(a.astype(int)),
    "strided": lambda a: np.repeat(a, 2, axis=-1)[..., ::2],
    "Fortran": np.asfortranarray,
    "unmasked": np.ma.array,
}


def agree(ours, theirs):
    """Whether two answers are one; some are records of arrays."""
    both = zip(ours, theirs, strict=True) if isinstance(theirs, tuple) else [(ours, theirs)]
    for one, other in both:
        assert_allclose(one, other, rtol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_anything_made_of_numbers_is_taken(kind):
    make = KINDS[kind]
    with np.errstate(all="raise", under="ignore"):
        for function in TWO.values():
            agree(function(make(J), make(E)), function(J, E))
        for function in ONE:
            agree(function(make(J)), function(J))


WRONG = {
    "words": "up",
    "words in a list": [["1", "2", "3"]] * 3,
    "nothing": None,
    "complex": J * 1j,
    "ragged": [[1, 2, 3], [1, 2]],
    "a number": 1.0,
    "a row": E,
    "NaN": J * np.nan,
    "infinite": np.full((3, 3), np.inf),
    "masked": masked(J, (0, 0)),
    "empty": np.zeros((0, 3)),
    "too large": [[10**400] * 3] * 3,
    "a function": abs,
    "a dictionary": {1: 2},
    "dates": np.array([["2026-01-01"] * 3] * 3, dtype="datetime64[D]"),
}
NUMPYS = ("broadcast", "core dimension", "ufunc", "inhomogeneous", "SVD", "setting an")


def in_a_sentence(call, *words):
    with pytest.raises((ValueError, TypeError)) as told:
        call()
    said = str(told.value)
    assert type(told.value) in (ValueError, TypeError)  # no LinAlgError
    assert len(said) < 300
    assert not any(word in said for word in NUMPYS), said
    for word in words:
        assert word in said


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("name", TWO)
def test_a_wrong_J(name, wrong):
    in_a_sentence(lambda: TWO[name](WRONG[wrong], E), "J")


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("function", ONE, ids=name_of)
def test_a_wrong_J_alone(function, wrong):
    in_a_sentence(lambda: function(WRONG[wrong]), "J")


@pytest.mark.parametrize(
    "e",
    [
        "up",
        None,
        E[:2],
        E[:, None],
        1.0,
        E * np.nan,
        np.full(3, np.inf),
        E * 1j,
        ["1", "2", "3"],
        np.ones(4),
    ],
    ids=lambda e: str(e)[:12],
)
@pytest.mark.parametrize("name", TWO)
def test_a_wrong_e(name, e):
    in_a_sentence(lambda: TWO[name](J, e), "e")


def test_batches_that_do_not_fit():
    for function in TWO.values():
        in_a_sentence(lambda f=function: f(np.stack([J] * 2), np.stack([E] * 3)), "J and e")
    in_a_sentence(lambda: SOLVERS["dls"](J, E, damping=np.ones((2, 1)) * [1, 1, np.nan]), "damping")
    in_a_sentence(lambda: SOLVERS["dls"](np.stack([J] * 2), E, damping=np.ones(3)), "damping")


OPTIONS = [
    (SOLVERS["transpose"], "gain"),
    (SOLVERS["pseudoinverse"], "cutoff"),
    (SOLVERS["dls"], "damping"),
    (SOLVERS["sdls"], "max_angle"),
    (dls_following, "share"),
    (dls_following, "least"),
    (cramer, "least"),
    (directions, "max_angle"),
]


@pytest.mark.parametrize(
    "value",
    [np.nan, np.inf, -1, -1e-9, "0.1", None, 1j, [0.1, -1], True, abs, {}, 10**400],
    ids=str,
)
@pytest.mark.parametrize(("solver", "option"), OPTIONS)
def test_every_option_is_checked_alike(solver, option, value):
    in_a_sentence(lambda: solver(J, E, **{option: value}), option, "must be", " not ")


@pytest.mark.parametrize(("solver", "option"), OPTIONS)
def test_an_option_may_be_any_number(solver, option):
    for one in (1, 1.0, np.float32(1), np.int64(1), np.array(1.0), Fraction(1)):
        agree(solver(J, E, **{option: one}), solver(J, E, **{option: 1.0}))


def test_a_clamp_is_a_function():
    for clamp in ("hard", None, 1.0):
        in_a_sentence(lambda c=clamp: SOLVERS["sdls"](J, E, clamp=c), "clamp must be a function")


# What a student's solver gives back.

TREE, EFFECTORS = figures.human()
GOAL = walking.at(0.1)


def changes_e(J, e):
    e *= 0.1
    return J.T @ e


def changes_J(J, e):
    J[:, 0] = 0
    return J.T @ e


def sorts_e(J, e):
    e.sort()
    return J.T @ e


BACK = {
    "nothing": (lambda J, e: None, "gave back nothing"),
    "a column": (lambda J, e: (J.T @ e)[:, None], "gave back an array of shape (20, 1)"),
    "a number": (lambda J, e: 0.1, "gave back one number, 0.1"),
    "a short array": (lambda J, e: np.zeros(3), "gave back an array of shape (3,)"),
    "a short list": (lambda J, e: [1, 2], "gave back an array of shape (2,)"),
    "a matrix": (lambda J, e: np.zeros((20, 20)), "gave back an array of shape (20, 20)"),
    "words": (lambda J, e: "up", "gave back 'up'"),
    "numbers in words": (lambda J, e: ["1"] * 20, "gave back ['1'"),
    "complex numbers": (lambda J, e: 1j * (J.T @ e), "gave back array("),
    "objects": (lambda J, e: np.array([None] * 20), "gave back array("),
    "a masked array": (lambda J, e: masked(J.T @ e, 3), "gave back masked"),
    "a pair": (lambda J, e: (J.T @ e, 0), "gave back (array"),
    "a dictionary": (lambda J, e: {"dtheta": 1}, "gave back {"),
    "a function": (lambda J, e: dls_following, "gave back <function"),
}
WRITE = [changes_e, changes_J, sorts_e]


def doors(solver):
    """Every way to a solver."""
    mix = Mix.of(EFFECTORS, dict.fromkeys(EFFECTORS.names, "dls") | {"hand.l": solver})
    return {
        "step": lambda: step(TREE, TREE.rest, EFFECTORS, GOAL, solver),
        "track": lambda: track(TREE, EFFECTORS, np.stack([GOAL] * 2), solver),
        "Mix": lambda: step(TREE, TREE.rest, EFFECTORS, GOAL, mix),
        "PerPose": lambda: step(TREE, [TREE.rest] * 2, EFFECTORS, GOAL, PerPose(["dls", solver])),
        "Session": lambda: Session(methods={"mine": solver}, method="mine").tick(),
    }


DOORS = list(doors("dls"))


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("what", BACK)
def test_what_is_no_step_is_told(what, door):
    solver, words = BACK[what]
    solver.__name__ = "mine"
    in_a_sentence(doors(solver)[door], f"mine {words}", "wanted is Δθ", "shape (20,)")


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("solver", WRITE)
def test_nobody_writes_into_what_others_read(solver, door):
    in_a_sentence(doors(solver)[door], solver.__name__, "writes into the J or e")


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_not_finite_is_told(bad, door):
    def mine(J, e):
        return np.where(np.arange(20) == 3, bad, 0.0)

    with pytest.raises(FloatingPointError, match="mine gave a step that is not finite"):
        doors(mine)[door]()


@pytest.mark.parametrize("door", DOORS)
def test_an_error_of_its_own_stays_and_is_told_of_whom(door):
    def mine(J, e):
        raise KeyError("knee")

    with pytest.raises(KeyError, match="knee") as told:
        doors(mine)[door]()
    assert "It was raised in the solver mine." in told.value.__notes__


def test_whole_numbers_and_lists_are_a_step_too():
    for make in (list, tuple, np.float32, lambda a: a.astype(int), lambda a: a.astype(object)):
        done = step(TREE, TREE.rest, EFFECTORS, GOAL, lambda J, e, m=make: m(np.ones(20)))
        assert_allclose(done.wanted, 1)
        assert done.theta.dtype == float


def test_a_batch_wants_a_batch():
    poses = np.stack([TREE.rest] * 3)
    in_a_sentence(
        lambda: step(TREE, poses, EFFECTORS, GOAL, lambda J, e: np.zeros(20)), "shape (3, 20)"
    )
    done = step(TREE, poses, EFFECTORS, GOAL, lambda J, e: np.zeros((3, 20)))
    assert done.theta.shape == (3, 20)


def test_a_solver_in_the_clothes_of_another_is_asked_itself():
    @wraps(SOLVERS["dls"])
    def mine(J, e):
        return np.ones(20)

    assert_allclose(step(TREE, TREE.rest, EFFECTORS, GOAL, mine).wanted, 1)


@pytest.mark.parametrize("solver", [*SOLVERS.values(), dls_following], ids=name_of)
def test_the_short_way_to_ours_is_the_way_of_all(solver):
    for J_, e_ in ((J, E), (np.stack([J, 2 * J]), E), (J, np.stack([E, -E]))):
        assert_allclose(ask(solver, J_, e_), solver(J_, e_), rtol=0, atol=0)
        assert_allclose(ask(lambda J, e: solver(J, e), J_, e_), solver(J_, e_), rtol=0, atol=0)
    with pytest.raises(ValueError, match="J is not finite"):
        ask(solver, np.where(J == 2, np.nan, J), E)


def test_a_damping_per_pose_of_one_J():
    dls, each = SOLVERS["dls"], np.array([[0.1, 0.2], [0.3, 0.0]])
    many = dls(J, E, damping=each)
    for i in np.ndindex(2, 2):
        assert_allclose(many[i], dls(J, E, damping=each[i]), rtol=1e-12)


class Odd:
    """A solver whose name cannot be had."""

    def __call__(self, J, e):
        return J.T @ e

    @property
    def __name__(self):
        raise RuntimeError("no name")


def test_whatever_the_solver_its_name_can_be_had():
    def named():
        return None

    named.__name__ = "x" * 10**6
    nameless = partial(partial(max))
    assert name_of(Odd()) == "Odd"
    assert name_of(nameless) == "max"
    assert len(name_of(named)) < 100
    assert name_of(lambda J, e: J) == "<lambda>"
    five = type("Five", (), {"__name__": 5, "__call__": lambda self, J, e: None})()
    assert name_of(five) == "Five"
    assert name_of(None) == "NoneType"
    in_a_sentence(lambda: ask(five, J, E), "Five gave back nothing")
