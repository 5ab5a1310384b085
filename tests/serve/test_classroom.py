"""The answers of a class as they come in: what is read, what is counted, who sees it."""

import asyncio
import json
import os
import re
from collections.abc import Awaitable, Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pupils
import pytest
from tornado.httpclient import AsyncHTTPClient, HTTPRequest, HTTPResponse

from ikteach import __main__ as cli
from ikteach.course import check, record, show_in_class
from ikteach.publish.delivery import find_course
from ikteach.serve import classroom
from ikteach.serve.classroom import folder as reading
from ikteach.serve.classroom.asked import Asked, Prediction, asked_in
from ikteach.serve.classroom.folder import ClassFolder
from ikteach.serve.classroom.server import ClassServer
from ikteach.serve.classroom.tally import ALONE, OTHER, finding_kind, tally

NOW = datetime(2026, 11, 28, 10, 0, tzinfo=UTC)
INWARD = Prediction("Which move?", ("all", "none"))
NEAR = Prediction("How many?", (), (0, 4, "methods"))
RANK = Prediction("In which order?", ("a", "b", "c"), ranking=True)
ASKED = Asked({"02.inward": INWARD, "02.near": NEAR, "08.rank": RANK}, {"00.hand"})


def answers(answer: Any = "none", key: str = "02.inward", **fields: Any) -> dict[str, Any]:
    return {"predictions": {key: {"answer": answer, "at": "2026-11-28T09:50:00+00:00"} | fields}}


def hand(sentence: str, *, passed: bool = False, tries: Any = 1, ago: float = 1) -> dict[str, Any]:
    since = (NOW - timedelta(minutes=ago)).isoformat()
    entry = {"passed": passed, "sentence": sentence, "tries": tries, "since": since, "at": since}
    return {"verdicts": {"00.hand": entry}}


def write(path: Path, content: Any) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def counted(place: Path, **options: Any) -> dict[str, Any]:
    seen = ClassFolder(place)
    return tally(seen.look(), ASKED, troubles=seen.troubles, now=NOW, **options)


def bars(rows: list[dict[str, Any]]) -> dict[str, int]:
    return {row["label"]: row["count"] for row in rows}


# Reading.


def test_a_student_is_a_home_a_folder_or_a_file(tmp_path: Path) -> None:
    write(tmp_path / "ada" / "ikteach-course" / "predictions.json", answers("all"))
    write(tmp_path / "bo" / "predictions.json", answers())
    write(tmp_path / "cy.json", answers())
    write(tmp_path / "ada" / "package.json", "{}")
    write(tmp_path / "dan" / "a" / "too" / "deep" / "predictions.json", answers())
    write(tmp_path / ".hidden" / "predictions.json", answers())
    seen = ClassFolder(tmp_path)
    assert list(seen.look()) == ["ada", "bo", "cy"]
    assert seen.troubles == {}


def test_what_is_not_to_be_read_is_named_and_harms_no_other(tmp_path: Path) -> None:
    place, secret = tmp_path / "class", write(tmp_path / "secret.json", answers("all"))
    write(place / "good" / "predictions.json", answers())
    bad = {
        "half": '{"predictions": {"02.in',
        "none": '{"log": null}',
        "form": '{"predictions": {"02.inward": "none"}}',
        "deep": "[" * 100_000,
        "bytes\n<b>": "\x00\x01",
    }
    for name, content in bad.items():
        write(place / name / "predictions.json", content)
    (place / "link").symlink_to(secret.parent)
    (place / "link.json").symlink_to(secret)
    (place / "within").mkdir()
    (place / "within" / "predictions.json").symlink_to(secret)
    (place / "folder" / "predictions.json").mkdir(parents=True)
    (place / "pipe").mkdir()
    os.mkfifo(place / "pipe" / "predictions.json")
    large = write(place / "large" / "predictions.json", answers())
    os.truncate(large, reading.LARGEST + 1)
    seen = ClassFolder(place)
    assert list(seen.look()) == ["good"]
    why = {name.split("/")[0]: words for name, words in seen.troubles.items()}
    assert why.keys() == {*bad, "link.json", "within", "folder", "pipe", "large"}
    assert "not JSON" in why["half"]
    assert why["within"] == why["link.json"] == reading.LINK
    assert "more than 4" in why["large"]
    assert all(len(words) <= reading.LONGEST for words in why.values())


