"""What passes the door and what does not: nothing raises but a `CommandError` with its reason."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis
from teleop.door.messages import SHAPES, CommandError, DoorCommand, checked, packed, unpacked
from teleop.door.sockets import LARGEST
from teleop.door.states import StatePacker, StateUnpacker

WHO = {"id": 7, "session": "ab12", "person": "phone", "time": 1.5}


def test_a_command_is_a_checked_value() -> None:
    message = {"do": "goto", **WHO, "axes": {"pan": 10, "tilt": -2.5}, "seconds": 2}
    command = checked(unpacked(packed(message)))
    assert command == DoorCommand(
        "goto", 7, "ab12", "phone", 1.5, {"axes": {Axis.PAN: 10.0, Axis.TILT: -2.5}, "seconds": 2.0}
    )


@pytest.mark.parametrize(
    ("message", "reason"),
    [
        ({"do": "fly"}, "unknown command"),
        ({"do": ["goto"]}, "unknown command"),
        ({"do": "goto"}, "needs axes"),
        ({"do": "goto", "axes": {}}, "axes must have a number"),
        ({"do": "goto", "axes": {"pan": float("nan")}}, "axes must be a number"),
        ({"do": "goto", "axes": {"pan": 1e9}}, "axes must be"),
        ({"do": "goto", "axes": {"pan": True}}, "axes must be a number"),
        ({"do": "goto", "axes": {"pin": 1}}, "axes must be an axis"),
        ({"do": "goto", "axes": {7: 1}}, "axes must be an axis"),
        ({"do": "goto", "axes": {"pan": 1}, "second": 1}, "unknown field"),
        ({"do": "stick", "seq": -1, "axes": {"pan": 0}}, "seq must be"),
        ({"do": "stick", "seq": 1, "axes": {"pan": 1.5}}, "axes must be"),
        ({"do": "jog", "axis": "pan", "by": 1000}, "by must be"),
        ({"do": "play", "move": "../secret"}, "move has characters"),
        ({"do": "play", "move": "/etc/passwd"}, "move has characters"),
        ({"do": "play", "move": ".hidden"}, "move has characters"),
        ({"do": "play", "move": "a\nb"}, "move must be printable"),
        ({"do": "preset_store", "number": 1, "name": "x" * 61}, "at most 60"),
        ({"do": "message", "name": "gimbal version", "fields": {"a": [1]}}, "fields must be"),
    ],
)
def test_what_is_no_command_has_a_reason(message: dict[Any, Any], reason: str) -> None:
    with pytest.raises(CommandError, match=reason) as caught:
        checked({**WHO, **message})
    assert caught.value.id == 7


def test_who_says_it_has_to_be_known() -> None:
    for missing in ("id", "session"):
        with pytest.raises(CommandError, match=f"needs {missing}"):
            checked({key: value for key, value in {"do": "stop", **WHO}.items() if key != missing})


def test_nothing_larger_than_macos_takes_is_packed_or_unpacked() -> None:
    assert LARGEST < 2048
    with pytest.raises(CommandError, match="too large"):
        packed({"do": "stop", "name": "x" * LARGEST})
    with pytest.raises(CommandError, match="too large"):
        unpacked(bytes(LARGEST + 1))


VALUES: list[Any] = [None, True, -1, 2**63, 1e300, float("nan"), float("inf"), "", "pan", "é\n", "x" * 300, b"\xff"]
VALUES += [[], [1], {}, {"pan": 0.5}, {"pan": None}, {1: 2}, {"a": {"b": {"c": 1}}}]
KEYS = [*WHO, "axes", "seq", "move", "number", "by", "axis", "seconds", "seen", "fields", "name", "odd", ""]
Messages = st.dictionaries(st.sampled_from(KEYS), st.sampled_from(VALUES), max_size=6)


def is_command_or_reason(message: object) -> bool:
    """Raises what is not a `CommandError`."""
    try:
        return isinstance(checked(message), DoorCommand)
    except CommandError as error:
        return bool(str(error))


@settings(max_examples=150, deadline=None)
@given(st.sampled_from([*SHAPES, "fly", ""]), Messages)
def test_any_map_is_a_command_or_a_reason(do: str, fields: dict[str, Any]) -> None:
    assert is_command_or_reason({"do": do, **fields})
    assert is_command_or_reason({"do": do, **WHO, **fields})


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=100), st.integers(0, 60))
def test_any_bytes_are_a_command_or_a_reason(data: bytes, cut: int) -> None:
    """Also those that begin as a command does."""
    for text in (data, packed({"do": "stop", **WHO})[:cut] + data):
        try:
            message = unpacked(text)
        except CommandError:
            continue
        assert is_command_or_reason(message)


@pytest.mark.parametrize(
    "data",
    [b"\x91" * 1999, b"\x81\xa1a" * 600, b"\xdd\xff\xff\xff\xff", b"\xdb\xff\xff\xff\xffx", b"\xc1", b"\x81\x80\x01"],
)
def test_depth_and_length_beyond_all_bounds_are_refused(data: bytes) -> None:
    with pytest.raises(CommandError):
        checked(unpacked(data))


def test_a_state_is_whole_again_and_what_seldom_changes_is_packed_once() -> None:
    packer, unpacker = StatePacker(), StateUnpacker()
    seldom = {"keys": [{"pan": 1.0}]}
    first, second = packer.pack({"tick": 1}, seldom), packer.pack({"tick": 2}, seldom)
    assert unpacker.unpack(first) == {"tick": 1, "keys": [{"pan": 1.0}]}
    assert unpacker.unpack(second) == {"tick": 2, "keys": [{"pan": 1.0}]}
    assert unpacker.unpack(packer.pack({"tick": 3}, {"keys": []})) == {"tick": 3, "keys": []}
