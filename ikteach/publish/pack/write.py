"""The pack's files, written into a folder."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from ikteach.markup import Markup
from ikteach.publish.delivery import chapters as titles
from ikteach.publish.pack.bank import VARIANTS, draw_variants, families, gift
from ikteach.publish.pack.bank.letters import letters
from ikteach.publish.pack.goals import LETTERS, mapped
from ikteach.publish.pack.html import as_list, as_table, in_line, rendered
from ikteach.publish.pack.parts import Chapter, Exit, Open
from ikteach.publish.pack.plan import at_home, in_class, plan
from ikteach.publish.pack.projects import EVERY, Project, notebook, projects, rubric
from ikteach.publish.pack.slides import Deck
from ikteach.publish.pack.syllabus import Syllabus, syllabi
from ikteach.publish.pack.teaching import TEXTS, Teaching, teaching
from ikteach.publish.pages import document

BANK = "ikteach.gift.txt"


def write_pack(notebooks: Path, folder: Path) -> None:
    """Write the pack of the clone that has these notebooks.

    LookupError where it is not whole, as in an installed package.
    """
    if not (TEXTS.is_dir() and (notebooks.parent / "TEACHING.md").is_file()):
        raise LookupError(
            "The pack is made in a clone; its texts are not in the installed package."
        )
    told = teaching(notebooks.parent)
    chapters = [Chapter(notebooks / name) for name in titles(notebooks)]
    tasks = projects()
    for chapter in chapters:
        place = folder / "slides" / f"{chapter.path.stem}.html"
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(Deck(chapter, told).page, "utf-8")
    pages = {
        "plans": ("Plans by minutes", _plans(chapters)),
        "map": ("Goals, and what measures them", _map(chapters, told, tasks)),
        "misconceptions": (
            "What students say, and what to answer",
            _misconceptions(chapters, told),
        ),
        "key": ("Key to exit questions and open questions", _key(chapters)),
        "syllabi": ("Syllabi of 6 and of 12 weeks", _syllabi(syllabi(chapters))),
        "rubric": ("Projects, and what they are judged by", _rubric(tasks)),
        "bank": ("The question bank", _bank()),
        "index": ("The instructor's pack", _index(chapters)),
    }
    for name, (title, body) in pages.items():
        (folder / f"{name}.html").write_text(_page(title, body, home=name == "index"), "utf-8")
    (folder / BANK).write_text(bank(chapters), "utf-8")
    _hand_out(tasks, folder / "projects")


def bank(chapters: Sequence[Chapter]) -> str:
    """Write all questions as GIFT: by chapter, then by family."""
    return "\n\n".join(_entries(chapters)) + "\n"


def _entries(chapters: Sequence[Chapter]) -> Iterator[str]:
    yield "// Made by `python -m ikteach build pack`. Import it as GIFT, in UTF-8."
    for chapter in chapters:
        path = ("ikteach", chapter.title)
        for name in families():
            if name.partition(".")[0] == chapter.number:
                yield gift.in_category(*path, name)
                yield from (
                    gift.numeric_question(f"{name} {i:02}", one)
                    for i, one in enumerate(draw_variants(name), 1)
                )
        if chapter.number == LETTERS.partition(".")[0]:
            yield gift.in_category(*path, LETTERS)
            yield from letters(chapter, LETTERS)
        if found := chapter.of(Exit):
            yield gift.in_category(*path, f"{chapter.number} exit questions")
            yield from (gift.choice_question(f"quiz {part.key}", part.quiz) for part in found)


def _hand_out(tasks: Sequence[Project], folder: Path) -> None:
    import nbformat

    folder.mkdir()
    for project in tasks:
        nbformat.write(notebook(project), folder / f"{project.stem}.ipynb")


def _page(title: str, body: Markup, *, home: bool) -> str:
    back = Markup() if home else Markup('<nav><a href="index.html">The pack</a></nav>')
    whole = Markup("{}<main><h1>{}</h1>{}</main>").format(back, title, body)
    return document(title, WIDE + whole)


# The tables here are of words, not of numbers, and need the page's width.
WIDE = Markup(
    "<style>body{max-width:76rem}td,th{text-align:left;vertical-align:top}"
    "@media print{body{font-size:11pt;max-width:none}tr{break-inside:avoid}}</style>"
)


def _plans(chapters: Sequence[Chapter]) -> Markup:
    parts = [rendered((TEXTS / "plans.md").read_text("utf-8"))]
    for chapter in chapters:
        blocks = plan(chapter)
        rows = [
            (
                "home" if block.home else "class",
                f"{block.begin}–{block.begin + block.minutes}",
                block.minutes,
                in_line(block.what),
                block.who,
            )
            for block in blocks
        ]
        sums = (
            f"{in_class(blocks)} in class + {at_home(blocks)} at home = {chapter.minutes} minutes"
        )
        parts.append(Markup("<h2>{}</h2>").format(in_line(chapter.title)))
        parts.append(as_table(["where", "from – to", "minutes", "what", "who"], rows, sums))
    return Markup("\n").join(parts)


def _map(chapters: Sequence[Chapter], told: Teaching, tasks: Sequence[Project]) -> Markup:
    heads = [
        "goal",
        "predictions",
        "exercises",
        "exit",
        "open",
        "bank",
        "projects",
        "wrong beliefs",
    ]
    found, parts = mapped(chapters, told.beliefs, tasks), []
    for chapter in chapters:
        rows = [
            [in_line(one.goal), *(as_list(map(in_line, cell)) if cell else "" for cell in one[2:])]
            for one in found.goals
            if one.chapter == chapter.number
        ]
        parts.append(Markup("<h2>{}</h2>{}").format(in_line(chapter.title), as_table(heads, rows)))
    return Markup("\n").join(parts)


def _misconceptions(chapters: Sequence[Chapter], told: Teaching) -> Markup:
    files = {chapter.number: chapter.file for chapter in chapters}
    rows = [
        (
            in_line(one.belief),
            f"“{one.says}”",
            one.answer,
            Markup("<code>{}</code>, in <code>{}</code>").format(
                one.cell, files[one.key.partition(".")[0]]
            ),
            Markup("<code>{}</code>").format(one.key),
        )
        for one in told.beliefs.values()
    ]
    heads = ["wrong belief", "students say", "answer", "the cell that shows it", "prediction"]
    return as_table(heads, rows)


def _key(chapters: Sequence[Chapter]) -> Markup:
    parts = [rendered((TEXTS / "key.md").read_text("utf-8"))]
    for chapter in chapters:
        parts.append(Markup("<h2>{}</h2>").format(in_line(chapter.title)))
        for part in chapter.parts:
            if isinstance(part, Exit):
                quiz = part.quiz
                why = quiz.why if isinstance(quiz.why, str) else quiz.why[quiz.right]
                parts.append(rendered(f"**{quiz.question}** {quiz.right}. {why}"))
            if isinstance(part, Open):
                parts.append(rendered(f"{_asked(part.text)}\n\n**Answer.** {part.answer}"))
    return Markup("\n").join(parts)


def _asked(text: str) -> str:
    """Quote what an open question asks."""
    told = text.partition("**Read on:**")[0].replace("## Exit questions", "").strip()
    return "\n".join(f"> {line}" for line in told.splitlines())


def _syllabi(found: Sequence[Syllabus]) -> Markup:
    heads = [
        "week",
        "chapters",
        "minutes in class",
        "at home",
        "hand in",
        "quiz from the bank",
        "project",
    ]
    parts = []
    for one in found:
        rows = [
            (
                week.number,
                as_list(in_line(chapter.title) for chapter in week.chapters)
                if week.chapters
                else "",
                week.in_class,
                week.at_home,
                ", ".join(week.hand_in),
                ", ".join(week.quizzes),
                week.project,
            )
            for week in one.weeks
        ]
        sums = [sum(getattr(week, name) for week in one.weeks) for name in ("in_class", "at_home")]
        whole = ("all", "", *sums, "", "", "")
        parts += [Markup("<h2>{}</h2><p>{}</p>").format(one.title, one.about)]
        parts += [as_table(heads, [*rows, whole])]
    return Markup("\n").join(parts)


def _rubric(tasks: Sequence[Project]) -> Markup:
    parts = [rendered(f"{(TEXTS / 'rubric.md').read_text('utf-8')}\n\n{EVERY}\n\n{rubric()}")]
    for project in tasks:
        text = project.text.replace("\n## ", "\n### ").replace("# ", "## ", 1)
        parts.append(rendered(text))
    return Markup("\n").join(parts)


def _bank() -> Markup:
    rows = []
    for name in families():
        one = draw_variants(name, 1)[0]
        wrong = as_list(
            Markup("{:.4g}: {}").format(value, said) for said, value in one.wrong.items()
        )
        answer = f"{one.answer:.4g} {one.unit}"
        rows.append((Markup("<code>{}</code>").format(name), one.text, answer, one.why, wrong))
    text = (TEXTS / "bank.md").read_text("utf-8").replace("{variants}", str(VARIANTS))
    heads = ["family", "one of its questions", "answer", "why", "wrong values, and what is said"]
    return rendered(text.replace("{bank}", BANK)) + as_table(heads, rows)


def _index(chapters: Sequence[Chapter]) -> Markup:
    links = as_list(
        Markup('<a href="slides/{}.html">{}</a>, {} minutes').format(
            chapter.path.stem, in_line(chapter.title), chapter.minutes
        )
        for chapter in chapters
    )
    text = (TEXTS / "index.md").read_text("utf-8").replace("{bank}", BANK)
    return rendered(text) + Markup("<h2>Slides</h2>") + links
