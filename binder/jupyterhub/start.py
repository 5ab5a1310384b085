"""Bring a student's copy of the course up to date, then be their server. Runs as the student."""

import os
import sys
import tempfile
from pathlib import Path

from jupyterhub.singleuser import main

from ikteach.publish.delivery import deliver, find_course, report

FOLDER = Path.home() / "ikteach-course"

os.umask(0o077)  # what a student answers is for no other student to read
try:
    course = find_course()
    print(*report(deliver(course.notebooks, FOLDER), FOLDER), sep="\n", flush=True)
    FOLDER.chmod(0o700)  # what was there before, too
except OSError as error:  # a full disk, for instance: what the student has can still be opened
    print(f"The course could not be brought up to date: {error}", file=sys.stderr, flush=True)

# Kernels are spoken to by sockets that are files: in a folder for this student alone, whose path is
# short enough (107 characters, the socket's own name included) however long that of a home is.
with tempfile.TemporaryDirectory(prefix="jupyter-") as runtime:
    os.environ["JUPYTER_RUNTIME_DIR"] = runtime
    main()
