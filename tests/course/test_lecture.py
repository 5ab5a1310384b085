"""The lecture's command: what is refused in a sentence, what is set, who gets in."""

import re
import socket
from pathlib import Path
from typing import Any

import nbformat
import pytest

from ikteach import __main__ as cli
from ikteach.course import lecture, ports
from ikteach.course.lecture.server import Lecture

PAGES = sorted(lecture.PAGES.glob("*.ipynb"))


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Lecture]:
    """What would be served, in place of serving it."""
    made: list[Lecture] = []
    monkeypatch.setattr(Lecture, "start", lambda self: made.append(self))
    monkeypatch.setenv(lecture.ROOM, "")
    monkeypatch.setenv("PYTHONPATH", "")
    monkeypatch.chdir(tmp_path)
    return made


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_page_is_words_one_figure_words_and_leads_to_all_others(page: Path) -> None:
    notebook = nbformat.read(page, as_version=4)
    nbformat.validate(notebook)
    head, figure, words = notebook.cells
    assert [cell.cell_type for cell in notebook.cells] == ["markdown", "code", "markdown"]
    assert figure.outputs == []
    links = set(re.findall(r"\((\w+\.ipynb)\)", head.source))
    assert links == {other.name for other in PAGES if other != page}
    for what in ("What you see.", "What to try.", "Keys."):
        assert f"**{what}**" in words.source
    assert len(words.source.split()) < 180
    exec(figure.source, {})


def test_pages_are_copied_and_what_was_changed_is_kept(
    served: list[Lecture], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["lecture", "--no-browser"]) == 0
    folder = Path("ikteach-lecture")
    assert {path.name for path in PAGES} <= {path.name for path in folder.iterdir()}
    (folder / "race.ipynb").write_text("mine")
    assert cli.main(["lecture"]) == 0
    assert "kept yours: race.ipynb" in capsys.readouterr().out
    assert [one.browse for one in served] == [False, True]
    assert {one.root_dir for one in served} == {str(folder.resolve())}


def test_alone_by_default_and_never_without_a_token(served: list[Lecture]) -> None:
    cli.main(["lecture", "--port", "18866"])
    cli.main(["lecture", "--room"])
    alone, room = served
    assert (alone.ip, room.ip) == ("127.0.0.1", "")
    assert (alone.port, alone.port_retries, room.port) == (18866, 0, 8866)
    assert alone.token != room.token
    assert min(len(one.token) for one in served) > 20
    assert alone.address == f"http://127.0.0.1:18866/?token={alone.token}"
    assert room.address == f"http://{lecture.own_address()}:8866/?token={room.token}"


def test_in_a_room_visitors_write_no_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(lecture.ROOM, raising=False)
    mine = lecture.workbench()
    assert mine.recorder.comm is not None
    monkeypatch.setenv(lecture.ROOM, "1")
    theirs = lecture.workbench()
    assert theirs.recorder.comm is None
    assert theirs.keeper.comm is None
    theirs.quit()
    theirs.close()


def test_the_server_shows_pages_and_nothing_else_and_sends_at_once(tmp_path: Path) -> None:
    from jupyter_server.services.kernels.websocket import KernelWebsocketHandler
    from voila.tornado.kernel_websocket_handler import VoilaKernelWebsocketHandler

    before = KernelWebsocketHandler.open
    served = Lecture.of(tmp_path, "workbench.ipynb", None)
    served.initialize([])
    try:
        served.init_settings()
        assert VoilaKernelWebsocketHandler.open is not before
    finally:
        KernelWebsocketHandler.open = before
    handlers: list[Any] = served.init_handlers()
    names = [handler.__name__ for _, handler, *_ in handlers]
    assert names[0] == "RedirectHandler"
    assert "Page" in names
    assert not {"TornadoVoilaTreeHandler", "VoilaContentsHandler", "TornadoVoilaHandler"} & set(
        names
    )


def test_what_hinders_is_said(
    served: list[Lecture], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert cli.main(["lecture", "--port", str(port)]) == 1
    assert f"Port {port} is taken; leave out --port" in capsys.readouterr().err
    Path("a-file").touch()
    assert cli.main(["lecture", "a-file"]) == 1
    assert "not a folder" in capsys.readouterr().err
    monkeypatch.setattr(ports.importlib.util, "find_spec", lambda name: None)
    assert cli.main(["lecture"]) == 1
    assert "pip install 'ikteach[lecture]'" in capsys.readouterr().err
    assert served == []
