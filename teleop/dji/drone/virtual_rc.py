"""Command set 05, the virtual RC: the drone flown by the channels of a remote controller that is not there.

The drone leaves it after a second without sticks; for what that requires of the sender, see docs/protocol-facts.md.
Both commands are taken at their exact length only: one SDK sent its sticks as settings (docs/protocol-facts.md), and
the first of those bytes must not be read as switching anything on.
"""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Final, Self

from teleop.dji.drone.enums import GearChannel, ModeChannel
from teleop.dji.fields import U32, Flag, Reserved
from teleop.dji.message import STREAM, Message, Opaque, message

VIRTUAL_RC: Final = 0x05  # command set

CENTER: Final = 1024
DEFLECTION: Final = 660  # of a stick, at most, either way

stick = Annotated[int, U32(low=CENTER - DEFLECTION, high=CENTER + DEFLECTION)]


class Exact(Message):
    """A message that is nothing else when bytes follow it."""

    @classmethod
    def decode(cls, value: bytes) -> Self | Opaque:
        return super().decode(value) if len(value) == cls.layout.size else Opaque(cls.set_and_id, value)


@message("drone.virtual_rc", VIRTUAL_RC, 0x00, cmd_type=STREAM)
class VirtualRc(Exact):
    """Switch the virtual RC on or off; when it ends, the drone listens to the real RC, or behaves as without any."""

    on: Annotated[bool, Flag(first=0)]
    back_to_rc: Annotated[bool, Flag(first=1)] = True
    reserved: Annotated[int, Reserved()] = 0


@message("drone.sticks", VIRTUAL_RC, 0x01, cmd_type=STREAM)
class Sticks(Exact):
    """The sixteen channels, neutral unless given; 20 times a second."""

    roll: stick = CENTER
    pitch: stick = CENTER
    throttle: stick = CENTER
    yaw: stick = CENTER
    gear: Annotated[int, U32(words=GearChannel)] = GearChannel.DOWN
    go_home: stick = CENTER
    mode: Annotated[int, U32(words=ModeChannel)] = ModeChannel.P
    channel_7: stick = field(default=CENTER, kw_only=True)
    channel_8: stick = field(default=CENTER, kw_only=True)
    channel_9: stick = field(default=CENTER, kw_only=True)
    channel_10: stick = field(default=CENTER, kw_only=True)
    channel_11: stick = field(default=CENTER, kw_only=True)
    channel_12: stick = field(default=CENTER, kw_only=True)
    channel_13: stick = field(default=CENTER, kw_only=True)
    channel_14: stick = field(default=CENTER, kw_only=True)
    channel_15: stick = field(default=CENTER, kw_only=True)


NEUTRAL: Final = Sticks()
"""P mode, gear down, sticks in the middle."""


def broadcast_value(channel: int) -> int:
    """What the broadcast makes of the mode and gear channels: 1552 is -8000, 1324 is -4545 (docs/protocol-facts.md)."""
    return round(-(channel - CENTER) * 10000 / DEFLECTION)
