"""The fourteen ways to say how the drone should move: their bytes, their ranges, and what is none of them."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.drone.enums import CurrentMode
from teleop.dji.drone.movement import COMBINATIONS, Combination, Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.dji.message import FieldError

TABLE = [
    # The appendix's "Combinations": control mode byte, and what throttle, pitch & roll, and yaw may be.
    (0b00000000, (-4, 4), (-30, 30), (-180, 180)),
    (0b00001000, (-4, 4), (-30, 30), (-100, 100)),
    (0b01000000, (-4, 4), (-10, 10), (-180, 180)),
    (0b01001000, (-4, 4), (-10, 10), (-100, 100)),
    (0b10000000, (-4, 4), None, (-180, 180)),
    (0b10001000, (-4, 4), None, (-100, 100)),
    (0b00010000, (0, None), (-30, 30), (-180, 180)),
    (0b00011000, (0, None), (-30, 30), (-100, 100)),
    (0b01010000, (0, None), (-10, 10), (-180, 180)),
    (0b01011000, (0, None), (-10, 10), (-100, 100)),
    (0b10010000, (0, None), None, (-180, 180)),
    (0b10011000, (0, None), None, (-100, 100)),
    (0b00100000, (10, 100), (-30, 30), (-180, 180)),
    (0b00101000, (10, 100), (-30, 30), (-100, 100)),
]


def move(combination: Combination, **given: Any) -> Move:
    usual: dict[str, Any] = {
        "stable": False,
        "frame": ReferenceFrame.GROUND,
        "horizontal": combination.horizontal,
        "vertical": combination.vertical,
        "yaw_control": combination.yaw,
        "x": 0.0,
        "y": 0.0,
        "z": 10.0,
        "yaw": 0.0,
    }
    if combination.vertical == Vertical.VELOCITY:
        usual["z"] = 0.0
    return Move(**(usual | given))


def refused(message: Move) -> bool:
    try:
        message.check()
    except FieldError:
        return True
    return False


@pytest.mark.parametrize(("index", "row"), list(enumerate(TABLE)))
@pytest.mark.parametrize(
    ("frame", "stable"), [(ReferenceFrame.GROUND, False), (ReferenceFrame.BODY, True), (ReferenceFrame.BODY, False)]
)
def test_the_mode_bytes(index: int, row: tuple[int, Any, Any, Any], frame: ReferenceFrame, stable: bool) -> None:
    message = move(COMBINATIONS[index], frame=frame, stable=stable)
    message.check()
    assert message.encode()[0] == row[0] | frame << 1 | stable
    assert Move.decode(message.encode()) == message


@pytest.mark.parametrize(("index", "row"), list(enumerate(TABLE)))
def test_the_ranges(index: int, row: tuple[int, Any, Any, Any]) -> None:
    combination, (_, across_z, across, turning) = COMBINATIONS[index], row
    for name, bounds in {"x": across, "y": across, "z": across_z, "yaw": turning}.items():
        low, high = bounds or (None, None)
        for bound, beyond in ((low, -0.01), (high, 0.01)):
            if bound is None:
                assert not refused(move(combination, **{name: 1e6}))
            else:
                assert not refused(move(combination, **{name: bound}))
                assert refused(move(combination, **{name: bound + beyond}))
        assert refused(move(combination, **{name: float("nan")}))


def test_the_order_is_that_of_the_current_modes() -> None:
    words = {Horizontal.TILT: "ANG", Horizontal.VELOCITY: "VEL", Horizontal.POSITION: "POS"}
    heights = {Vertical.VELOCITY: "VEL", Vertical.POSITION: "POS", Vertical.THRUST: "THR"}
    turns = {Yaw.ANGLE: "ANG", Yaw.RATE: "RATE"}
    for number, (horizontal, vertical, yaw) in enumerate(COMBINATIONS, 1):
        name = f"HORIZ_{words[horizontal]}_VERT_{heights[vertical]}_YAW_{turns[yaw]}"
        assert CurrentMode[name] == number


@given(st.integers(0, 255))
def test_every_mode_byte_is_decoded_and_only_those_of_the_table_may_be_sent(byte: int) -> None:
    message = Move.decode(bytes((byte,)) + bytes(8) + bytes.fromhex("00002041") + bytes(4))  # z is 10
    assert isinstance(message, Move)
    assert message.encode()[0] == byte
    assert Move.from_fields(message.fields()) == message
    listed = byte & 0b11111000 in {row[0] for row in TABLE} and byte >> 1 & 3 in (0, 1)
    climbing = byte & 0b00110000 == 0  # at 10 m/s, which is too fast
    assert refused(message) is not (listed and not climbing)


@pytest.mark.parametrize(
    ("changed", "error"),
    [
        ({"horizontal": 3}, "drone.move: horizontal must be one of tilt, velocity, position, not 3"),
        ({"vertical": 3}, "drone.move: vertical must be one of velocity, position, thrust, not 3"),
        ({"frame": 2}, "drone.move: frame must be one of ground, body, not 2"),
        (
            {"vertical": Vertical.THRUST, "horizontal": Horizontal.VELOCITY},
            "drone.move: vertical thrust goes only with horizontal tilt",
        ),
        ({"x": 31.0}, "drone.move: x must be -30..30 deg, not 31"),
        ({"yaw_control": Yaw.RATE, "yaw": 101.0}, "drone.move: yaw must be -100..100 deg/s, not 101"),
    ],
)
def test_errors(changed: dict[str, Any], error: str) -> None:
    with pytest.raises(FieldError) as raised:
        move(COMBINATIONS[0], **changed).check()
    assert str(raised.value) == error
