"""The chapters as in a browser: no thread, process or connection is asked for, and no PyAV."""

import json
import os
import subprocess
import sys
from pathlib import Path

LIMITS = Path(__file__).parent / "tools" / "limits.py"
ALL = sorted(path.stem for path in (LIMITS.parents[2] / "notebooks").glob("*.ipynb"))
# The workbench has nearly everything; IKTEACH_FULL=1 runs every chapter.
CHAPTERS = ALL if os.environ.get("IKTEACH_FULL") else ["09_workbench"]
TELLS = "there is no PyAV for the Python that runs in the browser; save the session"


def run(*chapters):
    done = subprocess.run(
        [sys.executable, str(LIMITS), *chapters], capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return [json.loads(line) for line in done.stdout.splitlines()]


def test_chapters_keep_within_what_a_browser_has():
    told = {one["chapter"]: one for one in run(*CHAPTERS)}
    assert list(told) == CHAPTERS
    for name, one in told.items():
        assert one["asked"] == [], f"{name} asks for {one['asked']}"
        # A recorder says what cannot be done, and what can; nothing was played, so to replay fails,
        # and what the workbench has saved is no recording of a person.
        expected = (
            *("there is nothing to replay", "a recording needs 4 frames or more"),
            "needs two points or more",  # a path that nobody has drawn
        )
        others = [said for said in one["wrong"] if not any(words in said for words in expected)]
        assert all(TELLS in words for words in others), others
    workbench = told["09_workbench"]
    assert any(TELLS in words for words in workbench["wrong"])
    assert {"Step", "Reset", "Save the session", "Open and replay"} <= set(workbench["pressed"])


def test_the_limits_bite():
    program = f"""
import socket, subprocess, sys, threading
sys.path.insert(0, {str(LIMITS.parent)!r})
import limits

limits.confine()
for ask in (
    threading.Thread(target=print).start,
    lambda: subprocess.run(["true"]),
    lambda: socket.create_connection(("127.0.0.1", 1)),
):
    try:
        ask()
    except RuntimeError:
        continue
    sys.exit("not refused")
print(limits.asked)
"""
    said = subprocess.check_output([sys.executable, "-c", program], text=True)
    assert said == "['thread', 'process', 'socket']\n"
