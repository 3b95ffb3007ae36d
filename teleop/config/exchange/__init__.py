"""The `exchange` of a profile: what the gateway speaks with the rest of a studio; each type a module of its section."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, TypeGuard

from pydantic import Field, TypeAdapter

from teleop.config.documents.document import Wrong
from teleop.config.exchange import freed, opentrackio
from teleop.config.exchange.dfmoco import DfmocoSection
from teleop.config.exchange.foxglove import FoxgloveSection
from teleop.config.exchange.freed import FreeDSection
from teleop.config.exchange.midi import MidiSection
from teleop.config.exchange.opentrackio import OpenTrackIOSection
from teleop.config.exchange.osc import OscSection
from teleop.config.exchange.timecode import TimecodeSection
from teleop.config.exchange.tracking import TrackingSection, tracking_rules
from teleop.config.exchange.zenoh import ZenohSection

ExchangeSection = Annotated[
    DfmocoSection
    | FoxgloveSection
    | FreeDSection
    | MidiSection
    | OpenTrackIOSection
    | OscSection
    | TimecodeSection
    | ZenohSection,
    Field(discriminator="type"),
]

ENTRIES: TypeAdapter[list[ExchangeSection]] = TypeAdapter(list[ExchangeSection])
"""The entries as the gateway is told them."""


def exchange_rules(data: Any) -> Iterator[Wrong]:
    """What is wrong with the entries beyond their single values; `data` is the whole profile, unchecked."""
    yield from tracking_rules(data, {"freed": freed.OUT, "opentrackio": opentrackio.OUT})


def tracks(entry: object) -> TypeGuard[TrackingSection]:
    """Whether an aim may follow what comes in there; these entries are counted from 1."""
    return isinstance(entry, TrackingSection) and entry.listen is not None
