"""`type: osc` of a profile's `exchange`: buttons and faders that speak Open Sound Control."""

from __future__ import annotations

from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator

from teleop.config.documents.base_model import Section
from teleop.config.exchange.address import Allowed, Listen, To


class OscSection(Section):
    """Commands and feedback as OSC messages over UDP."""

    TRANSPORT: ClassVar = "udp"

    type: Literal["osc"]
    """Commands and feedback as OSC messages over UDP."""
    listen: Listen | None = None
    """HOST:PORT where commands arrive."""
    to: To | None = None
    """HOST:PORT that is sent the feedback."""
    allow: list[Allowed] = Field(default_factory=list)
    """Addresses or networks whose commands are taken; those of this computer always are, and stop from anywhere."""

    @model_validator(mode="after")
    def _does_something(self) -> Self:
        if self.listen is None and self.to is None:
            raise ValueError("needs listen, to, or both")
        return self
