"""Whatever a file holds: a session that is sound, or one short sentence about the file."""

import gzip
import io
import json
import os
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from ikteach.formats.session import load, save

FIRST = Path(__file__).parents[1] / "data" / "first_round" / "session"
TOLD = json.loads(FIRST.with_suffix(".json").read_text())
TABLE = FIRST.with_suffix(".csv").read_text()
ARRAYS = ("tick", "time", "targets", "theta", "error", "capped", "held", "shown")


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    """A folder for thousands of files, none of which waits for the disk."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: None)
        yield tmp_path_factory.mktemp("damaged")


def put(room, told=TOLD, table=TABLE):
    """A session of this content; text or bytes are taken as they are."""
    told = told if isinstance(told, str | bytes) else json.dumps(told)
    for ending, content in ((".json", told), (".csv", table)):
        data = content.encode("utf-8", "surrogatepass") if isinstance(content, str) else content
        (room / f"session{ending}").write_bytes(data)
    return room / "session"


def sentence(path):
    """What `load` says of a file that it does not take."""
    with pytest.raises((ValueError, LookupError, OSError)) as refused:
        load(path)
    words = str(refused.value)
    assert type(refused.value).__module__ == "builtins"
    assert 10 < len(words) < 700
    assert "\n" not in words
    return words


def sound_or_a_sentence(path):
    try:
        run = load(path)
    except (ValueError, LookupError, OSError):
        return sentence(path)
    assert all(np.isfinite(getattr(run, name)).all() for name in ARRAYS)
    assert (np.diff(run.tick) > 0).all()
    assert run.theta.shape == (len(run), len(run.methods), len(run.tree))
    assert run.dt > 0
    again = load(save(path.with_name("again"), run, overwrite=True)[0])
    for name in ARRAYS:
        assert_array_equal(getattr(again, name), getattr(run, name))
    assert [str(event) for event in again.events] == [str(event) for event in run.events]
    return run


# ---- the first round, and spreadsheets


def same_session(path):
    run, first = load(path), load(FIRST)
    for name in ARRAYS:
        assert_array_equal(getattr(run, name), getattr(first, name))


def test_a_session_of_the_first_round_is_read():
    run = load(FIRST)
    assert run.methods == ("dls", "transpose")
    assert run.tick.tolist() == [1, 2]
    assert run.tree.names[0] == TOLD["figure"]["joints"][0]["name"]
    assert [event.kind for event in run.events] == ["target", "method"]
    rows = [line.split(",") for line in TABLE.splitlines()]
    place = rows[0].index("theta.knee.l")
    knee = run.theta[:, :, run.tree.index("knee.l")]
    assert knee.ravel().tolist() == [float(row[place]) for row in rows[1:]]


def german(text):
    """Semicolons and decimal commas; the names of columns are no numbers."""
    head, rows = text.split("\n", 1)
    return head.replace(",", ";") + "\n" + rows.replace(",", ";").replace(".", ",")


def truths(text):
    """0 and 1 of `capped` and `held` as a spreadsheet's own TRUE and FALSE."""
    head, *rows = (line.split(",") for line in text.splitlines())
    flags = [i for i, name in enumerate(head) if name == "capped" or name.startswith("held.")]
    for row in rows:
        for i in flags:
            row[i] = ["FALSE", "true"][int(row[i])]
    return "\n".join(",".join(row) for row in [head, *rows])


