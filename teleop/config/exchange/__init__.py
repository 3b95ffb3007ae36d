"""The `exchange` of a profile: what the gateway speaks with the rest of a studio; each type a module of its section."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, TypeAdapter

from teleop.config.exchange.dfmoco import DfmocoSection
from teleop.config.exchange.foxglove import FoxgloveSection
from teleop.config.exchange.freed import FreeDSection
from teleop.config.exchange.midi import MidiSection
from teleop.config.exchange.osc import OscSection
from teleop.config.exchange.timecode import TimecodeSection

ExchangeSection = Annotated[
    DfmocoSection | FoxgloveSection | FreeDSection | MidiSection | OscSection | TimecodeSection,
    Field(discriminator="type"),
]

ENTRIES: TypeAdapter[list[ExchangeSection]] = TypeAdapter(list[ExchangeSection])
"""The entries as the gateway is told them."""
