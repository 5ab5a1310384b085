"""Decide what of a visitor's message may reach the server, and the kernel behind it.

A message comes as one binary frame of Jupyter's protocol v1: a number n, n offsets, all of 64 bits
and little-endian, then the parts that lie between the offsets: channel, header, parent header,
metadata, content, and buffers. Jupyter Server and Voilà believe what it says of itself, so that a
frame of 58 bytes with n = 2^62 has them count for ever. Here nothing is believed.

Format: https://jupyter-server.readthedocs.io/en/latest/developers/websocket-protocols.html
"""

import json
import struct
from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

PROTOCOL = "v1.kernel.websocket.jupyter.org"
PERMITTED = ["comm_open", "comm_msg", "comm_close", "comm_info_request", "kernel_info_request"]
STATES = "jupyter.widget.control"  # the one comm that a page opens: to ask for all widgets' states
FRAME = 2**20  # bytes
PART_COUNTS = range(5, 22)  # channel, four of JSON, and up to 16 buffers
DEPTH = 32  # of lists and objects in one another


class Message(NamedTuple):
    """A message as its frame has it, without its buffers."""

    channel: str
    header: dict[str, Any]
    parent_header: dict[str, Any]
    metadata: dict[str, Any]
    content: dict[str, Any]


def read_frame(frame: bytes | str) -> Message:
    """Read a frame; ValueError says why it is none."""
    if isinstance(frame, str):
        raise ValueError("it is text, where the protocol has binary frames")
    if len(frame) > FRAME:
        raise ValueError(f"it has {len(frame)} bytes; {FRAME} are allowed")
    channel, *parts = split(frame)
    return Message(channel.decode(errors="replace"), *map(_object, parts[:4]))


def split(frame: bytes) -> list[bytes]:
    """Split a frame into its parts, or raise ValueError."""
    n = int.from_bytes(frame[:8], "little")
    start = 8 * (n + 1)
    if n - 1 not in PART_COUNTS or len(frame) < start:
        raise ValueError(f"it claims {n:.3g} offsets in {len(frame)} bytes")
    offsets = struct.unpack_from(f"<{n}Q", frame, 8)
    ascending = all(a <= b for a, b in pairwise(offsets))
    if not (ascending and offsets[0] == start and offsets[-1] == len(frame)):
        raise ValueError("its offsets do not lead from its first part to its end")
    return [frame[a:b] for a, b in pairwise(offsets)]


def _object(part: bytes) -> dict[str, Any]:
    """Read a part that is a JSON object, or raise ValueError."""
    try:
        value = json.loads(part.decode())
        if isinstance(value, dict) and _depth(value) <= DEPTH:
            return value
    except (ValueError, RecursionError):
        pass
    raise ValueError(f"a part of it is no JSON object of at most {DEPTH} levels")


def _depth(value: object) -> int:
    if not isinstance(value, dict | list):
        return 0
    inner = value.values() if isinstance(value, dict) else value
    return 1 + max(map(_depth, inner), default=0)


def permitted(message: Message) -> bool:
    """Decide whether the message may reach the kernel.

    It may if it moves or asks for widgets that are there. So no code runs that the page does not
    have, and no widget is made that it has not made.
    """
    kind = message.header.get("msg_type")
    opens = kind == "comm_open" and message.content.get("target_name") != STATES
    return message.channel == "shell" and kind in PERMITTED and not opens


class Allowance:
    """An amount per second, and some seconds' worth saved up.

    rate   per second
    saved  seconds' worth that can be spent at once
    clock  tells the time [s]
    """

    def __init__(self, rate: float, saved: float, clock: Callable[[], float]) -> None:
        self.rate, self.most, self._clock = rate, rate * saved, clock
        self._left, self._at = self.most, clock()

    def spend(self, amount: float) -> bool:
        """Take the amount, and say whether it was there."""
        now = self._clock()
        self._left = min(self.most, self._left + self.rate * (now - self._at)) - amount
        self._at = now
        return self._left >= 0