@pytest.mark.parametrize(
    "again",
    [
        lambda text: "\ufeff" + text,
        lambda text: text.replace(",", ";"),
        lambda text: text.replace(",", "\t"),
        lambda text: ("\ufeff" + text.replace(",", "\t")).encode("utf-16-le"),
        lambda text: ("\ufeff" + text.replace(",", "\t")).encode("utf-16-be"),
        lambda text: "sep=;\r\n" + text.replace(",", ";"),
        german,
        lambda text: german(text).replace("\n", "\r\n"),
        truths,
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\r\n", "\n").replace("\n", "\r"),
        lambda text: text + "\n\n",
        lambda text: text + "," * TABLE.splitlines()[0].count(",") + "\r\n",
        lambda text: "\n".join(line and line + ",," for line in text.splitlines()[1:]).join(
            [text.splitlines()[0] + "\n", "\n"]
        ),
        lambda text: "\n".join(
            ",".join(f'"{cell}"' for cell in line.split(",")) for line in text.splitlines()
        ),
        lambda text: text.replace("\n1,", "\n1.0,").replace("\n2,", "\n2E+00,"),
    ],
    ids=[
        "bom", "semicolons", "tabs", "utf-16-le", "utf-16-be", "sep", "german", "german-crlf",
        "truths", "crlf", "cr", "empty-lines", "empty-cells", "empty-columns", "quoted", "numbers",
    ],
)  # fmt: skip
def test_what_spreadsheets_make_of_a_table_is_read(room, again):
    same_session(put(room, table=again(TABLE)))


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("", "has no column 'tick'; it is empty"),
        (TABLE.splitlines()[0], "has 0 rows in place of 4"),
        ("a,b\n1,2\n", "has no column 'tick'; it begins with 'a,b"),
        (TABLE.replace("held.knee.l", "held.knee.r"), "no column 'held.knee.l'"),
        (TABLE.replace("tick,", "tick,tick,", 1), "two columns 'tick'"),
        (TABLE + TABLE.splitlines()[-1], "has more rows in place of 4"),
        (TABLE.replace("\n1,", "\n-1,"), "'tick' in line 2 is '-1', not a whole number"),
        (TABLE.replace("\n1,", "\n1.5,"), "'tick' in line 2 is '1.5', not a whole number"),
        (TABLE.replace("\n1,", "\n1e300,"), "not a whole number"),
        (TABLE.replace("\n2,", "\n1,"), "ticks do not ascend"),
        (TABLE.replace("\n2,", "\n0,"), "ticks do not ascend"),
        (TABLE.replace("\n2,", "\n3,", 1), "the methods of one tick differ in 'tick'"),
        (TABLE.replace("0.0333", "01. Jan", 1), "'time' in line 2 is '01. Jan"),
        (TABLE.replace("0.0333", "inf", 1), "not a finite number"),
        (TABLE.replace(",transpose,", ",x,", 1), "its methods are not dls, transpose in turn"),
        (TABLE.replace(",dls,", ",x,", 1), "it shows 'x', which is no method"),
        ("x" * 600_000, "no line of a table"),
        ('"' + "x" * 600_000, "no column 'tick'"),
        (TABLE + '"' + "x" * 600_000, "is no line of a table"),
        ("tick" + ",x" * 3000, "no column 'time'"),
        (TABLE.splitlines()[0] + ",x" * 3000, "columns in place of"),
        (TABLE.encode("utf-16-le"), "it is not text"),
        (TABLE.replace("knee", "kné").encode("latin-1"), "it is not text in UTF-8"),
        (gzip.compress(TABLE.encode(), mtime=0), "it is a gzip archive"),
        (b"PK\x03\x04" + b"\0" * 99, "a zip archive or a spreadsheet"),
        (b"\0" * 4096, "it is not text"),
    ],
)
def test_a_table_that_is_none_is_named(room, table, words):
    said = sentence(put(room, table=table))
    assert said.startswith("'session.csv' is damaged: ")
    if not (table[:1] == "x" or table[:2] == '"x'):
        assert words in said


# ---- the JSON file


def changed(*path, to):
    """The settings with something else in one place; Ellipsis leaves it out."""
    told = json.loads(json.dumps(TOLD))
    place = told
    for step in path[:-1]:
        place = place[step]
    if to is ...:
        del place[path[-1]]
    else:
        place[path[-1]] = to
    return told


EVENT = {"run": 0, "tick": 1, "time": 0.1, "kind": "pause", "what": {}}


