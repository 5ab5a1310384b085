"""Slides of a chapter: one page of HTML that asks nothing of a network, made of its notebook.

In the notebook's order: what is asked, a picture of each live figure with links that open it in the
states to try, the formulas, what is to be read critically, exercises, exit questions. What else
the chapter says, and what only who teaches should read, is in the notes.
"""

import re
from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

from ikteach.markup import Markup
from ikteach.publish.pack.html import as_list, in_line, inlined, rendered
from ikteach.publish.pack.links import lecture_page, link
from ikteach.publish.pack.parts import Chapter, Computed, Exit, Open, Posed, Stub, Told, ToTry
from ikteach.publish.pack.plan import Block, plan
from ikteach.publish.pack.stills import still
from ikteach.publish.pack.teaching import Teaching

LOOKS = Path(__file__).parent / "slides"  # and what a file is: html, css or js
WORDS = 80  # on a slide, about: a longer text goes on on the next
WIDE = 1.4  # a picture wider than this has more of the slide
FORMULA = re.compile(r"\$\$.+?\$\$", re.DOTALL)
PUNCH = re.compile(r"\*\*([^*]{15,}[.?!])\*\*")
BUTTONS = (
    "\n\nThe links open the notebook; there run this cell, and press *Show me* and the number."
)
CRITICAL = "> **Read critically.**"
SENTENCE = re.compile(r"(?<=[.?!:])\s+(?=[A-Z$])")


class Slide(NamedTuple):
    """One slide.

    kind   "title", "goals", "ask" … : how it looks, and the line over its title
    cell   of the notebook, of which it is made
    """

    kind: str
    title: Markup
    body: Markup
    notes: Markup
    cell: str = "title"


KINDS = {
    "ask": "Predict, before anything runs",
    "reveal": "Run the cell, and compare",
    "live": "Try",
    "formula": "",
    "critical": "Read critically",
    "punch": "",
    "task": "Exercise",
    "quiz": "Exit question",
    "open": "On paper, in pairs",
}


