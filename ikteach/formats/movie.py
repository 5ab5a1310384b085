"""Pictures in a row as a movie file: MP4, AVI or GIF.

PyAV (BSD licence; its wheel, 35 MB, brings FFmpeg with it) does the encoding. It was chosen because
it works within the process, needs no program on the path, and reads back what it has written.
"""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from math import isfinite
from numbers import Integral, Real
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ikteach.files import drafted, quoted, taken

Pixels = npt.NDArray[np.uint8]  # (height, width, 3), red green blue


class Kind(NamedTuple):
    """Encoding of one sort of file.

    `even`: its colours are kept for squares of 2 × 2 pixels.
    """

    codec: str
    pixels: str
    options: dict[str, str]
    even: bool


KINDS = {
    ".mp4": Kind("libx264", "yuv420p", {"preset": "veryfast", "crf": "20"}, even=True),
    ".avi": Kind("mpeg4", "yuv420p", {"qscale": "3", "flags": "+qscale"}, even=True),
    ".gif": Kind("gif", "pal8", {}, even=False),
}
LARGEST = 4096  # [pixels] a side
MISSING = "movies need the PyAV library: pip install 'ikteach[movie]'"
IN_THE_BROWSER = (
    "there is no PyAV for the Python that runs in the browser; save the session, and where "
    "ikteach[movie] is installed movie.write('walk.mp4', film(session.load('session'))) films it, "
    "with ikteach.formats.movie, ikteach.formats.session and ikteach.view.raster.film.film"
)
FASTEST = {".gif": 50}  # a GIF counts in hundredths, and players slow down what is under two


class Facts(NamedTuple):
    """Size, rate and length of a movie file.

    size (width, height), frames per second, number of frames
    """

    size: tuple[int, int]
    rate: float
    frames: int


def write(
    path: str | os.PathLike[str],
    frames: Iterable[Pixels],
    *,
    rate: float = 30,
    size: tuple[int, int] | None = None,
    count: int | None = None,
    overwrite: bool = False,
) -> Path:
    """Write the frames to a movie and return its path.

    The ending says which: .mp4, .avi, .gif.

    frames     uint8 arrays (height, width, 3), from any iterable; they are taken one by one
    rate       frames a second
    size       (width, height) that every frame must have; the first frame's if not given
    count      how many frames there must be; as many as come if not given
    overwrite  replace a file of that name

    The file has its name only once it is complete: if anything fails, there is none.
    FileExistsError, ValueError and OSError say what is wrong; ImportError without PyAV.
    """
    coming = iter(frames)
    first = next(coming, None)
    if first is None:
        raise ValueError("a movie needs at least one frame")
    if size is None:
        size = _size_of(first)
    with writing(path, size=size, rate=rate, overwrite=overwrite) as add:
        add(first)
        done = 1
        for frame in coming:
            if done == count:
                break
            add(frame)
            done += 1
        if count is not None and done < count:
            raise ValueError(f"the movie was to have {count} frames, but only {done} came")
    return Path(path)


@contextmanager
def writing(
    path: str | os.PathLike[str], *, size: tuple[int, int], rate: float, overwrite: bool = False
) -> Iterator[Callable[[Pixels], None]]:
    """Write a movie frame by frame: `with writing(...) as add:`.

    Then add(frame) for each. Arguments as in `write`. Where the block is left by an exception,
    nothing stays behind.
    """
    av = library()
    path = Path(path)
    kind = kind_of(path, size=size, rate=rate, overwrite=overwrite)
    with (
        drafted(path, overwrite=overwrite) as draft,
        av.open(str(draft), "w", format=path.suffix[1:].lower()) as container,
    ):
        yield from _into(container, kind, size, Fraction(rate).limit_denominator(1001))


def kind_of(
    path: str | os.PathLike[str], *, size: tuple[int, int], rate: float, overwrite: bool = False
) -> Kind:
    """Choose how the movie will be made, or refuse.

    An error says why it cannot be, before any time is spent.
    """
    path = Path(path)
    kind = KINDS.get(path.suffix.lower())
    if kind is None:
        ending = repr(path.suffix) if path.suffix else "no ending"
        raise ValueError(
            f"a movie's name ends in {', '.join(KINDS)}, and that of {path.name!r} has {ending}"
        )
    if len(size) != 2 or not all(
        isinstance(side, Integral) and 2 <= side <= LARGEST for side in size
    ):
        raise ValueError(f"a movie is (width, height) from 2 to {LARGEST} pixels, not {size!r}")
    width, height = size
    if kind.even and (width % 2 or height % 2):
        raise ValueError(
            f"the sides of an {path.suffix[1:].upper()} must be even: not {width} × {height}, but "
            f"{width + width % 2} × {height + height % 2}; a GIF can be of any size"
        )
    fastest = FASTEST.get(path.suffix.lower(), 240)
    if not (isinstance(rate, Real) and isfinite(rate) and 0 < rate <= fastest):
        raise ValueError(
            f"the rate must be more than 0 and at most {fastest} frames a second, not {rate!r}"
        )
    if path.is_dir():
        raise IsADirectoryError(f"{str(path)!r} is a folder; the movie needs a name of its own")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"there is no folder {str(path.parent)!r} to put the movie in")
    if not os.access(path.parent, os.W_OK):
        raise PermissionError(f"nothing can be written in the folder {str(path.parent)!r}")
    if path.exists() and not overwrite:
        raise taken(path)
    return kind