@pytest.mark.parametrize(
    ("told", "words"),
    [
        ("[" * 100_000, "nested too deep"),
        ('{"a":' * 5000 + "1" + "}" * 5000, "nested too deep"),
        (changed("settings", to=json.loads("[" * 100 + "]" * 100)), "nested too deep"),
        (changed("dt", to=10**400), "too large for a number"),
        (json.dumps(TOLD).replace("0.0333", "1e999"), "too large for a number"),
        (changed("dt", to="NaN"), "'dt' is 'NaN', not a number"),
        (changed("dt", to=float("nan")), "'dt' is 'NaN', not a number"),
        (changed("dt", to=float("inf")), "'dt' is 'Infinity', not a number"),
        (changed("dt", to=0), "must be more than 0"),
        (changed("dt", to=True), "'dt' is True, not a number"),
        (changed("dt", to=None), "'dt' is None, not a number"),
        (changed("rows", to=4.0), "'rows' is 4.0, not a whole number"),
        (changed("rows", to=10**300), "rows in place of"),
        (changed("rows", to=-1), "in place of -1"),
        (changed("dropped", "ticks", to=float("inf")), "not a whole number"),
        (changed("dropped", "ticks", to=-1), "must not be negative"),
        (changed("dropped", to=[]), "'dropped' is [], not names"),
        (changed("dropped", "events", to=...), "'events' in 'dropped' is missing"),
        (changed("events", to=[EVENT | {"run": "x"}]), "'run' of an event is 'x'"),
        (changed("events", to=[EVENT | {"time": None}]), "'time' of an event is None"),
        (changed("events", to=[EVENT | {"what": []}]), "'what' of an event is []"),
        (changed("events", to=[EVENT | {"kind": 3}]), "'kind' of an event is 3"),
        (changed("events", to=[EVENT | {"tick": -3}]), "must not be negative"),
        (changed("events", to=[3]), "an event is 3"),
        (changed("events", to={}), "'events' is {}, not a list"),
        (changed("methods", to=[]), "there are 0 methods"),
        (changed("methods", to=["dls", "dls"]), "two methods called 'dls'"),
        (changed("methods", to=["dls", 3]), "3 is no name of a method"),
        (changed("methods", to=["dls", "x" * 500_000]), "no name of a method"),
        (changed("methods", to=[f"m{i}" for i in range(9999)]), "there are 9999 methods"),
        (changed("settings", to=[1]), "'settings' is [1]"),
        (changed("figure", to="x" * 500_000), "'figure' is 'xxx"),
        (changed("figure", "joints", to=[{}]), "'name' of a joint is missing"),
        (changed("figure", "joints", 1, "lower", to=...), "'lower' of "),
        (changed("figure", "joints", 1, "lower", to="-1"), "is '-1', not a number"),
        (changed("figure", "joints", 1, "slide", to=0), "is 0, not true or false"),
        (changed("figure", "joints", 1, "axis", to=[0, 0, 0]), "is zero"),
        (changed("figure", "joints", 1, "axis", to=["1", "0", "0"]), "is '1', not a number"),
        (changed("figure", "joints", 1, "axis", to=[1, 0]), "not three numbers"),
        (changed("figure", "joints", 1, "parent", to="nobody"), "no joint 'nobody'"),
        (changed("figure", "joints", 1, "parent", to="y" * 500_000), "hangs from"),
        (changed("figure", "joints", 1, "name", to="z" * 500_000), "no name of a joint"),
        (changed("figure", "joints", to=TOLD["figure"]["joints"] * 500), "10000 joints"),
        (changed("figure", "effectors", to={}), "there are 0 effectors"),
        (changed("figure", "effectors", "hand.l", to=["wrist.l"]), "not a joint and an offset"),
        (changed("figure", "effectors", "hand.l", to=[3, [0, 0, 0]]), "is 3, not text"),
        (changed("figure", "effectors", "hand.l", to=["x", [0, 0, 0]]), "no joint 'x'"),
        (changed("figure", "effectors", "hand.l", to=["x", "abc"]), "not a list"),
        (changed("settings", "shown", to="\ud800"), "half a character"),
        (changed("settings", to={"\ud800": 1}), "half a character"),
        (changed("version", to="9" * 500_000), "is of version '999"),
        (changed("format", to=...), "does not say 'format'"),
        (changed("numbers", to="../session.csv"), "which is no file beside it"),
        (changed("numbers", to="/etc/passwd"), "which is no file beside it"),
        (changed("numbers", to="C:\\session.csv"), "which is no file beside it"),
        (changed("numbers", to=".."), "which is no file beside it"),
        (changed("numbers", to=""), "'numbers' is empty"),
        (changed("numbers", to="a" * 5000), "which is no file beside it"),
        (changed("numbers", to="a\0b"), "which is no file beside it"),
        (changed("numbers", to=3), "'numbers' is 3, not text"),
        (changed("numbers", to="gone.csv"), "has its numbers in"),
        ("", "it is not JSON (line 1"),
        ("null", "does not say 'format'"),
        (gzip.compress(b"{}", mtime=0), "it is a gzip archive"),
        (b"\xff\xfe\x00", "it is not text in UTF-8"),
    ],
)
def test_settings_that_are_none_are_named(room, told, words):
    assert words in sentence(put(room, told=told))


