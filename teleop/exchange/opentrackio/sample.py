"""A sample of OpenTrackIO 1.0.1: one camera's attitude and place at an instant, as the standard's schema has it.

Meters and degrees, right-handed, x right, y forward, z up, turned about z, then x, then y: so pan is + left there, and
tilt + up and roll + clockwise from behind as here.
"""

from __future__ import annotations

import json
import math
import uuid
from collections.abc import Mapping
from fractions import Fraction
from typing import Any, NamedTuple

import cbor2

from teleop.exchange.opentrackio.packets import CBOR, JSON

VERSION = (1, 0, 1)
CAMERA = "Camera"  # what SMPTE's receiver looks for in the id of a transform
NANO = 1_000_000_000
DIGITS = 6  # of angles and places: what lies beyond was not measured
FURTHEST = 1e6  # m


class SampleError(ValueError):
    """Why bytes are no sample with a camera in it; one line."""


class Pose(NamedTuple):
    """Meters, and degrees in the signs of `core.axes`."""

    x: float
    y: float
    z: float
    pan: float
    tilt: float
    roll: float


class Source(NamedTuple):
    """Who sends: its number and identity, how often (Hz), and the maker and name of the rig."""

    number: int
    identity: uuid.UUID
    rate: float
    rig: str
    version: str


class Moment(NamedTuple):
    """When a sample was taken: s since 1970, its number, and whether the computer's clock is set by others."""

    time: float
    number: int
    locked: bool


def identity(computer: str, rig: str, number: int) -> uuid.UUID:
    """The same for a source each time it is there, another one on each computer."""
    return uuid.uuid5(uuid.NAMESPACE_URL, f"rs-teleop:{computer}/{rig}/{number}")


def sample(
    source: Source, moment: Moment, pose: Pose, focus: float | None, status: str, with_static: bool
) -> dict[str, Any]:
    """`focus` is 0 (near) to 1 (far), None without; `with_static` adds what does not change."""
    rate = Fraction(source.rate).limit_denominator(1001)
    seconds = max(0, math.floor(moment.time))
    nanoseconds = min(max(0, round((moment.time - seconds) * NANO)), NANO - 1)
    made: dict[str, Any] = {
        "protocol": {"name": "OpenTrackIO", "version": list(VERSION)},
        "sampleId": uuid.uuid4().urn,
        "sourceId": source.identity.urn,
        "sourceNumber": source.number,
        "timing": {
            "mode": "internal",
            "sampleRate": {"num": rate.numerator, "denom": rate.denominator},
            "sampleTimestamp": {"seconds": seconds, "nanoseconds": nanoseconds},
            "sequenceNumber": moment.number & 0xFFFFFFFF,
            "synchronization": {"locked": moment.locked, "source": "ntp"},
        },
        "tracker": {"status": status},
        "transforms": [
            {
                "translation": {"x": _cut(pose.x), "y": _cut(pose.y), "z": _cut(pose.z)},
                "rotation": {"pan": _cut(_half_turn(-pose.pan)), "tilt": _cut(pose.tilt), "roll": _cut(pose.roll)},
                "id": CAMERA,
            }
        ],
    }
    if focus is not None:
        made["lens"] = {"encoders": {"focus": _cut(focus)}}
    if with_static:
        made["static"] = {
            "tracker": {"make": "rs-teleop", "model": source.rig or "rig", "firmwareVersion": source.version}
        }
    return made


def encoded(made: Mapping[str, Any], encoding: int) -> bytes:
    if encoding == CBOR:
        return cbor2.dumps(made)
    return json.dumps(made, separators=(",", ":"), allow_nan=False).encode()


class Received(NamedTuple):
    """What counts of a sample that came in."""

    number: int | None
    pose: Pose


def received(data: bytes, encoding: int) -> Received:
    """The camera of a sample: the transform whose id says so, else the last one. Raises SampleError."""
    try:
        made = json.loads(data) if encoding == JSON else cbor2.loads(data)
    except Exception as error:  # noqa: BLE001 - bytes from outside; a decoder may raise what it likes
        raise SampleError(f"cannot be read: {str(error)[:80]}") from None
    if not isinstance(made, dict):
        raise SampleError("is no map")
    transforms = made.get("transforms")
    if not isinstance(transforms, list) or not transforms or len(transforms) > 64:
        raise SampleError("has no transforms")
    known = [each for each in transforms if isinstance(each, dict)]
    if len(known) != len(transforms):
        raise SampleError("has a transform that is none")
    named = [each for each in known if isinstance(each.get("id"), str) and CAMERA.lower() in each["id"].lower()]
    if not named and len(known) > 1:
        raise SampleError("has several transforms, and none is called Camera")
    chosen = (named or known)[0]
    number = made.get("sourceNumber")
    if isinstance(number, bool) or not isinstance(number, int):
        number = None
    x, y, z = _numbers(chosen, "translation", ("x", "y", "z"))
    pan, tilt, roll = _numbers(chosen, "rotation", ("pan", "tilt", "roll"))
    return Received(number, Pose(x, y, z, -pan, tilt, roll))


def _numbers(transform: Mapping[str, Any], key: str, names: tuple[str, str, str]) -> tuple[float, float, float]:
    part = transform.get(key)
    if not isinstance(part, dict):
        raise SampleError(f"has a transform without {key}")
    found = []
    for name in names:
        value = part.get(name)
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < FURTHEST:
            raise SampleError(f"has no number for {name} in {key}")
        found.append(float(value))
    return found[0], found[1], found[2]


def _cut(value: float) -> float:
    return round(value, DIGITS) + 0.0


def _half_turn(angle: float) -> float:
    return math.remainder(angle, 360.0)
