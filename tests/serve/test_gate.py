"""What is a frame of the protocol, and what a visitor may say with one."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jupyter_server.services.kernels.connection.base import (
    deserialize_msg_from_ws_v1,
    serialize_msg_to_ws_v1,
)

from ikteach.serve.lecture import gate

HEADER = {"msg_id": "1", "msg_type": "comm_msg", "username": "", "session": "", "version": "5.3"}
GOOD = [json.dumps(HEADER).encode(), b"{}", b"{}", b'{"comm_id": "c"}']


def frame(*parts: bytes, channel: str = "shell") -> bytes:
    return serialize_msg_to_ws_v1(list(parts or GOOD), channel)


def offsets(*at: int, then: bytes = b"") -> bytes:
    return b"".join(n.to_bytes(8, "little") for n in (len(at), *at)) + then


def with_content(text: str) -> bytes:
    return frame(*GOOD[:3], text.encode())


DEEP = with_content('{"a":' * 40 + "1" + "}" * 40)
HOSTILE = {
    "2^62 parts": (2**62).to_bytes(8, "little") + b"x" * 50,
    "2^64 - 1 parts": b"\xff" * 8 + b"x" * 50,
    "nothing": b"",
    "half a number": b"\x06\x00\x00",
    "no parts": offsets(),
    "one part": offsets(24, 29, then=b"shell"),
    "no content": frame(*GOOD[:3]),
    "too many buffers": frame(*GOOD, *[b""] * 17),
    "fewer offsets than it says": frame()[:40],
    "an end beyond the end": frame()[:-1],
    "more than it says": frame() + b"x",
    "offsets that descend": offsets(64, 60, 62, 64, 64, 64, 64),
    "offsets that are huge": offsets(56, *[2**63] * 5),
    "offsets that are negative": offsets(56, *[2**64 - 8] * 5),
    "a first part within the offsets": offsets(8, 56, 56, 56, 56, 56),
    "no JSON": with_content("{"),
    "JSON, but a list": with_content("[]"),
    "JSON, but null": frame(GOOD[0], b"null", *GOOD[2:]),
    "not UTF-8": frame(*GOOD[:3], b'{"a": "\xff"}'),
    "UTF-16": frame(json.dumps(HEADER).encode("utf-16"), *GOOD[1:]),
    "deep": DEEP,
    "deeper than Python goes": with_content('{"a":' + "[" * 100_000 + "]" * 100_000 + "}"),
    "a number of 5,000 digits": with_content('{"a": ' + "1" * 5000 + "}"),
    "large": frame(*GOOD, b"x" * gate.FRAME),
    "text": json.dumps({"header": HEADER, "channel": "shell"}),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_what_is_no_frame_is_refused_in_a_short_sentence(name: str) -> None:
    with pytest.raises(ValueError, match=r"^(it|its|a part of it) ") as refused:
        gate.read_frame(HOSTILE[name])
    assert len(str(refused.value)) < 120


@given(st.lists(st.binary(max_size=30), max_size=16), st.sampled_from(["shell", "control"]))
def test_what_jupyter_server_writes_is_read_as_it_reads_it(buffers, channel) -> None:
    made = frame(*GOOD, *buffers, channel=channel)
    assert gate.read_frame(made) == (channel, HEADER, {}, {}, {"comm_id": "c"})
    name, *parts = gate.split(made)
    assert (name.decode(), parts) == deserialize_msg_from_ws_v1(made)


@given(st.binary(max_size=200), st.integers(0, 30))
def test_bytes_of_any_kind_are_read_or_refused(rest: bytes, n: int) -> None:
    for made in (rest, n.to_bytes(8, "little") + rest, frame()[: len(rest)] + rest):
        try:
            parts = gate.split(made)
        except ValueError:
            continue
        assert sum(map(len, parts)) + 8 * (len(parts) + 2) == len(made)


@given(st.data())
def test_a_frame_with_one_byte_changed_is_read_or_refused(data) -> None:
    made = bytearray(frame())
    made[data.draw(st.integers(0, len(made) - 1))] = data.draw(st.integers(0, 255))
    try:
        message = gate.read_frame(bytes(made))
    except ValueError:
        return
    assert all(isinstance(part, dict) for part in message[1:])


def may(kind: str, channel: str = "shell", **content: object) -> bool:
    header = HEADER | {"msg_type": kind}
    return gate.permitted(gate.Message(channel, header, {}, {}, content))


def test_widgets_may_be_moved_and_asked_for() -> None:
    assert may("comm_msg")
    assert may("comm_close")
    assert may("comm_open", target_name="jupyter.widget.control")
    assert may("kernel_info_request")


@pytest.mark.parametrize(
    "kind",
    [
        "execute_request", "inspect_request", "complete_request", "history_request",
        "is_complete_request", "shutdown_request", "interrupt_request", "debug_request",
        "create_subshell_request", "usage_request", "input_reply", "connect_request",
        "Execute_request", "", None, 5, ["comm_msg"],
    ],
)  # fmt: skip
def test_nothing_else_reaches_the_kernel(kind) -> None:
    for channel in ("shell", "control", "stdin", "iopub"):
        assert not may(kind, channel)


def test_nor_do_widgets_of_a_visitor_s_own_or_another_channel() -> None:
    assert not may("comm_open", target_name="jupyter.widget")
    assert not may("comm_open")
    assert not may("comm_open", target_name=["jupyter.widget.control"])
    for channel in ("control", "stdin", "iopub", "", "Shell", "no such"):
        assert not may("comm_msg", channel)
    assert not gate.permitted(gate.read_frame(frame().replace(b"shell", b"she\xff\xff")))


def test_an_allowance_is_spent_and_comes_back() -> None:
    now = [0.0]
    allowance = gate.Allowance(10, 2, lambda: now[0])
    assert allowance.spend(20)
    assert not allowance.spend(1)
    now[0] += 0.2
    assert allowance.spend(1)
    now[0] += 1000
    assert allowance.spend(20)
    assert not allowance.spend(1)
