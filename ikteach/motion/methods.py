"""The methods of a live figure, however they are given: by name, as functions, one or many."""

from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

from ikteach.checks import shown
from ikteach.motion.checks import solver_of
from ikteach.solvers import Solver, name_of

LONG = 40  # letters of a method's name

Methods: TypeAlias = Mapping[str, Any] | Iterable[Solver | str] | Solver | str


def methods_of(methods: Methods) -> dict[str, Solver]:
    """Give methods their names, {name: solver}.

    They keep the order in which they are given.

    methods  {name: solver or its name}, or solvers and names in a list, or one of them alone

    Of solvers that have the same name, the second is called "name 2", and so on. ValueError if
    there is none, LookupError for an unknown name, TypeError for anything but a solver.
    """
    if isinstance(methods, Mapping):
        pairs = list(methods.items())
    elif isinstance(methods, str) or callable(methods):
        pairs = [("", methods)]
    elif isinstance(methods, Iterable):
        pairs = [("", one) for one in methods]
    else:
        raise TypeError(f"methods are solvers or their names, not {shown(methods)}")
    if not pairs:
        raise ValueError("at least one method is needed")
    named: dict[str, Solver] = {}
    for name, one in pairs:
        if isinstance(methods, Mapping):
            if not (isinstance(name, str) and name.strip() and len(name) <= LONG):
                raise ValueError(f"a method's name has 1 to {LONG} letters; {shown(name)} is none")
        else:
            name = _free(one if isinstance(one, str) else name_of(one), named)
        named[name] = solver_of(one)
    return named


def _free(name: str, taken: Iterable[str]) -> str:
    """Find the name, or with a number behind it the first that is not taken."""
    name, number = name[: LONG - 3], 1
    numbered = name
    while numbered in taken:
        number += 1
        numbered = f"{name} {number}"
    return numbered
