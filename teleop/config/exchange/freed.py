"""`type: freed` of a profile's `exchange`: camera tracking as FreeD D1 messages."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from teleop.config.documents.base_model import Finite, Section
from teleop.config.exchange.address import To


class FreeDSection(Section):
    """The camera's measured attitude as FreeD D1 over UDP."""

    TRANSPORT: ClassVar = None

    type: Literal["freed"]
    """The camera's measured attitude as FreeD D1 over UDP."""
    to: To
    """HOST:PORT of the receiver."""
    camera: Annotated[int, Field(ge=0, le=255)] = 1
    """The camera's number in the messages."""
    rate: Annotated[float, Field(gt=0, le=100)] = 50.0
    """Messages per second (Hz)."""
    position: Annotated[list[Finite], Field(min_length=3, max_length=3)] = Field(
        default_factory=lambda: [0.0, 0.0, 0.0]
    )
    """Where the camera is, in m: X right, Y forward, Z up."""
