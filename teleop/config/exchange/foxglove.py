"""`type: foxglove` of a profile's `exchange`: the topics of a take, live, for Foxglove's app."""

from __future__ import annotations

from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator

from teleop.config.documents.base_model import Section
from teleop.config.exchange.address import Allowed, Listen, address

EVERYONE = ("0.0.0.0/0", "::/0")


class FoxgloveSection(Section):
    """The topics of a take, live, by Foxglove's WebSocket protocol."""

    TRANSPORT: ClassVar = None

    type: Literal["foxglove"]
    """The topics of a take, live, by Foxglove's WebSocket protocol."""
    listen: Listen = "127.0.0.1:8765"
    """HOST:PORT where Foxglove connects."""
    allow: list[Allowed] = Field(default_factory=list)
    """Who may connect: [0.0.0.0/0] for everyone, which an address that others can reach needs."""

    @model_validator(mode="after")
    def _nobody_is_kept_out(self) -> Self:
        if any(each not in EVERYONE for each in self.allow):
            raise ValueError(f"allow may be [{EVERYONE[0]}] only: Foxglove's server cannot tell its peers apart")
        if not self.allow and not address(self.listen).is_loopback:
            raise ValueError(
                f"listen {self.listen} lets everyone on the network watch, because Foxglove's server cannot tell its "
                f"peers apart: say so with allow: [{EVERYONE[0]}], or listen at 127.0.0.1"
            )
        return self
