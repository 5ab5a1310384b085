"""Chapter 8's figures: a race of the methods, the runs of an experiment, and their order over λ."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from math import radians
from typing import Any

import ipywidgets as widgets
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from ikteach.markup import Markup, as_label
from ikteach.motion import BUSS_CAPS, Track
from ikteach.motion.gait import Gait, stature
from ikteach.motion.live.session import Session
from ikteach.motion.live.settings import SESSION, check_options
from ikteach.motion.methods import Methods
from ikteach.study.trials import Trials, ranking
from ikteach.view.chapters.gait import session_table
from ikteach.view.charts import MARKS, STYLES
from ikteach.view.live.live import Live
from ikteach.view.live.panel import Does, Panel, button, choice, slider
from ikteach.view.live.strips import SECONDS, Strips
from ikteach.view.stage.colours import effector_colour
from ikteach.view.stage.lengths import Lengths, counted
from ikteach.view.tools.session_panels import WRITTEN, as_set, motions, settle_sliders, takes
from ikteach.view.webgl.scene import Scene
from ikteach.view.widgets import doors
from ikteach.view.widgets.layout import Arranged
from ikteach.view.widgets.picture import Still, png_of
from ikteach.view.widgets.prose import Prose
from ikteach.view.widgets.table import Rows

EQUAL, OWN = "equal caps", "each author's caps"
CAP = (0.5, 180.0)  # from, to [degrees per step]
CHOSEN = ("motion", "limits", "caps")  # the factors of an experiment that buttons choose
LEDGER = ("section", "sentence", "compared by", "verdict", "number", "with the thesis's settings")
SIGNS = {"holds": "✓", "does not": "✗", "depends": "≈"}  # of verdicts
HEADER = ("method", "λ", "mean distance [cm]", "jitter [rad/s²]", "reversals [1/s]")


class Race(Live):
    """Figures that follow the same targets, one per method.

    All follow them at the same moment, each by its own method.

    methods  {name: solver}, or solvers and their names in a list, or one of them alone; the four
             of the course if none are given
    degrees  the step cap of all [degrees per step]
    options  go to `Session`: the figure (a human if none is given), its gait or path, and so on

    Display it in a notebook. `session` holds all state; `values` are those of the controls.
    """

    def __init__(
        self,
        methods: Methods | None = None,
        *,
        degrees: float = 30.0,
        slot: str | None = "race",
        **options: Any,
    ) -> None:
        degrees = doors.within("degrees", degrees, *CAP)
        check_options(options, [*SESSION, "degrees", "slot"])
        session = Session(methods=methods, **options)
        super().__init__(session, _scene(session), slot, Strips(session))
        self._table = Prose()
        sines = isinstance(session.gait, Gait)  # a race of the thesis is run by its own motions
        left_out = WRITTEN if sines else ()
        self._known = {name: m for name, m in motions(session).items() if name not in left_out}
        self.panel = self._panel(degrees)
        self.controls = self.panel.controls
        step, reset = button("Step"), button("Reset")
        step.on_click(self.guarded(lambda _: self.step()))
        reset.on_click(self.guarded(lambda _: session.reset()))
        clock = widgets.HBox([self.play_button, step, reset])
        self.children = [
            Arranged([self.scene.widget, self._table], [clock, self.panel.widget], wide=True),
            self.status,
            self.strips,
        ]
        settle_sliders(self.panel, session)
        self._bound()
        self.report()

    def _panel(self, degrees: float) -> Panel:
        session = self.session
        speed = slider("speed ω [rad/s]", session.gait.speed, 0.0, 20.0, 0.1)
        row = {  # side by side where there is room, so that figures and curves are seen with them
            "caps": Does(choice("caps", [EQUAL, OWN]), self._bound),
            "motion": Does(choice("motion", [*self._known], session.gait.name), self._move),
            "degrees": Does(slider("equal cap [° per step]", degrees, 1.0, 45.0, 0.5), self._bound),
            "speed": Does(speed, lambda speed: session.change(speed=speed)),
        }
        return Panel("Race", [row], guard=self.guarded)

    @property
    def values(self) -> dict[str, Any]:
        """The values of the controls, by name."""
        return self.panel.values

    @property
    def words(self) -> str:
        """The figures, and how far each is from the targets.

        Distances are means over the last seconds.
        """
        session = self.session
        tracks = session.tracks(last=round(SECONDS / session.dt))
        length = Lengths.of(session.tree, session.effectors)
        far = ", ".join(f"{name} {length(run.error.mean())}" for name, run in tracks.items())
        who = self.scene.stage.crowd
        caps = self.values["caps"]
        said = f"{who}, {session.gait.name}, {caps}. Mean distance: {far or 'no tick yet'}."
        return said + counted(session.effectors)

    def draw(self) -> None:
        """Draw the session's state in the scene."""
        session = self.session
        self.scene.show(
            np.array([*session.theta.values()]),
            session.targets,
            floor=session.floor,
            advance=session.advance,
            change=self._changes,
        )

    def report(self) -> None:
        """Bring words and tables up to date."""
        self.scene.driver.description = self.words
        whose = Markup("<p>The curves of each effector are those of {}.</p>").format(
            self.session.method
        )
        self._table.value = session_table(self.session) + whose

    def _move(self, motion: str) -> None:
        self.session.gait = as_set(self._known[motion](), self.session)
        if takes(self.session.gait, "speed"):
            self.panel.put(speed=self.session.gait.speed)
        settle_sliders(self.panel, self.session)

    def _bound(self, _: Any = None) -> None:
        session, values = self.session, self.values
        equal = dict.fromkeys(session.methods, radians(values["degrees"]))
        own = {name: BUSS_CAPS.get(name) for name in session.methods}
        session.bound(own if values["caps"] == OWN else equal)


