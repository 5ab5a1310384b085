"""Scripts and styles of widgets, read from the files beside them.

A widget's module comes to the page as one text and cannot fetch a neighbour. So the modules that
it imports are put before it, each in a scope of its own.
"""

import re
from functools import cache
from pathlib import Path

from ikteach.markup import Markup

PACKAGE = Path(__file__).parents[2]
SHARED = ("view/widgets/page.css", "view/widgets/reachable.css")
COMMENT = re.compile(r"^ *(?:/\*\*[\s\S]*?\*/|//.*)\n", re.MULTILINE)  # on lines of its own
NAMES = r"\{\s*\w+(?:,\s*\w+)*,?\s*\}"
IMPORT = re.compile(rf'^import ({NAMES}) from "(\.\.?/[\w./]+\.js)";$', re.MULTILINE)
EXPORT = re.compile(r"^export (?=(?:async function|function|class|const) (\w+))", re.MULTILINE)
DEFAULT = re.compile(r"^export default ", re.MULTILINE)
FOREIGN = re.compile(r"^\s*(?:import|export)\b.*|.*\bimport[(.].*", re.MULTILINE)


@cache
def script(path: str) -> str:
    """Join a module of the package and all that it imports.

    path  from the package's folder, "view/webgl/driver.js"; its default export is that of the text

    ValueError if a module imports in a circle, or imports or exports in another way than
    `import { name } from "./file.js";` and `export` before function, class, const or default.
    """
    scopes: dict[Path, str] = {}
    main = _gather((PACKAGE / path).resolve(), scopes, ())
    return "\n".join([*scopes.values(), f"export default {main}.main;\n"])


@cache
def style(*paths: str) -> str:
    """Read style sheets of the package.

    Those that all widgets share come first.
    """
    return "".join((PACKAGE / path).read_text("utf-8") for path in (*SHARED, *paths))


def style_tag(path: str) -> Markup:
    """Read a style sheet of the package as HTML.

    For pages without our scripts.
    """
    return Markup("<style>\n{}</style>").format(Markup((PACKAGE / path).read_text("utf-8")))


def _gather(path: Path, scopes: dict[Path, str], above: tuple[Path, ...]) -> str:
    """Add a module to the scopes, behind those that it imports; return its name."""
    if path in above:
        circle = " > ".join(one.name for one in (*above, path))
        raise ValueError(f"modules import each other in a circle: {circle}")
    name = re.sub(r"\W", "_", path.relative_to(PACKAGE).as_posix())
    if path not in scopes:
        scopes[path] = _scope(name, path, scopes, (*above, path))
    return name


def _scope(name: str, path: Path, scopes: dict[Path, str], above: tuple[Path, ...]) -> str:
    """Write a module as a constant, the object of its exports."""
    source = COMMENT.sub("", path.read_text("utf-8"))
    exported = EXPORT.findall(source)

    def named(found: re.Match[str]) -> str:
        names, where = found.groups()
        return f"const {names} = {_gather((path.parent / where).resolve(), scopes, above)};"

    text = EXPORT.sub("", IMPORT.sub(named, source))
    if DEFAULT.search(text):
        text, exported = DEFAULT.sub("const main = ", text, count=1), [*exported, "main"]
    if foreign := FOREIGN.search(text):
        raise ValueError(f"{path.name} cannot be joined: {foreign[0].strip()}")
    return f"const {name} = (() => {{\n{text}return {{ {', '.join(exported)} }};\n}})();\n"
