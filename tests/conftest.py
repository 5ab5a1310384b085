"""Makes `tests/` and `tests/bench/` places to import from, for every room."""

import os
import sys
from pathlib import Path

from hypothesis import settings

# IKTEACH_FULL=1 in the environment tries more examples, and runs every tracking run to its end.
EXAMPLES = 100 if os.environ.get("IKTEACH_FULL") else 40
settings.register_profile(
    "ikteach", deadline=None, derandomize=True, print_blob=True, max_examples=EXAMPLES
)
settings.load_profile("ikteach")

HERE = Path(__file__).parent
sys.path += [str(HERE), str(HERE / "bench")]
