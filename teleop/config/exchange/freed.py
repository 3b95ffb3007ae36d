"""`type: freed` of a profile's `exchange`: camera tracking as FreeD D1 messages."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, NamedTuple

from pydantic import AfterValidator, Field

from teleop.config.documents.base_model import Section
from teleop.config.exchange.address import address
from teleop.config.exchange.serial_place import SERIAL, serial_place
from teleop.config.exchange.tracking import TrackingSection

BAUD = 38400  # of FreeD on a serial line, with 8 bits, odd parity and one stop bit

Raw = Annotated[int, Field(ge=0, le=0xFFFFFF)]
Ends = Annotated[list[Raw], Field(min_length=2, max_length=2)]


def _to(text: str) -> str:
    if text.startswith(SERIAL):
        serial_place(text, BAUD)
    elif address(text).port == 0:
        raise ValueError("must have the receiver's port, not 0")
    return text


class Range(NamedTuple):
    """What a receiver takes an encoder's ends for: near and far of a focus, wide and tele of a zoom."""

    first: int
    last: int


class Receiver(NamedTuple):
    """The ranges that a receiver is set to."""

    zoom: Range
    focus: Range


_16, _24 = Range(0, 0xFFFF), Range(0, 0xFFFFFF)
RECEIVERS: Mapping[str, Receiver] = {
    "unreal": Receiver(_16, _16),
    "panasonic": Receiver(Range(0x555, 0xFFF), Range(0x555, 0xFFF)),
    "sony": Receiver(Range(0, 0x7AC0), Range(0x1000, 0xF000)),
    "mosys": Receiver(_16, _16),
    "stype": Receiver(_24, _24),
    "ncam": Receiver(_24, _24),
}
"""By the configurations of Unreal Engine's Live Link FreeD (LiveLinkFreeDSource.cpp): `unreal` is its Generic."""


class LensSection(Section):
    """What is sent for zoom and focus, in the receiver's own counts: FreeD gives them no meaning."""

    zoom: Raw | Ends | None = None
    """A number that is sent as it is, or [wide, tele], of which the wide end is sent: a rig has no zoom axis."""
    focus: Raw | Ends | None = None
    """The counts at [near, far] of the focus axis, or a number that is sent as it is."""


class FreeDSection(TrackingSection):
    """The camera's measured attitude as FreeD D1, or what a tracker sends as that."""

    type: Literal["freed"]
    """Camera tracking as FreeD D1, over UDP or a serial line."""
    to: Annotated[str, AfterValidator(_to)] | None = None
    """HOST:PORT of the receiver, or serial:DEVICE, at 38400 baud unless @BAUD follows."""
    camera: Annotated[int, Field(ge=0, le=255)] = 1
    """The camera's number in the messages; of a tracker, the only one that is followed."""
    receiver: Literal["unreal", "panasonic", "sony", "mosys", "stype", "ncam"] | None = None
    """Whose counts zoom and focus are sent in; `lens` overrules it."""
    lens: LensSection = LensSection()
    """What is sent for zoom and focus, in the receiver's own counts: FreeD gives them no meaning."""


OUT = ("receiver", "lens")
"""The keys that only an entry that sends has."""