class Deck:
    """The slides of a chapter, with its notes for who teaches."""

    def __init__(self, chapter: Chapter, told: Teaching) -> None:
        self.chapter, self._told = chapter, told
        self._blocks: dict[str, Block] = {}
        for block in plan(chapter):
            self._blocks |= dict.fromkeys(block.cells, block)
        self._heading, self._demo = chapter.title, told.demos.get(chapter.number)
        self._before = ""  # the text right before a part
        self.slides = [*self._opening()]
        for part in chapter.parts:
            if isinstance(part, Told):
                self._prose(part)
                self._before = part.text
            else:
                self.slides += self._made(part)

    @property
    def page(self) -> str:
        """The whole page of HTML."""
        script = Markup("<script>{}</script>").format(_own("js"))
        style = Markup("<style>{}</style>").format(_own("css"))
        slides = Markup("\n").join(
            _section(i, slide, self.chapter.title) for i, slide in enumerate(self.slides, 1)
        )
        page = _own("html")
        return page.format(title=self.chapter.title, style=style, script=script, slides=slides)

    def _opening(self) -> Iterator[Slide]:
        chapter = self.chapter
        source = chapter.first.split("\n\n")[1].strip("* \n")
        goals = as_list(in_line(goal) for goal in chapter.goals)
        clock = f"{chapter.minutes} minutes, if all is done in class."
        yield Slide("title", in_line(chapter.title), rendered(source), rendered(clock))
        until = "What everybody can do when through" if chapter.number.isdigit() else "Goals"
        yield Slide("goals", Markup(until), goals, self._notes("title"))

    def _prose(self, part: Told) -> None:
        """Slides of what a text shows; the rest of it goes into the notes."""
        notes = self._notes(part.cell, part.text)
        self._heading = part.heading or self._heading
        made: list[Slide] = []
        for paragraph in part.text.split("\n\n"):
            if paragraph.startswith(CRITICAL):
                text = paragraph.replace("\n> ", "\n").removeprefix(CRITICAL)
                made += self._pages("critical", self._heading, text, notes, part.cell)
        if formulas := FORMULA.findall(part.text):
            led = "\n\n".join(_led(part.text, formula) for formula in formulas)
            made += self._pages("formula", self._heading, led, notes, part.cell)
        elif found := [one for one in PUNCH.findall(part.text) if "Read critically" not in one]:
            body = Markup().join(rendered(one[0].upper() + one[1:]) for one in found)
            made.append(Slide("punch", in_line(self._heading), body, notes, part.cell))
        if made:
            self.slides += made
        else:
            last = self.slides[-1]
            self.slides[-1] = last._replace(notes=last.notes + notes)

    def _made(self, part: Posed | Computed | ToTry | Stub | Exit | Open) -> Iterator[Slide]:
        match part:
            case Posed():
                yield self._asked(part)
            case Computed():
                yield self._shown(part)
            case ToTry():
                yield self._live(part)
            case Exit():
                yield self._quiz(part)
            case Stub():
                if all(slide.cell != part.cell for slide in self.slides):
                    note = f'The check is `check("{part.key}", {part.name})`.'
                    yield from self._text(
                        "task", part.text, self._notes(part.cell, note), part.cell
                    )
            case Open():
                note = f"**Answers.** {part.answer}"
                yield from self._text("open", part.text, self._notes(part.cell, note), part.cell)

    def _asked(self, part: Posed) -> Slide:
        note = f"All lock in an answer, then go on. It is computed in the cell `{part.revealed}`."
        if belief := self._told.beliefs.get(part.key):
            note += f"\n\n**Wrong belief:** {belief.belief}. **Students say:** “{belief.says}”"
        notes = self._notes(part.cell, note)
        body = rendered(_situation(self._before)) + _choices(part)
        return Slide("ask", in_line(part.question), body, notes, part.cell)

    def _shown(self, part: Computed) -> Slide:
        asked = {one.key: one for one in self.chapter.of(Posed)}
        told = [self._told.beliefs[key] for key in part.keys if key in self._told.beliefs]
        notes = self._notes(part.cell, "\n\n".join(f"**{b.belief}?** {b.answer}" for b in told))
        rows = as_list(in_line(asked[key].question) for key in part.keys)
        cell = Markup("<p>The cell <code>{}</code> computes it. What had you said?</p>").format(
            part.cell
        )
        return Slide("reveal", in_line(self._heading), cell + rows, notes, part.cell)

    def _live(self, part: ToTry) -> Slide:
        figure, tries = part.make()
        first = next(iter(tries.values()))
        picture = still(figure, first)
        figure.close()
        links = as_list(
            (
                link(figure, self.chapter.file, setting, in_line(words))
                for words, setting in tries.items()
            ),
            "ol",
        )
        image = Markup('<figure><img src="{}" alt="{}"></figure>').format(
            inlined(picture.png), picture.alt
        )
        buttons = "" if lecture_page(type(figure).__name__) else BUTTONS
        notes = self._notes(part.cell, f"The picture is of the first. {picture.alt}{buttons}")
        if self._demo is not None:
            ask, do, seen, finds = self._demo
            told = (
                f"**Ask** {ask} **Do** {do}. **To be seen:** {seen}. **The class finds:** {finds}."
            )
            notes, self._demo = notes + rendered(told), None
        kind = "live wide" if _ratio(picture.png) > WIDE else "live"
        return Slide(kind, in_line(self._heading), image + links, notes, part.cell)

    def _quiz(self, part: Exit) -> Slide:
        quiz = part.quiz
        why = quiz.why if isinstance(quiz.why, str) else quiz.why[quiz.right]
        notes = self._notes(part.cell, f"**{quiz.right}.** {why}")
        if not isinstance(quiz.why, str):
            others = (f"*{one}*: {said}" for one, said in quiz.why.items() if one != quiz.right)
            notes += rendered("\n\n".join(others))
        body = as_list(map(in_line, quiz.choices), "ol")
        return Slide("quiz", in_line(quiz.question), body, notes, part.cell)

    def _text(self, kind: str, text: str, notes: Markup, cell: str) -> Iterator[Slide]:
        """Slides of all that a cell says under its last heading."""
        *before, told = re.split(r"^#+ (.+)\n", text, flags=re.MULTILINE)
        self._heading = before[-1] if before else self._heading
        yield from self._pages(kind, self._heading, told.partition("**Read on:**")[0], notes, cell)

    def _pages(self, kind: str, title: str, text: str, notes: Markup, cell: str) -> Iterator[Slide]:
        for i, one in enumerate(_chunks(text)):
            more = (
                Markup("{} <small>(goes on)</small>").format(in_line(title))
                if i
                else in_line(title)
            )
            yield Slide(kind, more, rendered(one, self.chapter.path.parent), notes, cell)

    def _notes(self, cell: str, text: str = "") -> Markup:
        """Make the notes of a slide: when, who, and a text."""
        block = self._blocks[cell]
        where = "At home" if block.home else "In class"
        clock = f"{where}, minutes {block.begin} to {block.begin + block.minutes}, {block.who}. "
        return rendered(f"*{clock}Cell `{cell}`.*\n\n{text}", self.chapter.path.parent)


