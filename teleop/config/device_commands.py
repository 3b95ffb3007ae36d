"""Commands of devices as they are written in files: `gimbal follow lock`, `drone land`."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.config.documents.messages import nearest
from teleop.core.events import DeviceCommand

DRONE = "drone"
DRONE_COMMANDS = (
    *("engage", "disengage", "arm", "disarm", "take-off", "land", "home", "home-off"),
    *("mode-p", "mode-a", "mode-f", "gear-up", "gear-down"),
)


def parse_command(text: str) -> DeviceCommand:
    """The command that `text` is, its device included where the text leaves it out.

    Raises ValueError for one that no device has; FieldError where its fields are wrong. Ranges are not checked.
    """
    words = text.split()
    if words[:1] == [DRONE]:
        name = " ".join(words[1:])
        if name not in DRONE_COMMANDS:
            raise ValueError(f"unknown command {text}{nearest(name, DRONE_COMMANDS)}")
        return DeviceCommand(DRONE, name)
    from teleop.dji.gimbal.command_table import find  # only a file with such commands needs the protocol

    find(words)
    return rig_command(words)


def rig_command(words: Sequence[str]) -> DeviceCommand:
    """The command that these words are, which the table of the rig's messages knows."""
    from teleop.dji.gimbal.command_table import RIG

    name = [word for word in words if "=" not in word]
    full = " ".join(name) if name[0] in RIG.devices else RIG.full_name(words)
    device, _, rest = full.partition(" ")
    return DeviceCommand(device, rest, tuple(word for word in words if "=" in word))