def test_a_folder_on_the_way_that_becomes_a_link_is_not_followed(tmp_path: Path) -> None:
    outside = write(tmp_path / "outside" / "predictions.json", answers())
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "ada").symlink_to(outside.parent)
    with pytest.raises(OSError, match="link"):
        reading.open_within(tmp_path / "class", ("ada", "predictions.json"))


def test_only_what_changed_is_read(tmp_path: Path) -> None:
    for i in range(60):
        write(tmp_path / f"s{i}" / "course" / "predictions.json", answers())
    seen = ClassFolder(tmp_path)
    assert (len(seen.look()), seen.reads) == (60, 60)
    seen.look()
    assert seen.reads == 60
    write(tmp_path / "s7" / "course" / "predictions.json", answers("something longer"))
    assert seen.look()["s7"]["predictions"]["02.inward"]["answer"] == "something longer"
    assert seen.reads == 61


def test_a_file_that_is_half_written_stands_as_it_was(tmp_path: Path) -> None:
    path = write(tmp_path / "ada.json", answers("all"))
    seen = ClassFolder(tmp_path)
    before = seen.look()
    write(path, '{"predictions"')
    assert seen.look() == before
    assert "not JSON" in seen.troubles["ada.json"]
    seen.look()
    assert "not JSON" in seen.troubles["ada.json"]  # also when nothing changed
    write(path, answers("none, at last"))
    assert seen.look()["ada"]["predictions"]["02.inward"]["answer"] == "none, at last"
    assert seen.troubles == {}
    path.unlink()
    assert seen.look() == {}


def test_of_several_files_the_newest_answer_counts(tmp_path: Path) -> None:
    write(tmp_path / "ada" / "old" / "predictions.json", answers("all", at="2026-11-27"))
    write(tmp_path / "ada" / "predictions.json", answers("none", at="2026-11-28"))
    write(tmp_path / "ada" / "zoo" / "predictions.json", answers("all", at="2026-11-26"))
    assert ClassFolder(tmp_path).look()["ada"]["predictions"]["02.inward"]["answer"] == "none"


def test_who_does_not_want_to_be_counted_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("ada", "bo"):
        monkeypatch.setattr(record, "_folder", tmp_path / name)
        (tmp_path / name).mkdir()
        record.store("predictions", "02.inward", answer="none")
    assert counted(tmp_path)["students"] == 2
    said = show_in_class(False)
    assert "left out" in str(said)
    assert list(ClassFolder(tmp_path).look()) == ["ada"]
    record.export(tmp_path / "bo.json")  # handed in beside it
    assert list(ClassFolder(tmp_path).look()) == ["ada"]
    assert record.entry("predictions", "02.inward")["answer"] == "none"
    (tmp_path / "bo.json").unlink()
    show_in_class()
    assert list(ClassFolder(tmp_path).look()) == ["ada", "bo"]


def test_to_be_left_out_overwrites_no_file_that_cannot_be_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(record, "_folder", tmp_path)
    write(tmp_path / "predictions.json", "mine")
    show_in_class(False)
    assert (tmp_path / "predictions.damaged-1.json").read_text() == "mine"
    (tmp_path / "predictions.json").unlink()
    (tmp_path / "predictions.json").mkdir()
    assert "Not changed" in str(show_in_class(False))


def test_a_first_try_keeps_its_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(record, "_folder", tmp_path)
    check("00.reach", lambda *_: True)
    first = record.entry("verdicts", "00.reach")["since"]
    content = json.loads((tmp_path / "predictions.json").read_text())
    content["verdicts"]["00.reach"]["since"] = "2026-01-01T00:00:00+00:00"
    write(tmp_path / "predictions.json", content)
    check("00.reach", lambda *_: False)
    again = record.entry("verdicts", "00.reach")
    assert (first >= "2026", again["since"], again["tries"]) == (
        True, "2026-01-01T00:00:00+00:00", 2,
    )  # fmt: skip


