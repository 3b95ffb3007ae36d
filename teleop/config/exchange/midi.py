"""`type: midi` of a profile's `exchange`: faders, wheels and buttons of a MIDI controller, with feedback to it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self

from pydantic import AfterValidator, Field, model_validator

from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.messages import shown
from teleop.config.exchange.presses import PRESSES

MidiApi = Literal["auto", "alsa", "jack", "coremidi", "winmm"]
MidiAxis = Literal["pan", "tilt", "roll", "focus"]
HIGHEST = 127
FINE = 31  # the highest controller that has a second one, 32 above it, for its lower bits
WORDS = ("stop", *PRESSES)
_CONTROL = re.compile(r"(note|cc14|cc|bend)(?: (\d{1,3}))?(?: ch (\d{1,2}))?")
_PRESS = re.compile(r"(preset|store|range) (\d{1,3})|(play) ([\w][\w. -]{0,119})")


class Control(NamedTuple):
    """What a controller sends: `kind` is note, cc, cc14 or bend, `channel` counts from 0."""

    kind: str
    number: int
    channel: int


def control(text: str) -> Control:
    """`note 60`, `cc 7`, `cc14 1`, `bend`, each with ` ch 2` where the channel is not 1. Raises ValueError."""
    match = _CONTROL.fullmatch(text)
    kind, number, channel = match.groups() if match else ("", None, None)
    found = Control(kind, int(number or 0), int(channel or 1) - 1)
    highest = FINE if kind == "cc14" else HIGHEST
    if not match or (kind == "bend") != (number is None) or found.number > highest or not 0 <= found.channel < 16:
        raise ValueError(f"must be note 60, cc 7, cc14 1 or bend, with ch 2 behind it if need be, not {shown(text)}")
    return found


def pressed(text: str) -> Mapping[str, Any]:
    """The command that a press is. Raises ValueError."""
    if text in WORDS:
        return {"do": text}
    match = _PRESS.fullmatch(text)
    if match is None:
        raise ValueError(
            f"must be one of {', '.join(WORDS)}, preset 1, store 1, range 1 or play NAME, not {shown(text)}"
        )
    kind, number, play, name = match.groups()
    if play:
        return {"do": "play", "move": name}
    return {"do": {"preset": "preset_recall", "store": "preset_store"}.get(kind, kind), "number": int(number)}


def _checked_control(text: str) -> str:
    control(text)
    return text


def _checked_press(text: str) -> str:
    pressed(text)
    return text


class MidiControl(Section):
    """A fader, wheel or button, and what it does."""

    sends: Annotated[str, AfterValidator(_checked_control)]
    """What it sends: note 60, cc 7, cc14 1 (14 bits: controllers 1 and 33) or bend; ch 2 behind it for a channel."""
    press: Annotated[str, AfterValidator(_checked_press)] | None = None
    """What a button does: stop, clear, record, shutter, set_key, preset 1, range 1, play NAME and others."""
    position: MidiAxis | None = None
    """The axis that a fader sends to a position: once it has met the axis, so that nothing jumps."""
    speed: MidiAxis | None = None
    """The axis that a wheel with a spring (bend) moves, for as long as it keeps sending."""
    jog: MidiAxis | None = None
    """The axis that a wheel without ends (cc) moves, by `step` a click."""
    low: Finite | None = None
    """Where a fader at its lower end sends its axis, in units; the soft limit without it."""
    high: Finite | None = None
    """Where a fader at its upper end sends its axis, in units; the soft limit without it."""
    step: Annotated[Finite, Field(ge=-10, le=10)] = 0.5
    """How far a click of a wheel without ends moves its axis, in units; negative turns it round."""
    clicks: Literal["twos", "sign", "offset"] = "twos"
    """How a wheel without ends sends a click back: 127 (twos), 65 (sign) or 63 (offset)."""

    @model_validator(mode="after")
    def _one_purpose(self) -> Self:
        kinds = {
            "press": ("note", "cc"),
            "position": ("cc", "cc14", "bend"),
            "speed": ("bend",),
            "jog": ("cc",),
        }
        has = [name for name in kinds if getattr(self, name) is not None]
        if len(has) != 1:
            raise ValueError(f"{self.sends}: needs one of {', '.join(kinds)}")
        kind = control(self.sends).kind
        if kind not in kinds[has[0]]:
            raise ValueError(f"{self.sends}: {has[0]} needs {' or '.join(kinds[has[0]])}")
        if self.low is not None and self.low == self.high:
            raise ValueError(f"{self.sends}: low and high must differ")
        return self


class MidiSection(Section):
    """Faders, wheels and buttons of a MIDI controller, with feedback to it."""

    TRANSPORT: ClassVar = None

    type: Literal["midi"]
    """Faders, wheels and buttons of a MIDI controller, with feedback to it."""
    port: Annotated[str, Field(min_length=1, max_length=200)]
    """A part of the name of the controller's MIDI port; of a virtual one, its whole name."""
    feedback: Annotated[str, Field(min_length=1, max_length=200)] | None = None
    """A part of the name of the port for lights and motor faders; that of `port` without it."""
    virtual: bool = False
    """Make ports of this name, which other programs connect to (ALSA, JACK, CoreMIDI)."""
    api: MidiApi = "auto"
    """The system's MIDI: auto takes JACK where there is no other."""
    controls: Annotated[list[MidiControl], Field(min_length=1, max_length=256)]
    """Its faders, wheels and buttons."""

    @model_validator(mode="after")
    def _each_once(self) -> Self:
        seen: set[Control] = set()
        for each in self.controls:
            own = control(each.sends)
            taken = {own, own._replace(kind="cc")} if own.kind == "cc14" else {own}
            if own.kind == "cc14":
                taken.add(Control("cc", own.number + 32, own.channel))
            if seen & taken:
                raise ValueError(f"{each.sends}: is there twice")
            seen |= taken
        return self
