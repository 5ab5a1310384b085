"""Names come from files of others: shown as they are, they are never markup, formulas or code."""

import ast
import io
import re
from dataclasses import replace
from functools import partial
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import ipywidgets as widgets
import numpy as np
import pandas as pd
import pytest
from PIL import Image

import ikteach
from ikteach import figures
from ikteach.body.figures import Figure
from ikteach.course.checking import Verdict
from ikteach.course.notice import Notice, paragraph
from ikteach.course.questions import Revealed
from ikteach.course.widget import Question
from ikteach.markup import LONGEST, Markup, as_label, escaped, plain
from ikteach.motion.live.session import Session
from ikteach.solvers import dls
from ikteach.view import ColumnPoser, GaitPlayer, Poser, Scene, StillScene
from ikteach.view.charts import bars, heat, lines, phase_plot
from ikteach.view.tools.inspector import Glass
from ikteach.view.tools.inspector_pages import PAGES
from ikteach.view.tools.recorder import Recorder
from ikteach.view.tools.replay import Replay
from ikteach.view.webgl.targets import Targets
from ikteach.view.widgets.closing import living
from ikteach.view.widgets.prose import Prose, grid, table

PACKAGE = Path(ikteach.__file__).parent
SCRIPT = '<img src=x onerror="window.pwned=1">'
HOSTILE = [
    SCRIPT, "$\\frac{1}{0}$", "_hidden", "a\nb\x00\x1b[31m", "\u202eright to left", "{0.__class__}",
    "&lt;&amp;", "'\"`", "\\(x\\)", "x" * 5000, "</script><script>window.pwned=1</script>", "%s $",
]  # fmt: skip


