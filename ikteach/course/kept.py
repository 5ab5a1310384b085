"""The source of an answer, kept so that it can be judged again.

It is text: a module that ends with `answer = …`, with the imports, the numbers and the functions of
the notebook that the answer uses. Nothing here runs it; whoever does so to judge it again does it
in a process of its own.
"""

import ast
import dis
import hashlib
import inspect
import math
import re
import sys
import textwrap
from collections.abc import Iterator, Mapping
from contextlib import suppress
from types import CodeType, FunctionType, ModuleType
from typing import Any, NamedTuple

import numpy as np

from ikteach.course.forms import type_name
from ikteach.course.record import LONGEST_SOURCE_FIELD

LONGEST_VALUE = 2_000  # letters of a number, text or list that the answer uses
LARGEST_KEPT = 200  # numbers of an array


class Kept(NamedTuple):
    """An answer as text.

    source  a module that binds `answer`, or "" where none can be written
    sha256  of the source
    mark    of what the answer does: comments, blanks and docstrings do not change it
    """

    source: str
    sha256: str
    mark: str


def kept(answer: Any) -> Kept:
    """Write an answer as text; nothing of it is run."""
    try:
        source = _module(answer)
    except Exception:  # whatever an object of the student's raises when it is looked at
        source = ""
    if len(source) > LONGEST_SOURCE_FIELD:
        source = ""
    return Kept(source, _hash(source), _hash(_meaning(source) or _shape(answer))[:16])


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()


def _module(answer: Any) -> str:
    """Write the text, or raise TypeError, OSError or LookupError."""
    parts: dict[str, str] = {}
    _collect("answer", answer, parts)
    return "\n".join(parts.values())


def _collect(name: str, value: Any, parts: dict[str, str]) -> None:
    """Put what binds `name` into the parts, after what it uses itself."""
    if isinstance(value, ModuleType):
        parts[name] = f"import {value.__name__} as {name}\n"
    elif _imported(value):
        parts[name] = f"from {value.__module__} import {value.__qualname__} as {name}\n"
    elif isinstance(function := inspect.unwrap(value), FunctionType):
        parts[name] = ""  # it may call itself
        definition = _definition(name, function)
        for other, one in _used(function, definition):
            if other not in parts:
                try:
                    _collect(other, one, parts)
                except (TypeError, OSError, LookupError):
                    parts[other] = f"# {other}, {type_name(one)}, is the notebook's\n"
        del parts[name]
        parts[name] = definition
    else:
        text = _literal(value)
        if "np." in text:
            parts.setdefault("np", "import numpy as np\n")
        parts[name] = f"{name} = {text}\n"


def _imported(value: Any) -> bool:
    """Whether `from … import …` gives the same thing in another session."""
    module, name = getattr(value, "__module__", None), getattr(value, "__qualname__", "")
    there = sys.modules.get(module) if isinstance(module, str) and module != "__main__" else None
    return there is not None and bool(name) and getattr(there, name, None) is value


def _used(function: FunctionType, definition: str) -> Iterator[tuple[str, Any]]:
    """List what a function uses of the notebook and of what is around it."""
    code, around = function.__code__, function.__closure__ or ()
    for name, cell in zip(code.co_freevars, around, strict=True):
        yield name, cell.cell_contents
    head = ast.parse(definition).body[0]  # its decorators and defaults are run too
    outside = [*getattr(head, "decorator_list", ()), getattr(head, "args", None)]
    names = [
        n.id for one in filter(None, outside) for n in ast.walk(one) if isinstance(n, ast.Name)
    ]
    for name in dict.fromkeys([*names, *_globals(code)]):
        value = function.__globals__.get(name, function)
        if inspect.unwrap(value) is not function:
            yield name, value


def _globals(code: CodeType) -> Iterator[str]:
    for one in dis.get_instructions(code):
        if one.opname in ("LOAD_GLOBAL", "LOAD_NAME"):
            yield one.argval
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _globals(inner)


def _definition(name: str, function: FunctionType) -> str:
    """Find the source of a function, and bind `name` to it."""
    source = textwrap.dedent(inspect.getsource(function))
    if function.__name__ != "<lambda>":
        return source if name == function.__name__ else f"{source}\n{name} = {function.__name__}\n"
    found = list(_lambdas(source[:LONGEST_VALUE]))
    for text in found:
        made = compile(text, "<answer>", "eval").co_consts[0]
        if len(found) == 1 or made.co_code == function.__code__.co_code:
            return f"{name} = {text}\n"
    raise LookupError("no such lambda in its lines")


def _lambdas(lines: str) -> Iterator[str]:
    """Find the lambdas in lines, which may be a part of a statement."""
    for begins in re.finditer(r"\blambda\b", lines):
        for end in range(len(lines), begins.start(), -1):
            with suppress(SyntaxError):
                tree = ast.parse(lines[begins.start() : end], mode="eval")
                if isinstance(tree.body, ast.Lambda):
                    yield ast.unparse(tree)
                    break


def _literal(value: Any) -> str:
    """Write a value as Python reads it; TypeError where this cannot be."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray) and value.size <= LARGEST_KEPT:
        return f"np.array({_literal(value.tolist())})"
    if isinstance(value, Mapping):
        value = {_literal(k): _literal(v) for k, v in value.items()}
        return f"{{{', '.join(f'{k}: {v}' for k, v in value.items())}}}"
    if isinstance(value, list | tuple):
        inner = "".join(f"{_literal(one)}, " for one in value)
        return f"[{inner}]" if isinstance(value, list) else f"({inner})"
    if isinstance(value, FunctionType):  # the name of a method, said by the method
        return repr(value.__name__)
    if isinstance(value, float) and not math.isfinite(value):
        return f"float('{value}')"
    if not (value is None or value is ... or isinstance(value, bool | int | float | str)):
        raise TypeError(type(value))
    text = "..." if value is ... else repr(value)
    if len(text) > LONGEST_VALUE:
        raise TypeError("too long")
    return text


def _meaning(source: str) -> str:
    """Drop comments, blanks and docstrings."""
    if not source:
        return ""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Module) and ast.get_docstring(
            node, clean=False
        ):
            node.body = node.body[1:]
    return ast.dump(tree)


def _shape(answer: Any) -> str:
    """Tell what can be told of an answer without a source."""
    code = getattr(answer, "__code__", None)
    if isinstance(code, CodeType):
        return repr([code.co_code, code.co_names, [str(one) for one in code.co_consts]])
    try:
        return repr(answer)[:LONGEST_VALUE]
    except Exception:
        return str(type(answer))