def _scene(session: Session) -> Scene:
    """Make a scene with a figure per method, side by side."""
    size, count = stature(session.tree, session.effectors), len(session.methods)
    return Scene(
        session.tree,
        session.effectors,
        names=[*session.methods],
        apart=None if size is None else 1.9 * size[0],  # so that running hands do not meet
        width=540 if count == 1 else min(960, 240 * count + 120),
        height=400,
        slot=None,
    )


class TrialsPlayer(Live):
    """The runs of an experiment, to be looked at.

    Controls choose motion, limit rule and caps; a table has a row per method and λ, with the
    measures over all starts. A figure per start pose moves as in the chosen row.

    found  of `study.trials.trials`

    The row is chosen by a click or by the arrow keys.
    """

    def __init__(self, found: Trials, *, slot: str | None = "trials") -> None:
        doors.a(Trials, "found", found)
        self.found, self._runs = found, list[Track]()
        self._keys = {name: list(dict.fromkeys(found.table[name])) for name in CHOSEN}
        first = found.run(0)
        starts = found.table["start"].nunique()
        names = [f"start {i}" for i in range(starts)]
        scene = Scene(first.tree, first.effectors, names=names, width=760, height=300, slot=None)
        super().__init__(_Reel(first), scene, slot)
        self.rows = Rows(label="methods in the chosen condition", header=[*HEADER])
        self.panel = self._panel()
        self.controls = self.panel.controls
        self.rows.observe(self.guarded(lambda _: self._choose()), "chosen")
        self.children = [
            Arranged([self.scene.widget], [self.panel.widget, self.rows], wide=True),
            self.status,
        ]
        self._fill()

    def _panel(self) -> Panel:
        look = {"label_width": "40px", "width": "360px"}
        last = len(self.found.run(0)) - 1
        frame = Does(slider("frame", 0, 0, last, 1, **look), self._go)
        chosen = {
            name: Does(choice(name, options, label_width="auto"), lambda _: self._fill())
            for name, options in self._keys.items()
        }
        step = Does(button("Step"), self.step)
        return Panel(
            "Trials",
            [{"playing": self.play_button, "step": step, "frame": frame}, chosen],
            guard=self.guarded,
        )

    @property
    def words(self) -> str:
        """The chosen row, in words.

        They say how far each figure is from its targets.
        """
        values, run = self.panel.values, self._runs[0]
        method, damping = self.rows.rows[self.rows.chosen][:2]
        length, t = Lengths.of(run.tree, run.effectors), self.session.frame
        far = ", ".join(
            f"start {i} {length(run.error[t].mean())}" for i, run in enumerate(self._runs)
        )
        where = ", ".join(str(values[name]) for name in self._keys)
        return f"{method}, λ {damping}; {where}. At {run.times[t]:.2f} s, mean distance: {far}."

    def draw(self) -> None:
        """Draw a figure per start pose."""
        t, run = self.session.frame, self._runs[0]
        low = min(run.targets[..., 1].min(), run.positions[..., 1].min())
        theta = np.array([run.theta[t] for run in self._runs])
        self.scene.show(theta, run.targets[t], floor=float(low), change=self._changes)

    def report(self) -> None:
        """Bring words and slider up to date."""
        self.scene.driver.description = self.words
        self.panel.put(frame=self.session.frame)

    def _fill(self) -> None:
        """Write the table of the chosen condition."""
        table, values = self.found.table, self.panel.values
        for name in self._keys:
            table = table[table[name] == values[name]]
        self._cells, words = [], []
        for key, cell in table.groupby(["method", "damping"], observed=True, sort=False):
            runs = [self.found.run(row) for row in cell.index]
            free = self.found.at_every_damping(cell.index[0])
            if not free or key[1] == table["damping"].iloc[0]:
                self._cells.append(runs)
                words.append([str(key[0]), "any" if free else f"{key[1]:g}", *_measured(cell)])
        with self.rows.hold_sync():
            self.rows.rows = words
            self.rows.chosen = min(self.rows.chosen, len(words) - 1)
        self._choose()

    def _choose(self) -> None:
        self._runs = self._cells[self.rows.chosen]
        self.report()

    def _go(self, frame: int) -> None:
        self.pause()
        self.session.ticks = frame


