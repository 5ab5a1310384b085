"""A movie of the four methods side by side, recorded without a screen: for a README or a slide."""

from argparse import ArgumentTypeError
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ikteach.formats import movie
from ikteach.motion import gait
from ikteach.motion.live.session import Session
from ikteach.publish.parser import Parser, RefusedError
from ikteach.view.raster.drawing import Drawing
from ikteach.view.stage.basics import BASICS
from ikteach.view.stage.stage import CAMERAS, Stage

SETTLED = 3  # periods after which a figure that stood is in its stride


def main(argv: list[str]) -> int:
    """Record a movie of the race; give the exit code."""
    parser = Parser(
        prog="python -m ikteach film",
        description="Record the four methods side by side, following the same targets for one "
        "period, so that the movie can go round. A file that is there is not overwritten.",
        allow_abbrev=False,
    )
    parser.add_argument("file", metavar="FILE", type=Path, help=f"NAME{', NAME'.join(movie.KINDS)}")
    parser.add_argument("--motion", choices=gait.MOTIONS, default="walking")
    parser.add_argument("--view", choices=CAMERAS)
    parser.add_argument("--size", type=in_pixels, default=(720, 320), metavar="WIDTHxHEIGHT")
    parser.add_argument("--rate", type=float, default=20, help="pictures per second")
    options = parser.parse_args(argv)
    shape = {"size": options.size, "rate": options.rate}
    try:
        movie.kind_of(options.file, **shape)
        movie.write(options.file, race(options.motion, options.view, **shape), **shape)
    except (ImportError, ValueError, OSError) as error:
        raise RefusedError(str(error)) from None
    print(f"{options.file}: {options.file.stat().st_size / 1000:.0f} kB")
    return 0


def in_pixels(text: str) -> tuple[int, int]:
    """Read WIDTHxHEIGHT [pixels]."""
    width, _, height = text.partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT, such as 720x320")
    return int(width), int(height)


def race(
    motion: str, view: str | None, size: tuple[int, int], rate: float
) -> Iterator[movie.Pixels]:
    """Draw one period of a race at `rate` pictures per second."""
    session = Session(gait=gait.MOTIONS[motion])
    stage = Stage(session.tree, session.effectors, list(session.methods))
    drawing, layers = Drawing(stage, size, view, finer=2), [layer(stage) for layer in BASICS]
    turn = session.gait.rate * session.gait.step_frequency / rate  # of the phase, per picture [rad]
    for phase in np.arange(SETTLED * 2 * np.pi, (SETTLED + 1) * 2 * np.pi - turn / 2, turn):
        while session.phase < phase:
            session.tick()
        theta = np.array([*session.theta.values()])
        now = stage.now(theta, session.targets, floor=session.floor, advance=session.advance)
        yield np.asarray(drawing.picture(layers, now))