def _own(kind: str) -> Markup:
    """Read the script or the style of all slides."""
    return Markup(LOOKS.with_suffix(f".{kind}").read_text("utf-8"))


def _section(number: int, slide: Slide, chapter: str) -> Markup:
    kind = slide.kind.split()[0]
    head = Markup('<p class="kind">{}</p>').format(KINDS[kind]) if KINDS.get(kind) else Markup()
    rank = Markup("h1" if kind == "title" else "h2")
    return Markup(
        '<section class="slide {kind}" aria-label="slide {number}">{head}<{rank}>{title}</{rank}>'
        '<div class="body">{body}</div><p class="foot">{chapter} · {number}</p></section>'
        '<aside class="notes" aria-label="notes of slide {number}">{notes}</aside>'
    ).format(
        kind=slide.kind,
        number=number,
        head=head,
        rank=rank,
        title=slide.title,
        body=slide.body,
        chapter=in_line(chapter),
        notes=slide.notes,
    )


def _choices(part: Posed) -> Markup:
    if part.numbers:
        low, high, unit = part.numbers
        return Markup("<p>A number from {:g} to {:g}{}.</p>").format(
            low, high, f" {unit}" if unit else ""
        )
    options = as_list(map(in_line, part.choices), "ol")
    return Markup("<p>Put them in order:</p>") + options if part.ranking else options


def _situation(text: str) -> str:
    """Take from the text before a question what it is about: plain paragraphs, not too many."""
    plain = [
        paragraph
        for paragraph in text.split("\n\n")
        if paragraph.strip() and paragraph[0] not in "#*|>-![" and "$$" not in paragraph
    ]
    whole = "\n\n".join(plain)
    return whole if len(whole.split()) <= WORDS else plain[-1]


def _led(text: str, formula: str) -> str:
    """Put a formula between what leads to it and what ends its sentence."""
    before, _, after = text.partition(formula)
    lead = SENTENCE.split(
        re.sub(r"^#.*\n", "", before, flags=re.MULTILINE).strip().split("\n\n")[-1]
    )[-1]
    tail = (
        re.split(r"\n\n|(?<=\.)\s", after.strip(), maxsplit=1)[0]
        if after.startswith(("\n\nw", ","))
        else ""
    )
    return f"{lead}\n\n{formula}\n\n{tail}".strip()


def _chunks(text: str) -> Iterator[str]:
    """Cut a text into parts of so many words, between paragraphs or entries of a list."""
    blocks = [one for one in re.split(r"\n\n|\n(?=- )", text.strip()) if one.strip()]
    part: list[str] = []
    for block in blocks:
        if part and len(" ".join([*part, block]).split()) > WORDS and not block.startswith("$$"):
            yield _joined(part)
            part = []
        part.append(block)
    if part:
        yield _joined(part)


def _joined(blocks: Iterable[str]) -> str:
    """Blocks of Markdown; entries of a list stay one list."""
    groups = groupby(blocks, key=lambda block: block.startswith("- "))
    return "\n\n".join(("\n" if entries else "\n\n").join(group) for entries, group in groups)


def _ratio(png: bytes) -> float:
    """Width by height of a PNG, from its head."""
    return int.from_bytes(png[16:20], "big") / int.from_bytes(png[20:24], "big")
