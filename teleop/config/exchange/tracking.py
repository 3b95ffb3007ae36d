"""What FreeD and OpenTrackIO have in common: attitude that is sent, or a tracked place that an aim follows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.document import Wrong, mapping, sequence
from teleop.config.exchange.address import Allowed, Listen

FURTHEST = 131.0  # m that FreeD can say
LATENCY = 0.08  # s: how late the newest reading of a gimbal that is asked 25 times a second comes at worst

Place = Annotated[list[Annotated[Finite, Field(ge=-FURTHEST, le=FURTHEST)]], Field(min_length=3, max_length=3)]

IN = ("as", "target", "mount", "offset", "allow", "smoothing")
"""The keys of an entry that listens."""


class LookBesideSection(Section):
    """How far beside its target the camera looks."""

    pan: Finite = 0.0
    """Pan in deg; + is right."""
    tilt: Finite = 0.0
    """Tilt in deg; + is up."""


class TrackingSection(Section):
    """Either sends, with `to`, or listens, with `listen` and `as`."""

    TRANSPORT: ClassVar = "udp"

    rate: Annotated[float, Field(gt=0, le=100)] = 50.0
    """Messages per second (Hz)."""
    latency: Annotated[float, Field(ge=0, le=1)] = LATENCY
    """How old the attitude in a message is, in s: late enough to lie between two readings of the gimbal."""
    position: Place = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Where the camera is, in m: X right, Y forward, Z up."""
    listen: Listen | None = None
    """HOST:PORT where a tracker's messages arrive, instead of `to`."""
    as_: Annotated[Literal["target", "base"] | None, Field(alias="as")] = None
    """What arrives is the target that the camera looks at, or the base that carries the gimbal."""
    target: Place | None = None
    """With `as: base`: the point that the camera looks at, in m."""
    mount: Annotated[Finite, Field(ge=-FURTHEST, le=FURTHEST)] = 0.0
    """With `as: base`: height in m of the camera's axes above the point that is tracked."""
    offset: LookBesideSection = LookBesideSection()
    """How far beside its target the camera looks."""
    smoothing: Annotated[float, Field(ge=0.05, le=1)] = 0.2
    """Over how much of a tracker's stream its motion is averaged, in s."""
    allow: list[Allowed] = Field(default_factory=list)
    """Addresses or networks whose messages may move the rig; those of this computer always may."""


def tracking_rules(data: Any, types: Mapping[str, tuple[str, ...]]) -> Iterator[Wrong]:
    """What is wrong with the entries of a profile's `exchange` that track; `data` is the whole profile, unchecked.

    `types` has the keys of each type that only an entry that sends has.
    """
    for index, entry in enumerate(sequence(data, "exchange")):
        entry = mapping(entry)
        kind = entry.get("type")
        if isinstance(kind, str) and kind in types:
            for key, wrong in _wrong(entry, ("to", "rate", "latency", *types[kind])):
                yield ("exchange", index, *([key] if key else [])), wrong


def _wrong(entry: Mapping[str, Any], out: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    to, listen = entry.get("to"), entry.get("listen")
    if (to is None) == (listen is None):
        yield "", "needs either to, to send, or listen, to follow"
        return
    for key in IN if listen is None else out:
        if key in entry:
            yield key, "only goes with listen" if listen is None else "only goes with to"
    if listen is None:
        return
    kind = entry.get("as")
    if kind is None:
        yield "as", ": write as: target or as: base, for the tracked point"
    if kind == "base" and entry.get("target") is None:
        yield "target", ": needs the point [x, y, z] that the camera looks at, in m"
    for key in ("target", "mount") if kind == "target" else ("position",) if kind == "base" else ():
        if key in entry:
            yield key, f"does not go with as: {kind}" + ("" if key != "position" else ", which tracks it: see mount")