# Counting.


def test_what_the_notebooks_ask_is_read_from_their_cells() -> None:
    notebooks = find_course().notebooks
    asked, keys, tasks = asked_in(notebooks), set[str](), set[str]()
    for path in notebooks.glob("*.ipynb"):
        for cell in json.loads(path.read_text("utf-8"))["cells"]:
            if cell["cell_type"] == "code":
                source = "".join(cell["source"])
                keys |= set(re.findall(r'\bpredict\(\s*"([\w.-]+)"', source))
                tasks |= set(re.findall(r'\bcheck\("([\w.-]+)"', source))
    assert asked.predictions.keys() == keys
    assert asked.exercises == tasks
    assert len(keys) > 40
    for one in asked.predictions.values():
        assert one.question
        assert one.numbers or len(one.options) > 1
    assert sum(one.ranking for one in asked.predictions.values()) == 3


def test_a_cell_is_read_and_not_run(tmp_path: Path) -> None:
    source = 'A = open("taken", "w")\npredict("x", A, ["a", "b"])\npredict("y", "why?", ["a", "b"])'
    cell = {"cell_type": "code", "source": source}
    write(tmp_path / "mine.ipynb", {"cells": [cell, {"cell_type": "code", "source": "%magic ("}]})
    write(tmp_path / "other.ipynb", "[1]")
    assert list(asked_in(tmp_path).predictions) == ["y"]
    assert not Path("taken").exists()


def test_the_shares_are_those_of_a_count_by_hand(tmp_path: Path) -> None:
    given = ["all", "none", "none", "<b>rude</b>", ["none"], 3]
    for i, answer in enumerate(given):
        write(tmp_path / f"s{i}.json", answers(answer))
    write(tmp_path / "s6.json", answers(None, result="none"))
    found = counted(tmp_path)
    (one,) = found["predictions"]
    assert (found["students"], one["answered"], one["result"]) == (7, 6, "none")
    assert bars(one["rows"]) == {"all": 1, "none": 2, OTHER: 3}
    assert "rude" not in json.dumps(found)


def test_numbers_are_counted_in_parts_of_their_range(tmp_path: Path) -> None:
    for i, answer in enumerate([0, 1, 1, 4.0, True, 9]):
        write(tmp_path / f"s{i}.json", answers(answer, "02.near"))
    (one,) = counted(tmp_path)["predictions"]
    assert bars(one["rows"]) == {
        "0 methods": 1, "1 methods": 2, "2 methods": 0, "3 methods": 0, "4 methods": 1, OTHER: 2,
    }  # fmt: skip
    assert one["note"] == "Median: 1 methods"
    write(tmp_path / "s6.json", answers(2.5, "02.near"))
    (one,) = counted(tmp_path)["predictions"]
    assert list(bars(one["rows"]))[:2] == ["0 to 0.8 methods", "0.8 to 1.6 methods"]
    assert sum(bars(one["rows"]).values()) == 7


def test_orders_are_counted_whole_the_most_frequent_first(tmp_path: Path) -> None:
    orders = [["a", "b", "c"], ["c", "b", "a"], ["c", "b", "a"], ["c", "rude"], ["a", "a", "a"]]
    for i, order in enumerate(orders):
        write(tmp_path / f"s{i}.json", answers(order, "08.rank"))
    (one,) = counted(tmp_path)["predictions"]
    want = {"c, then b, then a": 2, "a, then b, then c": 1, OTHER: 2}
    assert list(bars(one["rows"]).items()) == list(want.items())


def test_what_no_notebook_asks_is_shown_once_two_agree(tmp_path: Path) -> None:
    write(tmp_path / "a.json", answers("rude", "my.own"))
    assert counted(tmp_path)["predictions"] == []
    write(tmp_path / "b.json", answers("yes", "my.own"))
    write(tmp_path / "c.json", answers("yes", "my.own"))
    (one,) = counted(tmp_path)["predictions"]
    assert bars(one["rows"]) == {"yes": 2, OTHER: 1}