def test_strange_keys_and_marks_do_no_harm(room):
    same_session(put(room, told=TOLD | {"remark": [1, {"mine": None}]}))
    same_session(put(room, told="\ufeff" + json.dumps(TOLD)))
    same_session(put(room, told=json.dumps(TOLD, indent=4).replace("\n", "\r\n")))
    longer = json.loads(json.dumps(TOLD))
    longer["figure"]["joints"][1]["axis"] = [3 * x for x in longer["figure"]["joints"][1]["axis"]]
    run = load(put(room, told=longer))
    assert np.linalg.norm(run.tree.axes, axis=1) == pytest.approx(1)


# ---- files of another kind, and what is no file


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("walk.bvh", b"HIERARCHY\nROOT hips\n", "motion capture, a BVH file"),
        ("walk.json", b"HIERARCHY\nROOT hips\n", "motion capture, a BVH file"),
        ("arm.urdf", b'<?xml version="1.0"?>\n<robot name="arm"/>', "URDF"),
        ("arm.urdf", b'\n <robot name="arm"/>', "a robot, a URDF file"),
        ("table.csv", b"a,b\n1,2\n", "there is no 'table.json' beside it"),
        ("notes.txt", b"hello", "there is no 'notes.txt.json' beside it"),
        ("walk.gif", b"GIF89a", "a movie"),
        ("walk.json.gz", gzip.compress(b"{}", mtime=0), "a gzip archive"),
        ("book.json", b'{"cells": []}', "does not say 'format'"),
    ],
)
def test_a_file_of_another_kind_is_named_as_such(tmp_path, name, content, words):
    (tmp_path / name).write_bytes(content)
    said = sentence(tmp_path / name)
    assert said.startswith(f"'{name}' is not a session: ")
    assert words in said


