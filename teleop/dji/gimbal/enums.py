"""The numbers that mean something on the gimbal, by the words that people and JSON use for them."""

from __future__ import annotations

from enum import IntEnum


class Operation(IntEnum):
    """The control byte of commands that do one thing or nothing."""

    NOTHING = 0
    EXECUTE = 1


class AngleKind(IntEnum):
    """Attitude is against the horizon and north-less heading, joint against the handle; NONE also: not ready yet."""

    NONE = 0
    ATTITUDE = 1
    JOINT = 2


class Switch(IntEnum):
    """0 changes nothing: off is 2 (0x07)."""

    UNCHANGED = 0
    ON = 1
    OFF = 2


class ParameterId(IntEnum):
    """User parameters known from the document (table, follow_special, motor) and from an RS 5 (push_pan, push_tilt)."""

    TABLE = 0x00
    PUSH_PAN = 0x14
    PUSH_TILT = 0x15
    FOLLOW_SPECIAL = 0x22
    MOTOR = 0x23


class Orientation(IntEnum):
    """Landscape and portrait (0x0D); FLIPPED is the other way round, 180 and -90 degrees about the lens axis."""

    UNCHANGED = 0x00
    LANDSCAPE = 0x01
    LANDSCAPE_FLIPPED = 0x02
    PORTRAIT = 0x03
    PORTRAIT_FLIPPED = 0x04
    TOGGLE = 0x05
    DEFAULT = 0xFF


class FollowMode(IntEnum):
    """What the gimbal does when its handle turns (0x0E)."""

    LOCK = 0x00
    YAW = 0x02
    SPORT = 0x03
    UNCHANGED = 0xFE


class CenterAction(IntEnum):
    """Done once, only with FollowMode.UNCHANGED (0x0E)."""

    NONE = 0x00
    RECENTER = 0x01
    SELFIE = 0x02


class CalibrationState(IntEnum):
    """Of the automatic tuning (0x10)."""

    NONE = 0
    RUNNING = 1
    COMPLETE = 2
    ERROR = 3


class Track(IntEnum):
    """ActiveTrack has only a toggle, and reports no state (0x11)."""

    TOGGLE = 0x03
