"""Take a solution apart: mutants, each of which differs from it in one place.

    python -m tests.course.mutation 02.classify     what was tried, and what became of it

A mutant whose answers are those of the solution on every input drawn (`tests.course.draws`) is the
same answer in other words. Every other one must be refused, with a sentence.
"""

import ast
import copy
import importlib
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ikteach.course import checking
from ikteach.publish import builds
from tests.course import draws

SOLUTIONS = Path(checking.__file__).parent / "solutions"
DRAWN = 60  # inputs on which a mutant is compared
ROUNDING = 1e-6  # what answers may differ by, of their size
NOTHING = 1e-4  # of the smallest argument: an answer that should be 0 is rounding alone

OPERATORS: dict[type, list[type]] = {
    ast.Add: [ast.Sub],
    ast.Sub: [ast.Add],
    ast.Mult: [ast.Div, ast.Add],
    ast.Div: [ast.Mult],
    ast.Pow: [ast.Mult],
    ast.MatMult: [ast.Mult],
}
COMPARISONS: dict[type, list[type]] = {
    ast.Lt: [ast.LtE, ast.Gt],
    ast.LtE: [ast.Lt, ast.GtE],
    ast.Gt: [ast.GtE, ast.Lt],
    ast.GtE: [ast.Gt, ast.LtE],
    ast.Eq: [ast.NotEq],
    ast.NotEq: [ast.Eq],
}
OTHER = {  # what one easily writes in place of another
    "sin": "cos",
    "cos": "sin",
    "arcsin": "arctan",
    "arctan2": "hypot",
    "min": "max",
    "max": "min",
    "minimum": "maximum",
    "sum": "mean",
    "mean": "median",
    "idxmin": "idxmax",
    "any": "all",
    "cumsum": "cumprod",
    "hypot": "arctan2",
    "norm": "max",
    "error": "jitter",
    "jitter": "error",
    "prod": "sum",
    "pinv": "transpose",
    "unique": "sort",
    "running": "walking",
    "radians": "degrees",
}


class Mutant(NamedTuple):
    """One of them: what was done to which line, and its source."""

    done: str
    source: str


def mutants(source: str) -> Iterator[Mutant]:
    """Every mutant of a solution."""
    tree = ast.parse(source)
    known = {source}
    functions = [n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef | ast.Lambda)]
    arguments = [a.arg for f in functions for a in f.args.args]
    texts = {n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and _text(n)}
    for place, node in enumerate(ast.walk(tree)):
        for done, new in changes(node, arguments, sorted(texts)):
            other = copy.deepcopy(tree)
            made = ast.unparse(ast.fix_missing_locations(_with(other, place, new)))
            if made not in known:
                known.add(made)
                line = ast.unparse(node).partition("\n")[0]
                yield Mutant(f"{done}: {line}", made)


def _text(node: ast.Constant) -> bool:
    return isinstance(node.value, str) and 0 < len(node.value) < 20


def _with(tree: ast.Module, place: int, new: Any) -> ast.Module:
    """The tree with another node at that place of the walk."""
    old = list(ast.walk(tree))[place]

    class Put(ast.NodeTransformer):
        def visit(self, node: ast.AST) -> Any:
            return new if node is old else self.generic_visit(node)

    return Put().visit(tree)