def test_stuck_is_who_tries_often_or_long(tmp_path: Path) -> None:
    wrong = "The hand is at 3.0 m."
    cases = {
        "passed": hand("`hand` passes every check.", passed=True, tries=9, ago=50),
        "begun": hand(wrong, tries=2),
        "often": hand("The hand is at 4.5 m.", tries=3),
        "long": hand("`f(1)` raised ValueError: rude.", tries=1, ago=12.5),
        "stub": hand("Not yet: write your answer first.", tries=5),
        "odd": hand("rude", tries=10**30, ago=-90) | {},
    }
    for name, content in cases.items():
        write(tmp_path / f"{name}.json", content)
    found = counted(tmp_path)
    (one,) = found["exercises"]
    assert (one["passed"], one["working"], one["stuck"], one["longest"]) == (1, 2, 3, 12)
    assert one["tries"] == 999
    assert bars(one["kinds"]) == {wrong: 2, ALONE: 2}
    assert "rude" not in json.dumps(found)
    (named,) = counted(tmp_path, names=True)["exercises"]
    assert named["who"][0] == {"name": "long", "minutes": 12, "tries": 1}
    assert {who["name"] for who in named["who"]} == {"long", "often", "odd"}


def test_students_whose_long_names_look_alike_are_two(tmp_path: Path) -> None:
    for middle in "ab":
        name = f"{'x' * 70}{middle}{'y' * 70}"
        write(tmp_path / name / "predictions.json", answers())
    found = counted(tmp_path, names=True)
    assert found["students"] == 2
    assert max(map(len, found["predictions"][0]["who"])) <= 60
    write(tmp_path / os.fsdecode(b"\xff\n") / "predictions.json", answers())
    assert json.dumps(counted(tmp_path, names=True)).isascii()  # what the page is sent


def test_names_come_only_if_they_are_asked_for(tmp_path: Path) -> None:
    write(tmp_path / "grace" / "predictions.json", answers())
    write(tmp_path / "hopper.json", hand("Wrong."))
    write(tmp_path / "damaged.json", "{")
    found = counted(tmp_path)
    assert found["troubles"] == 1
    assert not re.search("grace|hopper|damaged", json.dumps(found))
    named = counted(tmp_path, names=True)
    assert named["predictions"][0]["who"] == ["grace"]
    assert named["predictions"][0]["missing"] == ["hopper"]
    assert "damaged" in named["named"][0]


def test_findings_are_of_a_kind_whatever_their_numbers() -> None:
    same = ("at [0, 2.1] m, not at [1.1, 1]", "at [3, −1e-3] m, not at [0.5, 2]")
    assert len({finding_kind(one) for one in same}) == 1
    assert finding_kind("at 2 m") != finding_kind("at 2 rad")


# Who sees it.


@pytest.fixture
def served(tmp_path: Path) -> ClassServer:
    write(tmp_path / "<b>ada" / "predictions.json", answers())
    return ClassServer(classroom.Counts(tmp_path), None)


def visited(served: ClassServer, visit: Callable[[Any], Awaitable[None]]) -> None:
    async def get(path: str, cookie: str = "", host: str = "127.0.0.1") -> HTTPResponse:
        headers = {"Cookie": cookie, "Host": f"{host}:{served.port}"}
        address = f"http://127.0.0.1:{served.port}{path}"
        request = HTTPRequest(address, headers=headers, follow_redirects=False)
        return await AsyncHTTPClient().fetch(request, raise_error=False)

    async def whole() -> None:
        serving = asyncio.create_task(served.serve())
        await asyncio.sleep(0)
        try:
            await visit(get)
        finally:
            serving.cancel()

    asyncio.run(whole())