class _Reel:
    """The clock of finished runs, which begin again after their end."""

    def __init__(self, run: Track) -> None:
        self.ticks, self._frames = 0, len(run)
        self.dt = float(np.diff(run.times).mean()) if len(run) > 1 else 1 / 30

    @property
    def frame(self) -> int:
        """The frame that is shown."""
        return self.ticks % self._frames

    def tick(self) -> None:
        """Go on to the next frame."""
        self.ticks += 1


def _measured(cell: pd.DataFrame) -> list[str]:
    """Write measures of the starts of a cell: the middle, and from least to most."""
    words = []
    for name, size in (("mean", 100.0), ("acceleration", 1.0), ("reversals", 1.0)):
        low, middle, high = size * cell[name].quantile([0, 0.5, 1])
        words.append(f"{_short(middle)} ({_short(low)} to {_short(high)})")
    return words


def _short(value: float) -> str:
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


@dataclass(frozen=True)
class Ledger:
    """Sentences and their verdicts as a page shows them.

    frame  of `thesis.verdicts`
    """

    frame: pd.DataFrame

    def __str__(self) -> str:
        return str(self.frame.to_string())

    def _repr_html_(self) -> str:
        head = Markup('<th scope="col" style="text-align:left">{}</th>')
        cell = Markup('<td style="text-align:left">{}</td>')
        rows = [_ledger_row(row) for row in self.frame.reset_index().to_dict("records")]
        columns = len(LEDGER) - (not self.frame["own settings"].any())  # the last one is empty
        line, nothing = Markup("<tr>{}</tr>"), Markup()
        body = [line.format(nothing.join(map(cell.format, row[:columns]))) for row in rows]
        return Markup(
            '<table class="ikteach-table"><thead><tr>{}</tr></thead><tbody>{}</tbody></table>'
        ).format(nothing.join(map(head.format, LEDGER[:columns])), nothing.join(body))


def _ledger_row(row: Mapping[Hashable, Any]) -> list[object]:
    """Write a sentence: its verdict with a sign, and what turns it."""
    turned = f": {row['turned by']}" if row["turned by"] else ""
    sign = next(sign for word, sign in SIGNS.items() if row["verdict"].startswith(word))
    cells = "cell" if row["in"].endswith(" 1") else "cells"
    told = Markup("{} <b>{}</b>, in {} {}{}")
    verdict = told.format(sign, row["verdict"], row["in"], cells, turned)
    return [
        row["section"],
        row["says"],
        row["measured by"],
        verdict,
        row["number"],
        row["own settings"],
    ]


def order_chart(
    table: pd.DataFrame, measure: str, *, title: str, ylabel: str, **where: Any
) -> Still:
    """Draw a measure of the methods over λ, a panel per limit rule.

    Lines are medians over the starts, bands go from the least to the most. The chart has the rows
    of `trials` in which the columns `where` have these values.
    """
    for column, value in where.items():
        table = table[table[column] == value]
    rules, methods = list(dict.fromkeys(table["limits"])), list(table["method"].unique())
    figure = Figure(figsize=(8.4, 3.6), dpi=100, layout="constrained")
    panels = figure.subplots(1, len(rules), sharey=True, squeeze=False)[0]
    orders = ranking(table, measure, ["limits", "damping"])["order"]
    words = [
        f"{rule}, λ {damping:g}: {order}"
        for (rule, damping), order in zip(orders.index, orders, strict=True)
    ]
    for axes, rule in zip(panels, rules, strict=True):
        cells = table[table["limits"] == rule].groupby(["method", "damping"], observed=True)
        found = cells[measure].agg(["min", "median", "max"])
        for i, method in enumerate(methods):
            of, look = found.loc[method], MARKS[i % len(MARKS)] + STYLES[i % len(STYLES)]
            colour = effector_colour(i)
            axes.fill_between(of.index, of["min"], of["max"], color=colour, alpha=0.2, lw=0)
            axes.plot(of.index, of["median"], look, color=colour, ms=4, label=as_label(method))
        axes.set(title=f"limits: {as_label(rule)}", xlabel="λ of DLS [m/rad]")
        axes.set(xscale="log", yscale="log")
        axes.set_xticks(found.index.levels[1], [f"{one:g}" for one in found.index.levels[1]])
        axes.minorticks_off()
        axes.grid(alpha=0.3)
    panels[0].set_ylabel(ylabel)
    handles = panels[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower center", ncols=len(methods), fontsize=8)
    figure.suptitle(title, fontsize=11)
    return Still(png_of(figure), f"{title}: {ylabel}, the least first. {'; '.join(words)}.")
