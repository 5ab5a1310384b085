"""Binder's steps from a clean clone of what is committed, and its links in a browser.

IKTEACH_FULL=1 opens every link; else one of each kind.
"""

import json
import os
import urllib.error
from collections.abc import Iterator
from typing import Any

import psutil
import pytest
from playwright.sync_api import Browser

from binder.links import chapters, lecture
from binder.recipe import Build
from binder.rehearse import MEMORY, Server, look, serving
from ikteach.publish.delivery import title
from tests.browser.conftest import ROOT, SHOTS


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    if not (ROOT / ".git").exists():
        pytest.skip("this is no clone, and Binder builds clones")
    built = Build(tmp_path_factory.mktemp("binder"))
    assert "pip check" in list(built.steps())
    with serving(built) as server:
        yield server


def test_what_the_build_prepared(server: Server) -> None:
    assert list(server.home.glob(".cache/matplotlib/fontlist-*.json"))
    assert "ikteach.serve.extension | extension was successfully loaded" in server.log.read_text()
    environment = psutil.Process(server.process.pid).environ()
    assert environment["OMP_NUM_THREADS"] == environment["OPENBLAS_NUM_THREADS"] == "1"


@pytest.mark.parametrize(
    "headers", [{"Accept": "application/json"}, {"Origin": "https://elsewhere.example"}], ids=str
)
def test_nobody_gets_in_without_the_token(server: Server, headers: dict[str, str]) -> None:
    with pytest.raises(urllib.error.HTTPError, match=r"403|404") as refused:
        server.ask("api/contents/", **headers)
    assert refused.value.headers["Access-Control-Allow-Origin"] is None  # other sites may not read


def test_the_file_of_each_link_is_served(server: Server) -> None:
    for link in (chapters() | lecture()).values():
        path = link.split("/", 2)[2]
        assert sources(server.ask(f"api/contents/{path}")["content"]) == sources(
            json.loads((ROOT / path).read_text(encoding="utf-8"))
        )


def sources(notebook: dict[str, Any]) -> list[str]:
    return ["".join(cell["source"]) for cell in notebook["cells"]]


def test_links_open_what_they_say_and_it_moves(server: Server, browser: Browser) -> None:
    every = bool(os.environ.get("IKTEACH_FULL"))
    for seen in look(browser, server, SHOTS, every):
        print(seen)
        path = seen.link.partition("urlpath=")[2].replace("%2F", "/") or seen.link
        file = ROOT / path.split("/", 2)[2].removeprefix("clone/")
        assert seen.heading == title(file)
        assert seen.memory < MEMORY
    assert (server.home / "clone" / "notebooks").is_dir()