def test_who_has_the_token_comes_in_and_the_address_forgets_it(served: ClassServer) -> None:
    async def visit(get: Any) -> None:
        first = await get(f"/?token={served.token}")
        assert (first.code, first.headers["Location"]) == (302, "/")
        said = first.headers["Set-Cookie"]
        assert "HttpOnly" in said
        assert "SameSite=Strict" in said
        cookie = said.partition(";")[0]
        page = await get("/", cookie)
        assert (page.code, page.headers["Cache-Control"]) == (200, "no-store")
        assert "default-src 'none'" in page.headers["Content-Security-Policy"]
        assert b"Projector" in (await get("/page.js", cookie)).body
        assert (await get("/page.css", cookie)).code == 200
        counts = await get("/now", cookie)
        assert counts.headers["Content-Type"].startswith("application/json")
        assert b"ada" not in counts.body
        assert json.loads((await get("/now?names=1", cookie)).body)["predictions"][0]["who"]
        for path in ("/page.html", "/../server.py", "/%2e%2e/server.py", "/page.js/x"):
            assert (await get(path, cookie)).code == 404

    visited(served, visit)


def test_nobody_else_comes_in(served: ClassServer) -> None:
    async def visit(get: Any) -> None:
        cookie = f"ikteach-class-{served.port}={served.token}"
        for path in ("/", "/now", "/now?names=1", "/page.js", "/page.css", "/?token=", "/?token=é"):
            answer = await get(path)
            assert answer.code == 403, path
            assert b"ada" not in answer.body
        assert (await get("/now", cookie[:-1])).code == 403
        assert (await get("/now", f"ikteach-class-1={served.token}")).code == 403
        assert (
            await get("/now", cookie, host="evil.example")
        ).code == 403  # a name that leads here
        assert (await get("/now", cookie, host="localhost")).code == 200

    visited(served, visit)


def test_many_looks_are_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path / "ada.json", answers())
    counts = classroom.Counts(tmp_path)
    write(path, answers("all, it may be"))
    assert bars(counts(False)["predictions"][0]["rows"])["none"] == 1
    assert counts.folder.reads == 1
    monkeypatch.setattr(classroom, "FRESH", -1.0)
    assert bars(counts(False)["predictions"][0]["rows"])[OTHER] == 1


def test_the_command_says_where_the_page_is_and_what_hinders(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    async def over(self: ClassServer) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(ClassServer, "serve", over)
    assert cli.main(["class", str(tmp_path), "--no-browser"]) == 0
    assert re.match(
        r"the class is at http://127\.0\.0\.1:\d+/\?token=[\w-]{20,}\nCtrl-C here ends it\n",
        capsys.readouterr().out,
    )
    assert cli.main(["class", str(tmp_path / "no"), "--no-browser"]) == 1
    assert "is not a folder" in capsys.readouterr().err
    elsewhere = ["--notebooks", str(tmp_path / "mine")]
    assert cli.main(["class", str(tmp_path), "--no-browser", *elsewhere]) == 1
    assert "mine is not a folder" in capsys.readouterr().err
    assert cli.main(["class", str(tmp_path), "--no-browser", "--", "--x"]) == 1
    assert "leave out" in capsys.readouterr().err
    assert cli.main(["clas", str(tmp_path)]) == 1
    assert "did you mean class?" in capsys.readouterr().err


def test_a_made_up_class_is_counted_as_it_answers(tmp_path: Path) -> None:
    todo = pupils.steps(tmp_path, 1, pupils=8)
    before, seen, asked = 0, ClassFolder(tmp_path), asked_in(find_course().notebooks)
    for act in todo:
        act()
        found = tally(seen.look(), asked, troubles=seen.troubles)
        assert found["students"] >= before
        before = found["students"]
    assert before == 7  # one of eight is not counted
    one = next(p for p in found["predictions"] if p["key"] == "02.inward")
    own = [json.loads(p.read_text()) for p in tmp_path.glob("*/predictions.json")]
    all_ = [a["predictions"].get("02.inward") for a in own if a.get("in class", True)]
    given = [a["answer"] for a in all_ if a and a.get("answer")]
    assert one["answered"] == len(given)
    for row in one["rows"]:
        if row["label"] != OTHER:
            assert row["count"] == given.count(row["label"])
