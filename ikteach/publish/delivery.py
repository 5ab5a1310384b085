"""The course's notebooks: where they are, what they are called, and a copy for the student.

One rule governs the copy: a file that the student has changed is never overwritten. The folder
therefore keeps a manifest, which holds the SHA-256 of each file as it was last delivered.
"""

import errno
import hashlib
import json
from pathlib import Path, PurePosixPath
from typing import Literal, NamedTuple

from ikteach.files import read_json, write_whole

PACKAGE = Path(__file__).resolve().parents[1]
MANIFEST = ".ikteach.json"
LARGEST_NOTEBOOK = 100 * 2**20  # bytes of a notebook, outputs and all

Outcome = Literal["copied", "restored", "updated", "current", "kept"]
Manifest = dict[str, str]


class CourseFolder(NamedTuple):
    """A folder of notebooks; in a clone one works directly."""

    notebooks: Path
    clone: bool


class Delivery(NamedTuple):
    """Outcome for a file; `beside` names its newer version."""

    name: str
    outcome: Outcome
    beside: str = ""


def find_course() -> CourseFolder:
    """Return the course: of the clone, or in the wheel."""
    clone = PACKAGE.parent
    if (clone / "pyproject.toml").is_file() and (clone / "notebooks").is_dir():
        return CourseFolder(clone / "notebooks", clone=True)
    return CourseFolder(PACKAGE / "notebooks", clone=False)


def course_files(notebooks: Path) -> list[str]:
    """List the course's files, without hidden ones and answers."""
    files = (path.relative_to(notebooks) for path in notebooks.rglob("*") if path.is_file())
    hidden = (".", "__pycache__", "predictions.")
    return sorted(
        file.as_posix() for file in files if not any(p.startswith(hidden) for p in file.parts)
    )


def chapters(notebooks: Path) -> dict[str, str]:
    """List the chapters in order: file name -> title.

    What has no number, such as the prerequisites, comes before them.
    """
    names = [name for name in course_files(notebooks) if PurePosixPath(name).match("*.ipynb")]
    names.sort(key=lambda name: name[0].isdigit())
    return {name: title(notebooks / name) for name in names if "/" not in name}


def title(notebook: Path) -> str:
    """Return the title of a notebook.

    The first `# ` heading of its first markdown cell; empty where there is none.
    """
    try:
        cells = read_json(notebook, LARGEST_NOTEBOOK)["cells"]
        prose = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown"]
    except (OSError, ValueError, KeyError, TypeError):
        return "(not a readable notebook)"
    lines = prose[0].splitlines() if prose else []
    return next((line[2:].strip() for line in lines if line.startswith("# ")), "")


def decide(ours: str, theirs: str | None, delivered: str | None) -> Outcome:
    """Choose the action for a file, from hashes.

    Of ours now, of the student's, and of ours of the last time. None stands for no file, and for
    never delivered.
    """
    if theirs is None:
        return "copied" if delivered is None else "restored"
    if theirs == ours:
        return "current"
    return "updated" if theirs == delivered else "kept"


def deliver(notebooks: Path, folder: Path) -> list[Delivery]:
    """Copy the course into `folder`, losing nothing of the student's."""
    if folder.exists() and not folder.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "It is a file, not a folder", str(folder))
    names = course_files(notebooks)
    folder.mkdir(parents=True, exist_ok=True)
    before = read_manifest(folder)
    manifest = dict(before)
    deliveries: list[Delivery] = []
    for name in names:
        deliveries += _deliver_file(folder, name, (notebooks / name).read_bytes(), manifest)
        if manifest != before:  # at each file: what comes may be the end of us
            _write(folder / MANIFEST, json.dumps(manifest, indent=1, sort_keys=True).encode())
            before = dict(manifest)
    return deliveries


def report(deliveries: list[Delivery], folder: Path) -> list[str]:
    """Report the outcome: new files counted, others named."""
    new = [delivery.name for delivery in deliveries if delivery.outcome == "copied"]
    count = sum(name.endswith(".ipynb") for name in new)
    others = f", other files: {len(new) - count}" if len(new) > count else ""
    what = f"{count} notebook{'s' * (count != 1)}" if count else f"{len(new)} files"
    sentences = [f"copied {what} to {folder}{others if count else ''}"] if new else []
    for name, outcome, beside in deliveries:
        newer = f"; the newer version is beside it: {beside}" if beside else ""
        words = {"restored": "restored", "updated": "updated", "kept": "kept yours"}
        if outcome in words:
            sentences.append(f"{words[outcome]}: {name}{newer}")
    return sentences or [f"nothing new for {folder}"]


def _deliver_file(folder: Path, name: str, data: bytes, manifest: Manifest) -> list[Delivery]:
    """Deliver one file; where the student's is kept, a version they do not have goes beside it."""
    outcome = _put(folder, name, data, manifest)
    if outcome != "kept" or manifest.get(name) == _digest(data):
        return [Delivery(name, outcome)]
    path = PurePosixPath(name)
    beside = str(path.with_name(f"{path.stem}.new{path.suffix}"))
    if _put(folder, beside, data, manifest) == "kept":
        return [Delivery(name, "kept"), Delivery(beside, "kept")]
    manifest[name] = _digest(data)
    return [Delivery(name, "kept", beside)]


def _put(folder: Path, name: str, data: bytes, manifest: Manifest) -> Outcome:
    """Write one file unless that would lose a change; note in the manifest what is now there."""
    path = folder / name
    theirs = _digest(path.read_bytes()) if path.exists() else None
    outcome = decide(_digest(data), theirs, manifest.get(name))
    if outcome in ("copied", "restored", "updated"):
        _write(path, data)
    if outcome != "kept":
        manifest[name] = _digest(data)
    return outcome


def read_manifest(folder: Path) -> Manifest:
    """Read {name: SHA-256} as last delivered; empty if damaged."""
    try:
        manifest = read_json(folder / MANIFEST, LARGEST_NOTEBOOK)
        return {name: digest for name, digest in manifest.items() if isinstance(digest, str)}
    except (FileNotFoundError, ValueError, AttributeError):
        return {}  # then every file that differs counts as the student's, and is kept


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _write(path: Path, data: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, data, overwrite=True)
