"""A session saved is the very session loaded; what is wrong with a file is named."""

import json
import os
import subprocess
import sys
from dataclasses import fields, replace
from functools import partial

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

from ikteach import SOLVERS, Effectors, Joint, Tree, dls, figures
from ikteach.formats.session import load, save
from ikteach.motion import gait
from ikteach.motion.live.session import Session
from ikteach.motion.mix import Mix

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


def test_directions_come_back(tmp_path):
    session = Session(figures.floating(figures.walker(), name="treadmill"))
    session.tick()
    save(tmp_path / "walker", session)
    run = load(tmp_path / "walker")
    for field in fields(Effectors):
        assert_array_equal(
            getattr(run.effectors, field.name), getattr(session.effectors, field.name)
        )


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
    with pytest.raises(ValueError, match="it is not text in UTF-8"):
        load(settings)


# ---- one moment at which the new run is there, and until then the old one


def runs(tmp_path):
    """A run of 3 ticks that is saved, and one of 5 to put in its place."""
    old, new = Session(), Session()
    for session, ticks in ((old, 3), (new, 5)):
        for _ in range(ticks):
            session.tick()
    save(tmp_path / "walk", old)
    return new


class Stop(BaseException):
    """The end of a process, as far as one can be had without one."""


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), Stop()], ids=str)
@pytest.mark.parametrize("call", range(1, 8))
@pytest.mark.parametrize("step", ["open", "fsync", "replace", "link", "rename"])
def test_a_save_that_ends_anywhere_leaves_the_old_run_or_the_new(
    tmp_path, monkeypatch, step, call, error
):
    new, calls, real = runs(tmp_path), [], getattr(os, step)

    def ends(*arguments, **options):
        calls.append(step)
        if len(calls) == call:
            raise error
        return real(*arguments, **options)

    raised = None
    with monkeypatch.context() as patch:
        patch.setattr(os, step, ends)
        try:
            save(tmp_path / "walk", new, overwrite=True)
        except (OSError, Stop) as left:
            raised = left
    if isinstance(raised, OSError):
        assert "cannot be written (No space left on device)" in str(raised)
    run = load(tmp_path / "walk")
    if not isinstance(error, Stop):
        assert len(run) == (3 if raised else 5)
    assert len(run) in (3, 5)
    assert load(tmp_path / "walk.json").theta.shape == run.theta.shape
    if not raised or isinstance(error, OSError):
        assert not [name for name in os.listdir(tmp_path) if name.endswith(".part")]
    save(tmp_path / "walk", new, overwrite=True)
    assert len(load(tmp_path / "walk")) == 5
    assert sorted(name for name in os.listdir(tmp_path) if "-" not in name) == [
        "walk.csv",
        "walk.json",
    ]


KILL = """
import os, sys
from pathlib import Path
from ikteach.formats.session import save
from ikteach.motion.live.session import Session
session, left = Session(), [int(sys.argv[2])]
for _ in range(5):
    session.tick()
for step in ("open", "fsync", "replace", "link", "unlink"):
    def counted(*a, real=getattr(os, step), **k):
        left[0] -= 1
        if not left[0]:
            os._exit(9)
        return real(*a, **k)
    setattr(os, step, counted)
save(Path(sys.argv[1], "walk"), session, overwrite=True)
"""


def test_a_save_that_is_killed_anywhere_leaves_the_old_run_or_the_new(tmp_path):
    seen = set()
    for call in range(1, 40):
        folder = tmp_path / str(call)
        folder.mkdir()
        runs(folder)
        code = subprocess.run([sys.executable, "-B", "-c", KILL, str(folder), str(call)]).returncode
        seen.add((code, len(load(folder / "walk"))))
        if code == 0:
            break
    assert seen == {(9, 3), (9, 5), (0, 5)}  # it was killed before, after, and not at all


def test_a_table_that_another_program_has_open_costs_nothing(tmp_path, monkeypatch):
    new, replace = runs(tmp_path), os.replace
    newer = Session()
    newer.tick()

    def locked(draft, path):
        if str(path).endswith("walk.csv"):
            raise PermissionError(13, "the file is open in another program")
        replace(draft, path)

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", locked)
        settings, table = save(tmp_path / "walk", new, overwrite=True)
        assert table.name.startswith("walk-")
        assert table.exists()
        assert len(load(settings)) == 5
        _, other = save(tmp_path / "walk", newer, overwrite=True)
        assert not table.exists()
        assert len(load(settings)) == 1
    save(tmp_path / "walk", new, overwrite=True)
    assert len(load(settings)) == 5
    assert not other.exists()
    assert sorted(os.listdir(tmp_path)) == ["walk.csv", "walk.json"]


def test_another_session_of_a_like_name_is_left_alone(session, tmp_path):
    save(tmp_path / "walk-0123abcd", session)
    runs(tmp_path)
    save(tmp_path / "walk", session, overwrite=True)
    assert len(load(tmp_path / "walk-0123abcd")) == len(session.log())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"dt": 0.0}, "a dt that is not positive"),
        ({"theta": np.nan}, "numbers that are not finite"),
        ({"methods": ("x" * 999, "mix")}, "no name of a method"),
        ({"methods": ("dls", "dls")}, "two methods called 'dls'"),
    ],
)
def test_what_could_not_be_read_back_is_not_saved(session, tmp_path, change, words):
    log = session.log()
    if "theta" in change:
        change = {"theta": np.full_like(log.theta, np.nan)}
    with pytest.raises(ValueError, match=words):
        save(tmp_path / "run", replace(log, **change))
    assert os.listdir(tmp_path) == []


def test_settings_that_json_does_not_know_are_told_in_words(session, tmp_path):
    odd = {"cap": np.inf, "none": np.nan, "half": "\ud800", "what": object, "n": np.int64(3)}
    save(tmp_path / "run", replace(session.log(), settings=odd))
    strict = (tmp_path / "run.json").read_text(encoding="utf-8")
    json.loads(strict, parse_constant=lambda word: pytest.fail(word))
    settings = load(tmp_path / "run").settings
    assert settings["cap"] == "inf"
    assert settings["n"] == 3
