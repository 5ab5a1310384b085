"""The instructor's pack: made of the course, whole, in step with it, and kept from students."""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import nbformat
import pytest

from ikteach import __main__ as cli
from ikteach.course import tries
from ikteach.publish import builds
from ikteach.publish.delivery import chapters
from ikteach.publish.pack import goals, plan, teaching
from ikteach.publish.pack.bank import families
from ikteach.publish.pack.links import lecture_page, query
from ikteach.publish.pack.parts import Chapter, Exit, Open, Posed, Stub, ToTry
from ikteach.publish.pack.projects import projects
from ikteach.publish.pack.slides import Deck
from ikteach.publish.pack.syllabus import syllabi
from ikteach.view import GaitPlayer, Simulator, WalksPlayer, Workbench
from ikteach.view.chapters.comparison import Race
from ikteach.view.chapters.robots import robot_player
from tests.browser.conftest import open_browser
from tests.publish.gift import read

ROOT = Path(__file__).parents[2]
NOTEBOOKS = ROOT / "notebooks"
COURSE = [Chapter(NOTEBOOKS / name) for name in chapters(NOTEBOOKS)]
TOLD = teaching.teaching(ROOT)
TAGS = re.compile(r"<math.*?</math>|<[^>]+>", re.DOTALL)


@pytest.fixture(scope="module")
def pack(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The whole pack, made once by its command."""
    folder = tmp_path_factory.mktemp("pack")
    assert cli.main(["build", "pack", str(folder)]) == 0
    return folder


@pytest.fixture(scope="module")
def decks(pack: Path) -> dict[str, str]:
    return {c.number: (pack / f"slides/{c.path.stem}.html").read_text("utf-8") for c in COURSE}


def words(html: str) -> str:
    import html as escapes

    return " ".join(escapes.unescape(TAGS.sub(" ", html)).split())


def pieces(answer: str) -> list[str]:
    """Long pieces of an answer in which nothing is marked up."""
    return [piece.strip() for piece in re.findall(r"(?:[^\W_]|[ ,'])" + "{40,}", answer)]


def plain(markdown: str) -> str:
    """The words of Markdown without formulas, as they are shown."""
    return " ".join(re.sub(r"\$.*?\$|[*`_]", " ", markdown).split())


def test_every_goal_is_measured_and_every_measure_has_a_goal() -> None:
    found = goals.mapped(COURSE, TOLD.beliefs, projects())
    assert (found.strange, found.unused, found.reworded) == ([], [], [])
    assert len(found.goals) == sum(len(chapter.goals) for chapter in COURSE) > 50
    assert [one.goal for one in found.goals if not one.measured] == []
    beliefs = {belief for one in found.goals for belief in one.beliefs}
    assert beliefs == {one.belief for one in TOLD.beliefs.values()}


def test_a_hole_in_the_map_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    table = teaching.data("objectives")
    first, second, *_ = table["05"]
    table["05"][second] = ["05.nothing"]
    table["05"]["say it otherwise"] = table["05"].pop(first)
    monkeypatch.setattr(goals, "data", lambda _: table)
    found = goals.mapped(COURSE, TOLD.beliefs, projects())
    assert found.strange == ["05.nothing"]
    assert set(found.unused) >= {"05.bound", "05.svd", "bank 05.bound"}
    assert sorted(found.reworded) == sorted(["05: say it otherwise", f"05: {first}"])
    assert [one.measured for one in found.goals if one.goal == second] == [False]


@pytest.mark.parametrize("chapter", COURSE, ids=lambda chapter: chapter.number)
def test_the_minutes_of_a_plan_are_those_of_the_chapter(chapter: Chapter, pack: Path) -> None:
    blocks = plan.plan(chapter)
    assert sum(block.minutes for block in blocks) == chapter.minutes
    assert plan.in_class(blocks) + plan.at_home(blocks) == chapter.minutes
    assert min(block.minutes for block in blocks) >= 1
    for home in (False, True):
        row = [block for block in blocks if block.home is home]
        assert [one.begin for one in row] == [
            sum(one.minutes for one in row[:i]) for i in range(len(row))
        ]
    cells = {cell for block in blocks for cell in block.cells}
    assert cells == {"title", *(part.cell for part in chapter.parts)}
    said = f"{plan.in_class(blocks)} in class + {plan.at_home(blocks)} at home = {chapter.minutes}"
    assert said in (pack / "plans.html").read_text("utf-8")


def test_minutes_are_shared_whole() -> None:
    assert plan.shared(10, [1, 1, 1]) == [4, 3, 3]
    assert plan.shared(3, [100, 1, 1]) == [1, 1, 1]
    assert sum(plan.shared(61, [0.1, 7, 3.3, 2])) == 61


@pytest.mark.parametrize("chapter", COURSE, ids=lambda chapter: chapter.number)
def test_slides_say_what_the_notebook_says(chapter: Chapter, decks: dict[str, str]) -> None:
    page = decks[chapter.number]
    slides = "".join(re.findall(r"<section.*?</section>", page, re.DOTALL))
    shown = words(slides)
    wanted = [chapter.title, *chapter.goals]
    for part in chapter.of(Posed):
        wanted += [part.question, *part.choices]
    for part in chapter.of(Exit):
        wanted += [part.quiz.question, *part.quiz.choices]
    for text in wanted:
        for piece in re.split(r"\$[^$]*\$|[*`]+", text):
            assert " ".join(piece.split()) in shown, (text, piece)
    for part in [*chapter.of(Stub), *chapter.of(Open)]:
        told = re.split(r"^#+ .+\n", part.text, flags=re.MULTILINE)[-1]
        told = re.sub(r"!\[.*?\]", " ", told)  # words of a picture
        for piece in pieces(told.partition("**Read on:**")[0].replace("\n", " ")):
            assert piece in shown, part.cell
    texts = [cell.source for cell in chapter.cells if cell.cell_type == "markdown"]
    formulas = sum(text.count("$$") // 2 for text in texts)
    assert slides.count('display="block"') == formulas
    critical = sum("**Read critically.**" in text for text in texts)
    assert slides.count('class="slide critical"') >= critical


@pytest.mark.parametrize("chapter", COURSE, ids=lambda chapter: chapter.number)
def test_answers_are_in_the_notes_alone(chapter: Chapter, decks: dict[str, str]) -> None:
    page = decks[chapter.number]
    slides = words("".join(re.findall(r"<section.*?</section>", page, re.DOTALL)))
    notes = words("".join(re.findall(r"<aside.*?</aside>", page, re.DOTALL)))
    for part in chapter.of(Open):
        for piece in pieces(part.answer):
            assert piece in notes
            assert piece not in slides
    for key in {part.key for part in chapter.of(Posed)} & set(TOLD.beliefs):
        belief = TOLD.beliefs[key]
        for said in (belief.says, belief.answer):
            assert said in notes
            assert said not in slides


def test_a_question_stands_below_what_it_is_about(decks: dict[str, str]) -> None:
    begins = {
        "00": "An arm lies in a plane.",
        "02": "An arm of two links is stretched out",
        "12": "A shoulder has three hinges in one place",
    }
    for number, said in begins.items():
        asked = re.findall(r'<section class="slide ask".*?</section>', decks[number], re.DOTALL)
        assert said in words(asked[0])


def test_slides_have_pictures_and_ask_nothing_of_a_network(decks: dict[str, str]) -> None:
    for chapter in COURSE:
        page = decks[chapter.number]
        pictures = re.findall(r'<img src="([^"]+)" alt="([^"]+)"', page)
        assert len(re.findall(r'class="slide live', page)) == len(chapter.of(ToTry))
        assert len(pictures) >= len(chapter.of(ToTry))
        assert all(place.startswith("data:image/") and len(alt) > 40 for place, alt in pictures)
        assert not re.search(r'<(?:script|link|iframe|img)[^>]*(?:src|href)="(?!data:)', page)
        assert not re.search(r"@import|url\(", page)


def links(page: str) -> Iterator[tuple[str, str]]:
    for server, place in re.findall(r'<a data-at="(\w+)" data-to="([^"]+)"', page):
        yield server, place.replace("&amp;", "&")


def test_links_open_figures_in_states_that_they_have(decks: dict[str, str]) -> None:
    figures = {
        "gait": GaitPlayer(slot="gait page"),
        "race": Race(slot="race page"),
        "simulator": Simulator(slot="simulator page"),
        "robot": robot_player(slot="robot page"),
        "walks": WalksPlayer(slot="walks page"),
        "workbench": Workbench(slot="workbench page"),
    }
    assert set(figures) == {p.stem for p in (ROOT / "ikteach/serve/lecture/pages").glob("*.ipynb")}
    opened = set()
    for chapter in COURSE:
        for server, place in links(decks[chapter.number]):
            path, state = urlsplit(place).path, dict(parse_qsl(urlsplit(place).query))
            if server == "lab":
                assert path == f"lab/tree/{chapter.file}"
                continue
            name = path.removeprefix("voila/render/").removesuffix(".ipynb")
            assert state
            tries.known(figures[name], state)  # LookupError for a control of another figure
            opened.add(name)
    assert opened == set(figures) - {"robot"}  # chapter 12 has two figures of its class
    for figure in figures.values():
        figure.close()


def test_a_state_is_written_as_an_address() -> None:
    state = {"method": "cramer, mended", "forward": True, "cursor": [0.3, -0.2, 0.3], "speed": 9}
    assert query(state) == "method=cramer,%20mended&forward=on&cursor=0.3,-0.2,0.3&speed=9"
    assert lecture_page("GaitPlayer") == "gait.ipynb"
    assert lecture_page("Workbench") == "workbench.ipynb"
    assert [lecture_page(kind) for kind in ("SvdBench", "Bench", "Player")] == [None] * 3


def test_a_changed_notebook_changes_its_slides(tmp_path: Path) -> None:
    book = nbformat.read(NOTEBOOKS / "02_singularity.ipynb", as_version=4)
    for cell in book.cells:
        cell.source = cell.source.replace("which methods move", "what moves")
        cell.source = cell.source.replace("Which methods move the arm at all?", "What moves now?")
        cell.source = cell.source.replace("no test", "no test at all")
    figures = [c for c in book.cells if "show_me(" in c.source]
    book.cells = [cell for cell in book.cells if cell not in figures]
    nbformat.write(book, tmp_path / "02_singularity.ipynb")
    page = Deck(Chapter(tmp_path / "02_singularity.ipynb"), TOLD).page
    assert "What moves now?" in page
    assert "no test at all" in page
    assert "Which methods move the arm at all?" not in page


def test_the_same_course_makes_the_same_slides(decks: dict[str, str]) -> None:
    assert Deck(Chapter(NOTEBOOKS / "12_robots.ipynb"), TOLD).page == decks["12"]


def test_each_wrong_belief_has_what_is_said_and_what_to_answer(pack: Path) -> None:
    said = teaching.data("misconceptions")
    assert set(said) == set(TOLD.beliefs)
    page = words((pack / "misconceptions.html").read_text("utf-8"))
    for one in TOLD.beliefs.values():
        assert len(one.answer) > 100
        for text in (plain(one.belief), one.says, one.answer, one.cell):
            assert " ".join(text.split()) in page
    assert set(TOLD.demos) == {chapter.number for chapter in COURSE} - {"prerequisites"}


def test_syllabi_sum_what_chapters_say(pack: Path) -> None:
    page = (pack / "syllabi.html").read_text("utf-8")
    table = teaching.data("syllabi")
    minutes = {chapter.number: chapter.minutes for chapter in COURSE}
    for one, raw, count in zip(syllabi(COURSE), table.values(), (6, 12), strict=True):
        assert [week.number for week in one.weeks] == list(range(1, count + 1))
        taken = [chapter.number for week in one.weeks for chapter in week.chapters]
        assert len(set(taken)) == len(taken)
        assert set(taken) >= {c.number for c in COURSE} - ({"11", "12"} if count == 6 else set())
        own = sum(
            week.get("class_minutes", 0) + week.get("home_minutes", 0) for week in raw["week"]
        )
        whole = [sum(getattr(week, name) for week in one.weeks) for name in ("in_class", "at_home")]
        assert sum(whole) == own + sum(minutes[number] for number in taken)
        assert f"<td>all</td><td></td><td>{whole[0]}</td><td>{whole[1]}</td>" in page
        keys = {task.key for c in COURSE if c.number in taken for task in c.of(Stub)}
        assert {key for week in one.weeks for key in week.hand_in} == keys


@pytest.mark.parametrize("project", projects(), ids=lambda project: project.stem)
def test_a_project_is_whole_and_its_first_cell_runs(project: Any, pack: Path) -> None:
    for heading in ("Brief", "What you hand in", "Milestones", "What counts as done"):
        assert f"\n## {heading}\n" in project.text
    assert re.findall(r"^\| (\d) \|", project.text, re.MULTILINE) == ["1", "2", "3", "4"]
    levels = project.text.partition("## Levels of its own")[2]
    rows = [line.count("|") for line in levels.splitlines() if line.startswith("|")]
    assert rows == [6] * 4
    told, start = nbformat.read(pack / f"projects/{project.stem}.ipynb", as_version=4).cells
    assert told.source.startswith(project.text)
    assert "Levels of every project" in told.source
    said: list[object] = []
    names: dict[str, Any] = {"display": said.append, "print": lambda *words: said.append(words)}
    exec(start.source, names)
    assert said


def test_the_rubric_has_four_levels() -> None:
    table = teaching.data("rubric")
    assert len(table["levels"]) == 4
    assert all(len(row["seen"]) == 4 for row in table["row"])
    assert len(table["row"]) == 5


def test_the_key_is_in_no_build_for_students(pack: Path, tmp_path: Path) -> None:
    secret = [builds.open_answers(chapter.number) for chapter in COURSE]
    answers = [text for chapter in secret for text in chapter.values()]
    assert len(answers) >= 10
    assert all(map(pieces, answers))
    told = {piece for text in answers for piece in pieces(text)}
    for build in ("student", "nbgrader", "otter"):
        builds.BUILDS[build](NOTEBOOKS, tmp_path / build)
    handed = [*tmp_path.rglob("*.ipynb"), *(pack / "projects").iterdir()]
    assert len(handed) > 40
    for path in handed:
        text = path.read_text("utf-8")
        assert not [piece for piece in told if piece in text], path
    key = words((pack / "key.html").read_text("utf-8"))
    assert not [piece for piece in told if piece not in key]
    left_out = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    left_out = left_out["tool"]["hatch"]["build"]["targets"]["wheel"]["exclude"]
    assert {"/ikteach/course/solutions", "/ikteach/publish/pack/texts"} <= set(left_out)


def test_the_bank_of_the_pack_can_be_read(pack: Path) -> None:
    found = read((pack / "ikteach.gift.txt").read_text("utf-8"))
    assert {one.category.split("/")[2] for one in found} >= set(families())
    page = words((pack / "bank.html").read_text("utf-8"))
    assert all(name in page for name in families())


def test_pages_lead_to_pages_that_are_there(pack: Path) -> None:
    for page in pack.glob("*.html"):
        for place in re.findall(r'href="([^"#]+)"', page.read_text("utf-8")):
            assert place.startswith("https://pypi.org") or (pack / place).is_file(), place


def test_without_a_clone_it_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "notebooks").mkdir()
    with pytest.raises(LookupError, match="made in a clone"):
        builds.pack(tmp_path / "notebooks", tmp_path / "out")
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_markdown_cell("# 1 · No time")])
    nbformat.write(book, tmp_path / "01_a.ipynb")
    with pytest.raises(LookupError, match=r"01_a\.ipynb does not say .* how long"):
        plan.plan(Chapter(tmp_path / "01_a.ipynb"))


def test_every_state_to_try_is_one_that_the_figure_has() -> None:
    """A figure is enough here; that all can be set is tests/course/test_tries.py's."""
    (part,) = Chapter(NOTEBOOKS / "07_gait.ipynb").of(ToTry)
    figure, states = part.make()
    for state in states.values():
        tries.known(figure, state)
    figure.close()


@pytest.fixture
def browser_alone() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = open_browser(play)
        yield browser
        browser.close()


SMALLEST = 1 / 28  # of a slide's height, the letters that the last row reads
FAULTS = """least => slides.flatMap((slide, i) => {
  go(i);
  const body = slide.querySelector(".body"), box = slide.getBoundingClientRect();
  const size = parseFloat(getComputedStyle(body).fontSize) / box.height;
  const over = body.scrollHeight > body.clientHeight + 1 || body.scrollWidth > body.clientWidth + 1
    || slide.scrollHeight > slide.clientHeight + 1;
  return over || size < least ? [[i + 1, size, over]] : [];
})"""


def test_slides_fit_are_turned_by_keys_and_printed(pack: Path, browser_alone: Any) -> None:
    page, asked, errors = browser_alone.new_page(), [], []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: errors.append(str(error)))
    for width, height, shown in ((1280, 720, COURSE), (1920, 1080, COURSE[::5])):
        page.set_viewport_size({"width": width, "height": height})
        for chapter in shown:
            page.goto((pack / f"slides/{chapter.path.stem}.html").as_uri())
            assert page.evaluate(FAULTS, SMALLEST) == [], chapter.file
    page.goto((pack / "slides/07_gait.html").as_uri())
    count = page.locator(".slide").count()
    seen = page.locator(".slide.here")
    for key, number in (("ArrowRight", 2), ("End", count), ("PageUp", count - 1), ("Home", 1)):
        page.keyboard.press(key)
        assert seen.get_attribute("aria-label") == f"slide {number}"
    page.get_by_role("button", name="next slide").press("Enter")
    assert seen.get_attribute("aria-label") == "slide 2"
    page.keyboard.press("n")
    assert page.locator(".notes:visible").count() == 1
    page.keyboard.press("n")
    with page.expect_popup() as opened:
        page.keyboard.press("s")
    page.keyboard.press("ArrowRight")
    assert "locks in an answer" in opened.value.locator("body").inner_text()
    page.keyboard.press("?")
    field = page.locator("input[name=lecture]")
    field.fill("http://127.0.0.1:9999/?token=secret")
    field.press("Tab")
    page.keyboard.press("Escape")
    link = page.locator('a[data-at="lecture"]').first.get_attribute("href")
    assert link.startswith("http://127.0.0.1:9999/voila/render/gait.ipynb?motion=walking&")
    pdf = page.pdf(prefer_css_page_size=True, print_background=True)
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) == count
    assert errors == []
    assert all(url.startswith(("file:", "data:", "about:")) for url in asked)
