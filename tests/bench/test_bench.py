"""The benches run; what they measure is for whoever runs them by hand."""

import damping
import numpy as np
import reach
import speed
from numpy.testing import assert_allclose


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
    assert capsys.readouterr().out.count("\n") == 2 * (3 + len(reach.study.WAYS))
