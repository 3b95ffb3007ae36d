"""Commands of devices as they are written: what is read from them, and what is refused."""

from __future__ import annotations

import pytest

from teleop.config.device_commands import DRONE_COMMANDS, parse_command
from teleop.core.events import DeviceCommand
from teleop.dji.gimbal.command_table import PLAIN
from teleop.dji.message import FieldError


@pytest.mark.parametrize(
    "text", [*PLAIN, *(f"drone {name}" for name in DRONE_COMMANDS), "gimbal set_stiffness pitch=4 roll=4 yaw=4"]
)
def test_a_command_is_written_as_it_was_read(text: str) -> None:
    assert str(parse_command(text)) == text


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("follow lock", DeviceCommand("gimbal", "follow lock")),
        ("record", DeviceCommand("camera", "record")),
        ("  gimbal   version ", DeviceCommand("gimbal", "version")),
        (
            "gimbal position yaw=1 roll=0 pitch=0",
            DeviceCommand("gimbal", "position", ("yaw=1", "roll=0", "pitch=0")),
        ),
    ],
)
def test_the_device_may_be_left_out_and_spaces_do_not_matter(text: str, command: DeviceCommand) -> None:
    assert parse_command(text) == command


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("gimbal folow lock", "unknown command gimbal folow lock; did you mean gimbal follow lock?"),
        ("drone tke-off", "unknown command drone tke-off; did you mean take-off?"),
        ("drone", "unknown command drone"),
        ("xyzzy", "unknown command xyzzy"),
        ("gimbal recenter speed=1", "gimbal recenter takes no fields"),
    ],
)
def test_an_unknown_command_is_refused_with_the_nearest_one(text: str, error: str) -> None:
    with pytest.raises((ValueError, FieldError)) as raised:
        parse_command(text)
    assert str(raised.value) == error