def changes(node: Any, arguments: list[str], texts: list[str]) -> Iterator[tuple[str, Any]]:
    """What may stand in the place of a node."""
    match node:
        case ast.Constant(value=bool()):
            yield "turned", ast.Constant(not node.value)
        case ast.Constant(value=int() | float()):
            yield "doubled", ast.Constant(2 * node.value)
            yield "halved", ast.Constant(node.value / 2 if node.value % 2 else node.value // 2)
            yield "zeroed", ast.Constant(0)
            yield "negated", ast.UnaryOp(ast.USub(), node)
            yield "one more", ast.Constant(node.value + 1)
        case ast.Constant(value=str()) if _text(node):
            for text in texts:
                yield f"made {text!r}", ast.Constant(text)
        case ast.Name(id=name) if name in arguments and isinstance(node.ctx, ast.Load):
            for other in arguments:
                yield f"read {other}", ast.Name(other, ast.Load())
            yield "ignored", ast.parse(f"np.ones_like({name})", mode="eval").body
        case ast.Attribute(attr=name):
            yield "dropped", node.value
            if name in OTHER:
                yield f"made {OTHER[name]}", ast.Attribute(node.value, OTHER[name], node.ctx)
        case ast.Call():
            yield from _calls(node)
        case ast.BinOp():
            yield "left alone", node.left
            yield "right alone", node.right
            yield "turned round", ast.BinOp(node.right, node.op, node.left)
            for other in OPERATORS.get(type(node.op), ()):
                yield other.__name__, ast.BinOp(node.left, other(), node.right)
        case ast.UnaryOp():
            yield "dropped", node.operand
        case ast.Compare():
            for i, op in enumerate(node.ops):
                for other in COMPARISONS.get(type(op), ()):
                    ops = [*node.ops[:i], other(), *node.ops[i + 1 :]]
                    yield other.__name__, ast.Compare(node.left, ops, node.comparators)
        case ast.If():
            yield "never", ast.If(ast.Constant(False), node.body, node.orelse)
            yield "always", ast.If(ast.Constant(True), node.body, node.orelse)
        case ast.IfExp():
            yield "always", node.body
            yield "never", node.orelse
        case ast.Return(value=value) if value is not None and not isinstance(value, ast.Constant):
            yield "negated", ast.Return(ast.UnaryOp(ast.USub(), value))
            yield "doubled", ast.Return(ast.BinOp(ast.Constant(2), ast.Mult(), value))
        case ast.Expr() | ast.AugAssign():
            yield "left out", ast.Pass()


def _calls(node: ast.Call) -> Iterator[tuple[str, Any]]:
    for argument in node.args[:1]:
        yield "its first argument", argument
    if len(node.args) == 2:
        yield "arguments turned round", ast.Call(node.func, node.args[::-1], node.keywords)
    if len(node.args) > 1:
        yield "last argument dropped", ast.Call(node.func, node.args[:-1], node.keywords)
    for i, keyword in enumerate(node.keywords):
        others = [*node.keywords[:i], *node.keywords[i + 1 :]]
        yield f"without {keyword.arg}", ast.Call(node.func, node.args, others)
    if isinstance(node.func, ast.Attribute) and not isinstance(node.func.value, ast.Attribute):
        yield "not called", node.func.value


def bound(key: str, source: str) -> Any:
    """What the last statement of a solution binds."""
    chapter = (SOLUTIONS / f"ch{key.partition('.')[0]}.py").read_text(encoding="utf-8")
    names: dict[str, Any] = {}
    exec(compile(f"{chapter.partition('# %%')[0]}\n{source}", "<mutant>", "exec"), names)
    match ast.parse(source).body[-1]:
        case ast.FunctionDef(name=name) | ast.Assign(targets=[ast.Name(id=name)]):
            return names[name]
    raise LookupError(f"the last statement of the solution of {key!r} binds no answer")


def outcome(key: str, answer: Any, given: Any) -> Any:
    """What an answer makes of an input, or the kind of its error."""
    if not callable(answer):
        return answer
    try:
        with np.errstate(all="ignore"):
            result = draws.read(key, answer(*copy.deepcopy(given)))
    except Exception as error:
        return ValueError if isinstance(error, ValueError) else "error"
    return result


def alike(one: Any, other: Any, given: Any = ()) -> bool:
    """Whether two outcomes of an input are the same but for rounding."""
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, str | type | dict) or isinstance(other, str | type | dict):
        return type(one) is type(other) and one == other
    try:
        one, other = np.asarray(one, float), np.asarray(other, float)
    except (TypeError, ValueError):
        return False
    if one.shape != other.shape:
        return False
    sizes = [np.max(np.abs(x)) for x in given if isinstance(x, float | np.ndarray)]
    size = max(abs(one).max(initial=0), NOTHING * min(sizes, default=0))
    return np.allclose(one, other, rtol=0, atol=ROUNDING * size, equal_nan=True)


class Report(NamedTuple):
    """What became of the mutants of one solution.

    counts  of those refused, those with the same answers, and those right in another way
    passed  those that pass and should not
    mute    those refused without a sentence of the check's own
    """

    key: str
    counts: Counter[str]
    passed: list[str]
    mute: list[str]

    def __str__(self) -> str:
        told = ", ".join(f"{n} {what}" for what, n in sorted(self.counts.items()))
        return f"{self.key:15} {told}" + "".join(f"\n    PASSES: {m}" for m in self.passed)


def tried(key: str, most: int | None = None, source: str = "") -> Report:
    """Try the mutants of a solution, or a sample of them."""
    source = source or builds.solution(key)
    every = list(mutants(source))
    if most is not None and len(every) > most:
        chosen = np.random.default_rng(1).choice(len(every), most, replace=False)
        every = [every[i] for i in sorted(chosen)]
    rng = np.random.default_rng(0)
    given = [draws.DRAWS[key](rng) for _ in range(DRAWN)] if key in draws.DRAWS else [()]
    right = bound(key, source)
    wanted = [outcome(key, right, one) for one in given]
    task, report = checking.find(key), Report(key, Counter(), [], [])
    for mutant in every:
        try:
            answer = bound(key, mutant.source)
        except Exception:  # a value that cannot even be made
            report.counts["without an answer"] += 1
            continue
        if all(alike(w, outcome(key, answer, g), g) for w, g in zip(wanted, given, strict=True)):
            report.counts["the same in other words"] += 1
            continue
        verdict = checking.judge(task, answer)
        if not verdict.passed:
            report.counts["refused"] += 1
            if "check itself failed" in verdict.sentence:
                report.mute.append(f"{mutant.done}: {verdict.sentence}")
        elif key in draws.RIGHT and draws.RIGHT[key](answer):
            report.counts["right in another way"] += 1
        else:
            report.passed.append(f"{mutant.done} -> {mutant.source}")
    return report


def main(keys: list[str]) -> None:
    """Print what was tried."""
    for path in sorted((Path(checking.__file__).parent / "exercises").glob("ch*.py")):
        importlib.import_module(f"ikteach.course.exercises.{path.stem}")
    for key in keys or sorted(checking.EXERCISES):
        report = tried(key)
        print(report, *(f"\n    MUTE: {one}" for one in report.mute), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
