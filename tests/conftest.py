"""Makes `tests/` and `tests/bench/` places to import from, for every room."""

import sys
from pathlib import Path

from hypothesis import settings

settings.register_profile("ikteach", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ikteach")

HERE = Path(__file__).parent
sys.path += [str(HERE), str(HERE / "bench")]
