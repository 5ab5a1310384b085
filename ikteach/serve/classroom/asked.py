"""What the notebooks ask: predictions and exercises, read from their cells without running any."""

import ast
from pathlib import Path
from typing import Any, NamedTuple

from ikteach.files import read_json

LARGEST_NOTEBOOK = 20 * 2**20  # bytes
HARMLESS = (  # what may stand in a value that is worked out here: nothing that calls or imports
    *(ast.Expression, ast.Constant, ast.List, ast.Tuple, ast.Dict, ast.Name, ast.Load, ast.Store),
    *(ast.JoinedStr, ast.FormattedValue, ast.ListComp, ast.comprehension, ast.UnaryOp, ast.USub),
    *(ast.Starred, ast.BinOp, ast.Add),
)


class Prediction(NamedTuple):
    """A prediction that a notebook asks for.

    options  to choose from, or to put in order
    numbers  low, high and unit of a number
    """

    question: str
    options: tuple[str, ...] = ()
    numbers: tuple[float, float, str] | None = None
    ranking: bool = False


class Asked(NamedTuple):
    """What notebooks ask for.

    predictions  {key: prediction}
    exercises    the keys of what is checked
    """

    predictions: dict[str, Prediction]
    exercises: set[str]


def asked_in(folder: Path) -> Asked:
    """Find what the notebooks in a folder ask for.

    A cell that cannot be read so is passed over: its answers are then counted without its words.
    """
    found = Asked({}, set())
    for path in sorted(folder.glob("*.ipynb")):
        try:
            cells = read_json(path, LARGEST_NOTEBOOK)["cells"]
            code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        except (OSError, ValueError, TypeError, LookupError):
            continue
        names: dict[str, Any] = {}
        for source in code:
            _find(source, names, found)
    return found


def _find(source: str, names: dict[str, Any], found: Asked) -> None:
    """Find what a cell asks for; `names` are those that cells have bound so far."""
    try:
        tree = ast.parse(source)
    except (SyntaxError, ValueError):
        return
    for node in tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                try:
                    names[name] = _value(value, names)
                except (ValueError, TypeError):
                    names.pop(name, None)
        for call in ast.walk(node):
            match call:
                case ast.Call(func=ast.Name(id="predict")):
                    try:
                        key, prediction = _prediction(call, names)
                        found.predictions[key] = prediction
                    except (ValueError, TypeError, LookupError):
                        continue
                case ast.Call(func=ast.Name(id="check"), args=[ast.Constant(value=str(key)), *_]):
                    found.exercises.add(key)


def _prediction(call: ast.Call, names: dict[str, Any]) -> tuple[str, Prediction]:
    given = dict(zip(("key", "question", "options"), call.args, strict=False))
    given |= {one.arg: one.value for one in call.keywords if one.arg}
    value = {name: _value(given[name], names) for name in given if name != "explain"}
    numbers = value.get("numbers")
    options = tuple(str(one) for one in value.get("options", ()))
    ranking = bool(value.get("ranking", False))
    limits = (float(numbers[0]), float(numbers[1]), str(numbers[2])) if numbers else None
    return str(value["key"]), Prediction(str(value["question"]), options, limits, ranking)


def _value(node: ast.expr, names: dict[str, Any]) -> Any:
    """Work out a value that is made of constants and names; ValueError of another."""
    inner = {n.target.id for n in ast.walk(node) if isinstance(n, ast.comprehension)
             and isinstance(n.target, ast.Name)}  # fmt: skip
    for one in ast.walk(node):
        bound = not isinstance(one, ast.Name) or one.id in names or one.id in inner
        if not (isinstance(one, HARMLESS) and bound):
            raise ValueError("it is more than constants and names")
    code = compile(ast.Expression(node), "<question>", "eval")
    return eval(code, {"__builtins__": {}, **names})