def test_what_is_no_file(tmp_path, monkeypatch):
    assert "there is no session" in sentence(tmp_path / "nowhere" / "run")
    assert "there is no session" in sentence("a\0b")
    assert "cannot be read (File name too long)" in sentence("a" * 5000)
    assert "needs a file name" in sentence("")
    (tmp_path / "folder.json").mkdir()
    assert "folder.json cannot be read (it is a folder)" in sentence(tmp_path / "folder")
    os.mkfifo(tmp_path / "pipe.json")
    assert "it is not an ordinary file" in sentence(tmp_path / "pipe")
    (tmp_path / "loop.json").symlink_to("loop.json")
    assert "loop.json cannot be read" in sentence(tmp_path / "loop")
    path = put(tmp_path)
    (tmp_path / "session.csv").unlink()
    (tmp_path / "session.csv").mkdir()
    assert "it is a folder" in sentence(path)
    for folder in ("x", "y"):
        (tmp_path / folder).mkdir()
    path = put(tmp_path / "x")
    (tmp_path / "y" / "link.json").symlink_to(tmp_path / "x" / "session.json")
    assert "which is missing" in sentence(tmp_path / "y" / "link")  # it lies beside its settings

    def denied(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("builtins.open", denied)  # root may read anything
    assert sentence(path) == "session.json cannot be read (Permission denied)"


def test_files_are_bounded(tmp_path):
    path = put(tmp_path)
    for ending, words in ((".json", "more than 64"), (".csv", "more than 512")):
        with (tmp_path / f"session{ending}").open("r+b") as file:
            file.truncate(2**30)  # a hole: it takes no room
        assert words in sentence(path)
        put(tmp_path)


def test_a_spreadsheet_of_its_own_kind_is_named(room):
    book = io.BytesIO()
    with zipfile.ZipFile(book, "w") as archive:
        archive.writestr("xl/workbook.xml", "<workbook/>")
    assert "save the sheet as CSV" in sentence(put(room, table=book.getvalue()))


# ---- whatever happens to a file

ODD = st.one_of(
    st.none(), st.booleans(), st.integers(), st.just(10**400), st.floats(),
    st.text(st.characters(codec=None), max_size=5), st.just("x" * 5000),
    st.lists(st.integers(), max_size=3), st.dictionaries(st.text(max_size=3), st.none()),
    st.sampled_from(["NaN", "0", "dls", "knee.l", "session.csv", [[[]]], [0.0, 0.0, 1.0]]),
)  # fmt: skip


def places(value, path=()):
    """Every place in a tree of lists and dictionaries."""
    steps = value.items() if isinstance(value, dict) else enumerate(value)
    for step, inside in steps:
        yield (*path, step)
        if isinstance(inside, dict | list):
            yield from places(inside, (*path, step))


PLACES = list(places(TOLD))


@given(st.lists(st.tuples(st.sampled_from(PLACES), ODD | st.just(...)), min_size=1, max_size=2))
@settings(max_examples=1500)
def test_settings_with_anything_in_any_place(room, changes):
    told = json.loads(json.dumps(TOLD))
    for path, value in changes:
        place = told
        try:
            for step in path[:-1]:
                place = place[step]
            if value is ...:
                del place[path[-1]]
            else:
                place[path[-1]] = value
        except (TypeError, LookupError):
            pass  # what was to be changed is no longer there
    sound_or_a_sentence(put(room, told=told))


CUT = st.tuples(st.integers(0, 10**5), st.integers(0, 30), st.binary(max_size=6) | st.sampled_from(
    [b"\n", b",", b";", b'"', b"\0", b"9" * 400, b"nan", b"e999", b"\xef\xbb\xbf", b"-", b"TRUE"]
))  # fmt: skip


def cut(data, cuts):
    for at, length, new in cuts:
        at %= len(data) + 1
        data = data[:at] + new + data[at + length :]
    return data


@given(st.lists(CUT, min_size=1, max_size=3))
@settings(max_examples=1500)
def test_settings_with_bytes_cut_out_and_put_in(room, cuts):
    sound_or_a_sentence(put(room, told=cut(json.dumps(TOLD).encode(), cuts)))


@given(st.lists(CUT, min_size=1, max_size=3))
@settings(max_examples=1500)
def test_tables_with_bytes_cut_out_and_put_in(room, cuts):
    sound_or_a_sentence(put(room, table=cut(TABLE.encode(), cuts)))


@given(st.binary(max_size=200), st.booleans())
def test_anything_at_all(room, data, table):
    sound_or_a_sentence(put(room, table=data) if table else put(room, told=data))
