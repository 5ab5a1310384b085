"""What to try with a live figure: sentences, each with a button that does it."""

from collections.abc import Mapping, Set
from functools import partial
from typing import TYPE_CHECKING, Any

from ikteach.checks import shown
from ikteach.names import unknown
from ikteach.view.live.controls import controls, targets

if TYPE_CHECKING:
    from ikteach.course.buttons import Tries

Setting = Mapping[str, Any]


def show_me(figure: Any, tries: Mapping[str, Setting]) -> "Tries":
    """Put a button beside each sentence that sets the figure so.

    What other sentences set is put back to how it is now, so that any order shows the same.

    figure  a live one, of this or an earlier cell
    tries   {sentence: {name of a control: its value}}, in the order in which they are set; for a
            button the value is how often it is pressed, for a target where it goes [m]
    LookupError for a control that the figure does not have.
    """
    from ikteach.course.buttons import Tries

    for setting in tries.values():
        known(figure, setting)
    before = now(figure, {name for setting in tries.values() for name in setting})

    def whole(setting: Setting) -> Setting:
        return {name: before[name] for name in before if name not in setting} | dict(setting)

    return Tries(figure, {words: partial(put, figure, whole(tries[words])) for words in tries})


def now(figure: Any, names: Set[str]) -> Setting:
    """Return the values of those controls and targets.

    Buttons have none.
    """
    of_figure, places = controls(figure), targets(figure)
    values = {name: of_figure[name] for name in of_figure if name in names - {*places}}
    before = {name: one.value for name, one in values.items() if not hasattr(one, "click")}
    return before | {
        name: figure.targets.positions[i].copy() for i, name in enumerate(places) if name in names
    }


def known(figure: Any, setting: Setting) -> None:
    """Check that the figure has these controls."""
    if not isinstance(setting, Mapping):
        raise TypeError(f"a setting is {{control: value}}, not {shown(setting)}")
    for name in setting:
        if name not in (names := [*controls(figure), *targets(figure)]):
            raise LookupError(unknown("control", name, names))


def put(figure: Any, setting: Setting) -> None:
    """Set the controls of a live figure, as a person would."""
    known(figure, setting)
    of_figure, places = controls(figure), targets(figure)
    for name, value in setting.items():
        if name in places:
            figure.targets.move(places.index(name), value)
        elif hasattr(of_figure[name], "click"):
            for _ in range(value):
                of_figure[name].click()
        else:
            of_figure[name].value = value