def read(path: str | os.PathLike[str]) -> Iterator[Pixels]:
    """Read the frames of a movie file, one by one."""
    with _open(path) as container, _whole(path):
        for frame in container.decode(video=0):
            yield frame.to_ndarray(format="rgb24")


def facts(path: str | os.PathLike[str]) -> Facts:
    """Count the frames of a movie; give size and rate."""
    with _open(path) as container, _whole(path):
        stream = container.streams.video[0]
        times = sorted(float(frame.pts * frame.time_base) for frame in container.decode(stream))
        rate = float(stream.average_rate or 0)
        if len(times) > 1:  # a GIF's own word is of its first delay, and delays are rounded
            rate = rate if stream.codec.name != "gif" else (len(times) - 1) / (times[-1] - times[0])
        return Facts((stream.width, stream.height), rate, len(times))


def library() -> Any:
    """PyAV; ImportError says how to get it."""
    try:
        import av
    except ImportError:
        raise ImportError(IN_THE_BROWSER if sys.platform == "emscripten" else MISSING) from None
    return av


def _open(path: str | os.PathLike[str]) -> Any:
    av = library()
    if not os.path.isfile(path):
        raise FileNotFoundError(f"there is no movie {quoted(str(path))}")
    with _whole(path):
        container = av.open(str(path))
    if not container.streams.video:
        raise ValueError(f"{quoted(str(path))} has no pictures in it")
    return container


@contextmanager
def _whole(path: str | os.PathLike[str]) -> Iterator[None]:
    """Say in a sentence what FFmpeg says of a file that is damaged or no movie."""
    av = library()
    try:
        yield
    except (av.error.FFmpegError, ArithmeticError, TypeError, ValueError):  # no times, no text
        raise ValueError(f"{quoted(str(path))} is not a movie that can be read") from None


def _into(
    container: Any, kind: Kind, size: tuple[int, int], rate: Fraction
) -> Iterator[Callable[[Pixels], None]]:
    """Yield the function that adds a frame, and finish the file when we come back."""
    av = library()
    stream = container.add_stream(kind.codec, rate=rate, options=kind.options)
    stream.width, stream.height = (int(side) for side in size)
    stream.pix_fmt = kind.pixels
    palette = _palette(av, stream, rate) if kind.pixels == "pal8" else None
    number = 0

    def add(pixels: Pixels) -> None:
        nonlocal number
        if _size_of(pixels) != tuple(size):
            raise ValueError(
                f"frame {number} is {' × '.join(map(str, _size_of(pixels)))} pixels in a movie of "
                f"{size[0]} × {size[1]}"
            )
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(pixels), format="rgb24")
        frame.pts, frame.time_base = number, 1 / rate
        number += 1
        container.mux(stream.encode(frame if palette is None else palette(frame)))

    yield add
    if not number:
        raise ValueError("a movie needs at least one frame")
    container.mux(stream.encode(None))


def _palette(av: Any, stream: Any, rate: Fraction) -> Callable[[Any], Any]:
    """Make a function that gives a frame its 256 best colours."""
    graph = av.filter.Graph()
    source = graph.add_buffer(
        width=stream.width, height=stream.height, format=av.VideoFormat("rgb24"), time_base=1 / rate
    )
    split = graph.add("split")
    choose = graph.add("palettegen", "stats_mode=single:reserve_transparent=0")
    use, sink = graph.add("paletteuse", "new=1:dither=none"), graph.add("buffersink")
    source.link_to(split)
    split.link_to(use, 0, 0)
    split.link_to(choose, 1, 0)
    choose.link_to(use, 0, 1)
    use.link_to(sink)
    graph.configure()

    def convert(frame: Any) -> Any:
        graph.push(frame)
        return graph.pull()

    return convert


def _size_of(pixels: Pixels) -> tuple[int, int]:
    if not (isinstance(pixels, np.ndarray) and pixels.ndim == 3 and pixels.shape[2] == 3):
        what = getattr(pixels, "shape", type(pixels).__name__)
        raise ValueError(f"a frame is an array (height, width, 3), not {what}")
    if pixels.dtype != np.uint8:
        raise ValueError(f"a frame is made of uint8, 0 to 255, not of {pixels.dtype}")
    return pixels.shape[1], pixels.shape[0]
