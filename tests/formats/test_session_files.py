"""A session saved is the very session loaded; what is wrong with a file is named."""

import json
import os
from dataclasses import fields
from functools import partial

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

from ikteach import SOLVERS, Effectors, Joint, Tree, dls, figures
from ikteach.formats.session import load, save
from ikteach.motion import gait
from ikteach.motion.mix import Mix
from ikteach.motion.session import Session

ARRAYS = [
    "tick",
    "time",
    "phase",
    "advance",
    "floor",
    "shown",
    "targets",
    "theta",
    "error",
    "capped",
    "held",
]


@pytest.fixture(scope="module")
def session():
    """A run with a change of everything in it."""
    body = figures.human()
    mix = Mix.of(body.effectors, dict.fromkeys(body.effectors.names, "sdls"))
    session = Session(
        body, gait.running, {"dls": partial(dls, damping=0.3), "mix": mix}, max_step=0.1
    )
    for _ in range(4):
        session.tick()
    session.show("mix")
    session.change(speed=np.float64(0.1) + 0.2, forward=True)
    session.aim("hand.l", [1 / 3, 0.1, -0.7])
    session.note("pause")
    for _ in range(3):
        session.tick()
    return session


def test_all_comes_back_exactly(session, tmp_path):
    settings, table = save(tmp_path / "run", session)
    assert [settings.name, table.name] == ["run.json", "run.csv"]
    assert sorted(os.listdir(tmp_path)) == ["run.csv", "run.json"]
    before = session.log()
    for name in ("run", "run.json", "run.csv"):
        after = load(tmp_path / name)
        for array in ARRAYS:
            assert_array_equal(getattr(after, array), getattr(before, array), strict=True)
        assert after.methods == before.methods
        assert after.events == before.events
        assert after.settings == before.settings
        assert after.dropped == before.dropped
        assert after.dt == before.dt
        for one, other in ((after.tree, before.tree), (after.effectors, before.effectors)):
            for field in fields(one):
                assert_array_equal(getattr(one, field.name), getattr(other, field.name))
    assert after.settings["methods"]["dls"] == {"function": "dls", "damping": 0.3}
    assert after.settings["methods"]["mix"]["foot.l"] == "sdls"
    assert_array_equal(after.tracks()["mix"].theta, session.tracks()["mix"].theta)


def test_any_body_and_no_tick(tmp_path):
    joints = [Joint("a", axis=(1, 2, 3)), Joint("ö, b", "a", (0.1, 0, 0), slide=True, lower=-1)]
    tree = Tree.of(joints)
    body = figures.Figure(tree, Effectors.of(tree, {"end": ("ö, b", (0, 1, 0))}))
    session = Session(body, methods={"dls": SOLVERS["dls"]})
    save(tmp_path / "empty", session)
    run = load(tmp_path / "empty")
    assert len(run) == 0
    assert run.tracks() == {}
    for field in fields(Tree):
        assert_array_equal(getattr(run.tree, field.name), getattr(tree, field.name))


def test_nothing_is_overwritten_unasked(session, tmp_path):
    save(tmp_path / "run", session)
    with pytest.raises(FileExistsError, match=r"run.json' already; overwrite=True"):
        save(tmp_path / "run", session)
    (tmp_path / "run.json").unlink()
    with pytest.raises(FileExistsError, match=r"run.csv' already"):
        save(tmp_path / "run", session)
    save(tmp_path / "run", session, overwrite=True)
    assert sorted(os.listdir(tmp_path)) == ["run.csv", "run.json"]
    assert len(load(tmp_path / "run")) == len(session.log())
    with pytest.raises(FileNotFoundError, match="no folder"):
        save(tmp_path / "nowhere" / "run", session)


def test_a_failed_save_leaves_nothing(session, tmp_path, monkeypatch):
    monkeypatch.setattr(json, "dumps", lambda *a, **k: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        save(tmp_path / "run", session)
    assert os.listdir(tmp_path) == []


def test_a_table_with_more_columns_in_another_order_is_read(session, tmp_path):
    _, table = save(tmp_path / "run", session)
    wide = pd.read_csv(table, dtype=str).assign(remark="mine")
    wide[wide.columns[::-1]].to_csv(table, index=False)
    assert_array_equal(load(table).theta, session.log().theta)


def damage(tmp_path, session, *, settings=None, table=None):
    files = save(tmp_path / "run", session, overwrite=True)
    for file, change in zip(files, (settings, table), strict=True):
        if change is not None:
            file.write_text(change(file.read_text()))
    return tmp_path / "run"


def told(**changes):
    """A change of the JSON: keys to other values, or without them."""

    def change(text):
        all_of = json.loads(text) | changes
        return json.dumps({name: value for name, value in all_of.items() if value is not ...})

    return change


def line(number, old, new):
    def change(text):
        lines = text.splitlines()
        assert old in lines[number - 1]
        lines[number - 1] = lines[number - 1].replace(old, new, 1)
        return "\n".join(lines)

    return change


@pytest.mark.parametrize(
    ("settings", "table", "sentence"),
    [
        (lambda text: text[:300], None, "'run.json' is not a session: it is not JSON"),
        (lambda text: "[1]", None, "is not a session: it does not say 'format'"),
        (told(format="other"), None, "is not a session: it does not say 'format'"),
        (told(version=9), None, "is of version 9, and this reads 1"),
        (told(methods=...), None, "'run.json' is damaged: 'methods' is missing"),
        (told(dt="soon"), None, "'run.json' is damaged: 'dt' is 'soon', not a number"),
        (told(events=[{"kind": "x"}]), None, "'run.json' is damaged: .*missing"),
        (told(figure={"joints": [], "effectors": {}}), None, "damaged: there are 0 joints"),
        (told(methods=["dls"]), None, "'run.csv' is damaged: its methods are not dls in turn"),
        (None, line(1, "theta.knee.l", "knee"), "has no column 'theta.knee.l'"),
        (None, line(3, ",mix,", ",dls,"), "its methods are not dls, mix in turn"),
        (None, line(4, ",dls,", ",dls,x,"), "line 4 has 65 entries in place of 64"),
        (None, line(2, "0.03333", "0.o3333"), "'time' in line 2 is '0.o3333.*', not a finite num"),
        (None, line(2, "0.03333", "nan#"), "'time' in line 2 is 'nan#"),
        (None, lambda text: text[: text.rindex("\n", 0, -1)], "has 13 rows in place of 14"),
        (None, lambda text: "", "has no column 'tick'"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_file_is_named(session, tmp_path, settings, table, sentence):
    path = damage(tmp_path, session, settings=settings, table=table)
    with pytest.raises(ValueError, match=sentence):
        load(path)


def test_files_that_are_not_there_or_not_text(session, tmp_path):
    with pytest.raises(FileNotFoundError, match=r"there is no session '.*walk.json'"):
        load(tmp_path / "walk")
    settings, table = save(tmp_path / "run", session)
    table.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match=r"'run.csv' is damaged: it is not text"):
        load(settings)
    table.unlink()
    with pytest.raises(FileNotFoundError, match=r"has its numbers in '.*run.csv', which is missi"):
        load(settings)
    settings.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match="it is not JSON"):
        load(settings)
