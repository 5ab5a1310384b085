"""The lecture's command: what is refused in a sentence, what is set, who gets in."""

import errno
import re
import socket
import sys
from pathlib import Path
from typing import Any

import nbformat
import pytest

from ikteach import __main__ as cli
from ikteach import __version__
from ikteach.serve import lecture, ports
from ikteach.serve.lecture.server import Lecture

PAGES = sorted(lecture.PAGES.glob("*.ipynb"))


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Lecture]:
    """What would be served, in place of serving it."""
    made: list[Lecture] = []
    monkeypatch.setattr(Lecture, "start", lambda self: made.append(self))
    monkeypatch.setenv(lecture.OPEN_TO_ROOM, "")
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
    monkeypatch.delenv(lecture.OPEN_TO_ROOM, raising=False)
    mine = lecture.workbench()
    assert mine.recorder.comm is not None
    monkeypatch.setenv(lecture.OPEN_TO_ROOM, "1")
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
    assert "Channels" in names
    assert not {"TornadoVoilaTreeHandler", "VoilaContentsHandler", "TornadoVoilaHandler"} & set(
        names
    )
    assert not {"AllowListFileHandler", "VoilaKernelWebsocketHandler"} & set(names)


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
    below = str(Path("a-file", "lecture"))
    assert cli.main(["lecture", below]) == 1
    assert f"{Path('a-file').resolve()}" in capsys.readouterr().err
    with monkeypatch.context() as readonly:
        readonly.setattr(Path, "mkdir", refuse_to_write)
        assert cli.main(["lecture", "mine"]) == 1
    assert "mine: Permission denied" in capsys.readouterr().err
    with monkeypatch.context() as old:
        old.setitem(sys.modules, "ikteach.serve.lecture.server", None)
        assert cli.main(["lecture"]) == 1
    assert "pip install --upgrade 'ikteach[lecture]'" in capsys.readouterr().err
    monkeypatch.setattr(ports.importlib.util, "find_spec", lambda name: None)
    assert cli.main(["lecture"]) == 1
    assert "pip install 'ikteach[lecture]'" in capsys.readouterr().err
    assert served == []
    assert not Path("ikteach-lecture").exists()


def refuse_to_write(path: Path, **_: Any) -> None:
    raise PermissionError(errno.EACCES, "Permission denied", str(path))


def test_its_address_stands_alone(served: list[Lecture], capsys: Any) -> None:
    cli.main(["lecture", "--no-browser"])
    capsys.readouterr()
    served[0].launch_browser()
    address, end = capsys.readouterr().out.splitlines()
    assert address.split() == ["the", "lecture", "is", "at", served[0].address]
    assert end == "Ctrl-C here ends it"


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["lectur"], "There is no command 'lectur'; did you mean lecture?"),
        (["Lecture", "--room"], "did you mean lecture?"),
        (["colect", "answers"], "did you mean collect?"),
        (["help"], "did you mean --help?"),
        (["version"], "did you mean --version?"),
        (["biuld", "student", "x"], "did you mean build?"),
        (["--no-browser", "lecture"], "The command comes first: python -m ikteach lecture …"),
        (["sit" + "e" * 3], "did you mean site?"),
    ],
)
def test_a_command_that_is_not_known_makes_no_folder(
    argv: list[str], words: str, served: list[Lecture], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(argv) == 1
    assert words in capsys.readouterr().err
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize(
    ("argv", "words"),
    [
        (["--no-browse"], "'--no-browse'; did you mean --no-browser?"),
        (["--versoin"], "did you mean --version?"),
        (["lecture", "--rom"], "'--rom'; did you mean --room?"),
        (["lecture", "--prot=8866"], "did you mean --port?"),
        (["lecture", "a", "b"], "there is no place for 'b'"),
        (["lecture", "--" + "x" * 500], " … xxxxxxxxxxxxxx'"),
        (["lecture", "--port", "0"], "ports are 1 to 65535"),
        (["lecture", "--port", "9" * 5000], "ports are 1 to 65535"),
        (["lecture", "--port", "²"], "ports are 1 to 65535"),
        (["site", "folder", "--pyodid", "x"], "did you mean --pyodide?"),
    ],
)
def test_an_option_that_is_not_known_is_asked_about(
    argv: list[str], words: str, served: list[Lecture], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        cli.main(argv)
    last = capsys.readouterr().err.splitlines()[-1]
    assert words in last
    assert len(last) < 200


def test_it_says_its_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        cli.main(["--version"])
    assert capsys.readouterr().out == f"ikteach {__version__}\n"
