"""Where figures stand at every width and zoom: nothing on a picture, nothing cut, nothing lost.

Each figure is made once, in one page that takes one size after another.
"""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import nbformat
import pytest
from playwright.sync_api import Browser, CDPSession, Page

from tests.browser.conftest import DRIVER, READY, SHOTS, Lab, Notebook, open_page

SCENE, CHART = f"{DRIVER}[data-frame]", ".ikteach-picture[src]"
FIGURES = {
    "00": ("from ikteach.view.chapters.figure import Poser as Made", "figures.human()", SCENE),
    "01": (
        "from ikteach.view.chapters.jacobian import ColumnPoser as Made",
        "figures.human()",
        SCENE,
    ),
    "02": ("from ikteach.view.chapters.singularity import BendBench as Made", "", SCENE),
    "03": ("from ikteach.view.chapters.transpose import slope_bench as Made", "", CHART),
    "04": ("from ikteach.view.chapters.pseudoinverse import CapPlayer as Made", "", SCENE),
    "05": ("from ikteach.view.chapters.dls import tradeoff_bench as Made", "", CHART),
    "06": ("from ikteach.view.chapters.sdls import spectrum_bench as Made", "", CHART),
    "07": ("from ikteach.view import GaitPlayer as Made", "", SCENE),
    "08": ("from ikteach.view.chapters.comparison import Race as Made", "", SCENE),
    "09": ("from ikteach.view import Workbench as Made", "", SCENE),
    "10": ("from ikteach.view.chapters.reach import Simulator as Made", "", SCENE),
}


class Size(NamedTuple):
    """A window: pixels of the screen, and the zoom of the page."""

    width: int
    height: int
    zoom: float = 1.0

    def __str__(self) -> str:
        return f"{self.width}x{self.height}@{self.zoom:g}"


SIZES = [
    Size(width, height, zoom)
    for width, height in ((1024, 768), (1280, 720), (1366, 648), (1920, 970), (2560, 1300))
    for zoom in (1.0, 1.5)
]
SMALL = [Size(390, 844), Size(820, 1180), Size(1280, 720)]
PROJECTOR = Size(1920, 970)