def hostile(figure: Figure) -> Figure:
    """The figure with a hostile name for each joint and effector."""

    def renamed(names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(HOSTILE[i % len(HOSTILE)] + name for i, name in enumerate(names))

    tree, effectors = figure
    return Figure(
        replace(tree, names=renamed(tree.names)), replace(effectors, names=renamed(effectors.names))
    )


class Tags(HTMLParser):
    """The tags of some HTML, and its text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(html)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.text += data


def harmless(html: str, images: int = 0) -> str:
    """Assert that HTML has no tags but of words and tables; its text."""
    found = Tags(html)
    names = [tag for tag, _ in found.tags]
    assert names.count("img") == images
    assert not {"script", "iframe", "object", "svg", "a"} & set(names)
    assert not [key for _, attributes in found.tags for key in attributes if key.startswith("on")]
    return found.text


def all_of_them() -> list[Any]:
    """Every figure and panel that shows names which may come from a file, with hostile ones."""
    human, arm = hostile(figures.human()), hostile(figures.planar_arm(3))
    methods = {name: partial(dls, damping=0.1) for name in (SCRIPT, "$x$", "_m")}
    session = Session(human, methods=methods, method=SCRIPT)
    for _ in range(3):
        session.tick()
    session.note("remark", words=SCRIPT)
    glass = Glass(session)
    for _ in PAGES:
        glass.look()
        glass.turn(1)
    player = GaitPlayer(methods, method=SCRIPT)
    player.session.tick()
    player.report()
    scene = Scene(*human, names=[SCRIPT, "$"])
    return [
        Poser(human), ColumnPoser(arm), player, glass, scene, Targets(scene, session.targets),
        Replay(session.log()), Recorder(session),
        Question("00.x", str, kind="choice", question=SCRIPT, note=SCRIPT, options=[SCRIPT, "$"]),
    ]  # fmt: skip


@pytest.fixture
def shown() -> Any:
    widgets.Widget.close_all()
    yield all_of_them()
    widgets.Widget.close_all()


@pytest.mark.filterwarnings("ignore:Glyph")
def test_no_string_of_a_living_widget_is_markup_or_a_formula(shown: list[Any]) -> None:
    for one in shown:
        getattr(one, "widget", one)._repr_mimebundle_()
    pages = [widget for widget in living.values() if hasattr(widget, "value")
             and isinstance(widget, widgets.HTML | widgets.HTMLMath | widgets.Label)]  # fmt: skip
    assert len(pages) >= 4
    assert {type(page) for page in pages} == {Prose}
    told = [harmless(page.value, page.value.count('class="ikteach-still"')) for page in pages]
    assert sum(SCRIPT in text for text in told) >= 3  # shown as it is
    assert all(Tags(page.value).tags[0][1] == {"class": "tex2jax_ignore mathjax_ignore"}
               for page in pages if page.value)  # fmt: skip
    labelled = [widget for widget in living.values() if hasattr(widget, "description_allow_html")]
    assert len(labelled) > 40
    for widget in labelled:
        assert not widget.description_allow_html
        assert not re.search(r"[$\\\x00-\x1f\u202e]", widget.description)
        assert len(widget.description) <= LONGEST


@pytest.mark.filterwarnings("ignore:Glyph")
def test_pictures_are_drawn_whatever_things_are_called() -> None:
    frame = pd.DataFrame(np.eye(len(HOSTILE)) + 1, HOSTILE, HOSTILE)
    axes = {"title": "t", "xlabel": "x", "ylabel": "y"}
    counted = frame.set_axis(np.arange(len(HOSTILE)))
    phases = pd.concat({SCRIPT: counted, "_$": counted}, axis=1)
    still = StillScene(*hostile(figures.human()), names=[SCRIPT, "_$x$"])
    still.show(np.tile(figures.human().tree.rest, (2, 1)), np.zeros((2, 4, 3)))
    drawn = [
        heat(frame, title="t", unit="m"), lines(counted, **axes), phase_plot(phases),
        bars(frame, title="t", ylabel="y"),
    ]  # fmt: skip
    for one in drawn:
        harmless(one._repr_html_(), images=1)
    for png in [still.png, *(one.png for one in drawn)]:
        assert max(Image.open(io.BytesIO(png)).size) < 4000


@pytest.mark.parametrize("name", HOSTILE)
def test_html_shows_text_as_it_is(name: str) -> None:
    seen = re.sub("[\x00-\x1f\u202e]+", " ", name)
    assert harmless(escaped(name)) == seen
    assert harmless(Markup("<b>{}</b>").format(name)) == seen
    assert harmless(Markup("<p></p>") + name) == seen
    assert harmless(Markup("<br>").join([name, name])) == seen * 2
    assert escaped(escaped(name)) == escaped(name)
    assert harmless(grid([name], [[name, name]], name)) == seen * 4
    assert harmless(table(pd.DataFrame([[1.0]], [name], [name]), "{:.1f}")).count(plain(name)) == 2
    if "`" not in name:
        assert harmless(paragraph(f"{name} `{name}`")) == f"{seen} {seen}"
    for said in (
        Notice(name), Verdict(name, False, name, name), Revealed(name, [name], name, False, name),
        Question("00.x", str, question=name, note=name, options=[name]),
    ):  # fmt: skip
        html = said._still() if isinstance(said, Question) else said._repr_html_()
        assert seen[:50].replace("`", "") in harmless(html).replace("`", "")


def test_numbers_keep_their_formats_and_labels_their_names() -> None:
    assert Markup("{:.2f} {} {x}").format(1.234, "<", x=Markup("<br>")) == "1.23 &lt; <br>"
    assert [as_label(name) for name in ("elbow.l", "_a", "$a$")] == ["elbow.l", " _a", r"\$a\$"]
    assert plain("elbow.l") == "elbow.l"


def test_html_is_made_in_one_way() -> None:
    """No f-string with a tag, no `innerHTML`, no HTML widget but `Prose`."""
    tag = re.compile(r"</?[a-z]+[\s>/]|&[a-z]+;")
    for path in [*(PACKAGE / "view").rglob("*.py"), *(PACKAGE / "course").rglob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.JoinedStr):
                text = "".join(str(p.value) for p in node.values if isinstance(p, ast.Constant))
                assert not tag.search(text), f"{path.name}:{node.lineno}"
            if isinstance(node, ast.Call):
                made = ast.unparse(node.func)
                assert made not in ("widgets.HTML", "widgets.HTMLMath", "html.escape"), path.name
                assert not made.endswith("to_html") or path.name == "prose.py", path.name
    for path in PACKAGE.rglob("*.js"):
        assert not re.search("innerHTML|outerHTML|insertAdjacentHTML", path.read_text("utf-8"))
