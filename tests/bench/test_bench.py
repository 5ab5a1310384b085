"""The benches run; what they measure is for whoever runs them by hand."""

import xml.etree.ElementTree as ET

import damping
import fuzz
import fuzz_solve
import motion
import numpy as np
import peers
import reach
import speed
from numpy.testing import assert_allclose

from ikteach import figures, forward, locate, solve, step
from ikteach.motion import hold
from ikteach.motion.reach.ways import WAYS


def test_speed_compares_things_that_do_the_same():
    theta, targets, J, e = speed.problem()
    foil = speed.textbook.dls_step(speed.tree, speed.effectors, theta, targets, speed.DAMPING)
    assert_allclose(speed.public_step(speed.damped, theta, targets), foil, atol=1e-12)
    door = speed.step(speed.tree, theta, speed.effectors, targets, speed.damped)
    assert_allclose(door.theta, foil, atol=1e-12)
    assert not door.held.any()
    assert_allclose(speed.bare_dls(J, e), speed.damped(J, e), atol=1e-12)


def test_speed_prints_its_table(capsys, monkeypatch):
    monkeypatch.setattr(speed, "BATCH", 3)
    monkeypatch.setattr(speed, "FEW", 2)
    speed.main(rounds=1)
    assert capsys.readouterr().out.count("\n") == 10


def test_damping_prints_its_table(capsys):
    damping.main(poses=2)
    assert capsys.readouterr().out.count("\n") == 1 + len(damping.METHODS)


def test_following_arrives_where_it_can():
    start, reach, _ = damping.problems(5)
    arrived, jitter = damping.run(damping.dls_following, start, reach)
    assert np.isfinite(jitter).all()
    assert arrived.min() < 30


def test_reach_prints_its_tables(capsys):
    reach.main(cursors=6, ticks=60)
    assert capsys.readouterr().out.count("\n") == 2 * (3 + len(WAYS))


def test_no_promise_is_broken(capsys):
    assert fuzz.main(ticks=6000, seed=1) == 0
    assert "violations 0" in capsys.readouterr().out


def test_a_broken_promise_is_seen():
    tree, effectors = figures.human()
    theta = np.stack([tree.rest] * 2)
    targets = locate(forward(tree, theta), effectors) + 0.3
    done = step(tree, theta, effectors, targets, "dls", max_step=0.05)
    told = {"max_step": 0.05, "mobility": None, "limits": hold}
    assert not fuzz.violations(tree, theta, done, **told)
    for name, spoilt, told_else in (
        ("finite", {"theta": done.theta * np.nan}, {}),
        ("locked", {}, {"mobility": np.zeros(20)}),
        ("cap", {}, {"max_step": 0.01}),
        ("dtheta", {"dtheta": done.dtheta * 1.1}, {}),
        ("within", {"theta": done.theta + 9}, {}),
        ("capped without a cap", {"capped": np.ones(2, dtype=bool)}, {"max_step": None}),
        ("the cap is not told", {"capped": np.zeros(2, dtype=bool), "held": done.held & False}, {}),
    ):
        broken = fuzz.violations(tree, theta, done._replace(**spoilt), **told | told_else)
        assert name in broken, name
    out = theta + 4.0
    stays = done._replace(theta=out, dtheta=0 * out)
    assert {"back"} <= fuzz.violations(tree, out, stays, **told).keys()
    further = done._replace(theta=out + 0.01, dtheta=0 * out + 0.01)
    assert {"further out"} <= fuzz.violations(tree, out, further, **told).keys()


def test_no_promise_of_solve_is_broken(capsys):
    assert fuzz_solve.main(solves=600, seed=1) == 0
    assert "violations 0" in capsys.readouterr().out


def test_a_broken_promise_of_solve_is_seen():
    tree, effectors = figures.human()
    theta = np.stack([(tree.lower + tree.upper) / 2] * 2)
    targets = locate(forward(tree, theta), effectors) + 0.3
    told = {"tolerance": 1e-3, "limits": hold, "most": 5, "restarts": 0, "weights": None}
    done = solve(tree, effectors, targets, theta=theta, most=5)

    def broken(**spoilt):
        found = done._replace(**spoilt)
        return fuzz_solve.violations(tree, effectors, theta, targets, found, 1.0, **told).keys()

    assert not broken()
    assert "finite" in broken(theta=done.theta * np.nan)
    assert "within" in broken(theta=done.theta + 9)
    assert {"converged", "converged, by forward"} <= broken(why=0 * done.why)
    assert "error" in broken(error=done.error / 2)
    assert "iterations" in broken(iterations=done.iterations + 9)
    start = locate(forward(tree, theta), effectors)
    lazy = {"theta": theta, "error": np.linalg.norm(targets - start, axis=-1)}
    assert broken(**lazy, why=0 * done.why + 1) == {"stands still"}
    assert "at limits" in broken(**lazy, why=0 * done.why + 2)


def test_peers_judges_and_prints_what_is_here(capsys, monkeypatch):
    only = {"ikteach.solve": peers.PEERS["ikteach.solve"], "nobody": ("nobody", _absent)}
    monkeypatch.setattr(peers, "PEERS", only)
    c = peers.case("", figures.human(), 1.8e-3, 0.1, 12)
    (ours,) = peers.race(c, peers.ready(c))
    assert "skipped: nobody" in capsys.readouterr().out
    assert ours.solved == 1
    spoilt = peers.judged(c, "spoilt", [(start + 9, 1) for start in c.starts], 1.0)
    assert spoilt.solved == 0


def _absent(c):
    raise ImportError("no module named nobody")


def test_every_peer_gets_the_same_body():
    c = peers.case("", figures.human(), 1.8e-3, 0.1, 1)
    tree, effectors = c.tree, c.effectors
    joints = ET.fromstring(peers.urdf(c)).findall("joint")
    assert [joint.get("name") for joint in joints] == [
        *tree.names,
        *(f"to {name}" for name in effectors.names),
    ]
    bodies = ET.fromstring(peers.mjcf(c)).iter("body")
    assert {body.get("name") for body in bodies} == set(tree.names)


def test_motion_prints_what_is_met(capsys, monkeypatch):
    monkeypatch.setattr(motion, "METHODS", {"dls": "dls"})
    for part in (motion.files, motion.retargeted, motion.walks):
        part()
    told = capsys.readouterr().out
    assert told.count("\n") == 2 + 4 + 3 * 5 + 4
    assert "nan" not in told
