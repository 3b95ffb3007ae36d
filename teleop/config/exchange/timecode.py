"""`type: timecode` of a profile's `exchange`: a move that follows, or starts with, MIDI timecode or LTC."""

from __future__ import annotations

import re
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.messages import shown
from teleop.config.exchange.midi import MidiApi
from teleop.config.frame_rates import drops, is_dropped, whole_rate

RATES = (23.976, 24.0, 25.0, 29.97, 30.0)
_LABEL = re.compile(r"([01]\d|2[0-3]):([0-5]\d):([0-5]\d)([:;])([0-2]\d)")
_DEVICE = re.compile(r"(alsa|pipe):(\S.*)")
MoveName = Annotated[str, Field(min_length=1, max_length=120, pattern=r"^\w[\w. -]*$")]


def _rate(value: Any) -> Any:
    found = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
    if found not in RATES:
        raise ValueError(f"must be one of {', '.join(f'{each:g}' for each in RATES)}, not {shown(value)}")
    return found


def label(text: str) -> tuple[int, int, int, int]:
    """Hours, minutes, seconds and frames. Raises ValueError."""
    match = _LABEL.fullmatch(text)
    if match is None:
        raise ValueError(f"must be a timecode, as in 01:00:00:00, not {shown(text)}")
    hours, minutes, seconds, _, frames = match.groups()
    return int(hours), int(minutes), int(seconds), int(frames)


def _checked_label(text: str) -> str:
    label(text)
    return text


def _checked_device(text: str) -> str:
    if not _DEVICE.fullmatch(text):
        raise ValueError(f"must be alsa:NAME or pipe:FILE, not {shown(text)}")
    return text


class TimecodeSection(Section):
    """A move that follows MIDI timecode or LTC, or starts with it. This is no genlock."""

    TRANSPORT: ClassVar = None

    type: Literal["timecode"]
    """A move that follows MIDI timecode or LTC, or starts with it. This is no genlock."""
    source: Literal["mtc", "ltc"]
    """MIDI timecode, or LTC, which is sound."""
    chase: MoveName | None = None
    """The move that follows the timecode, by its name."""
    start: MoveName | None = None
    """The move that starts with the timecode, and goes on by this computer's clock."""
    at: Annotated[str, AfterValidator(_checked_label)] = "00:00:00:00"
    """The timecode at which the move begins."""
    rate: Annotated[float, BeforeValidator(_rate)] | None = None
    """Frames per second: 23.976, 24, 25, 29.97 or 30. MIDI timecode tells its own; LTC needs it."""
    ready: Annotated[Finite, Field(ge=1, le=3600)] = 30.0
    """Seconds before `at` from which on the rig goes to the start of the move."""
    port: Annotated[str, Field(max_length=200)] = ""
    """A part of the name of the MIDI port; of a virtual one, its whole name."""
    virtual: bool = False
    """Make a MIDI port of this name, which other programs connect to (ALSA, JACK, CoreMIDI)."""
    api: MidiApi = "auto"
    """The system's MIDI: auto takes JACK where there is no other."""
    device: Annotated[str, AfterValidator(_checked_device)] | None = None
    """Where LTC comes in: alsa:NAME, which arecord records, or pipe:FILE with samples (16 bits, one channel)."""
    samples: Annotated[int, Field(ge=8000, le=192000)] = 48000
    """Samples per second of the sound."""
    latency: Annotated[Finite, Field(ge=-1000, le=1000)] = 0.0
    """Milliseconds by which the timecode arrives late."""

    @property
    def move(self) -> str:
        return self.chase or self.start or ""

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if (self.chase is None) == (self.start is None):
            raise ValueError("needs one of chase and start: the name of a move")
        if self.source == "mtc" and not self.port:
            raise ValueError("mtc needs port: a part of the name of the MIDI port")
        if self.source == "ltc" and (self.device is None or self.rate is None):
            raise ValueError("ltc needs device and rate: its sound has neither")
        hours, minutes, seconds, frames = label(self.at)
        if self.rate is not None:
            dropped = drops(self.rate) if ";" in self.at else 0
            if frames >= whole_rate(self.rate) or is_dropped(hours * 60 + minutes, seconds, frames, dropped):
                raise ValueError(f"at: there is no {self.at} at {self.rate:g} frames per second")
        return self
