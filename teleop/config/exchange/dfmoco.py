"""`type: dfmoco` of a profile's `exchange`: Dragonframe, or another program, drives the rig as a DFMoco controller."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, Field

from teleop.config.documents.base_model import Section
from teleop.config.documents.messages import shown
from teleop.config.exchange.address import Allowed, address
from teleop.config.exchange.serial_place import SERIAL, SerialPlace, serial_place

TCP = "tcp:"
BAUD = 57600


def serial_line(listen: str) -> SerialPlace | None:
    """The device and its speed, where `listen` is a serial line. Raises ValueError."""
    if not listen.startswith(SERIAL):
        return None
    return serial_place(listen, BAUD)


def _checked(listen: str) -> str:
    if listen.startswith(TCP):
        address(listen.removeprefix(TCP))
    elif serial_line(listen) is None:
        raise ValueError(f"must be tcp:HOST:PORT or serial:DEVICE@BAUD, not {shown(listen)}")
    return listen


def _distinct(motors: list[str]) -> list[str]:
    if len(set(motors)) != len(motors):
        raise ValueError("must name each axis once")
    return motors


class DfmocoSection(Section):
    """Commands of DFMoco 2.0.0 over TCP or a serial line."""

    TRANSPORT: ClassVar = None  # as `listen` begins

    type: Literal["dfmoco"]
    """Commands of DFMoco 2.0.0 over TCP or a serial line: Dragonframe drives the rig."""
    listen: Annotated[str, AfterValidator(_checked)]
    """As tcp:HOST:PORT (Dragonframe's is 10001), or serial:DEVICE@BAUD (57600 8N1)."""
    steps_per_degree: Annotated[float, Field(gt=0, le=5000)] = 1000.0
    """Steps of a degree; a position is a whole number of them."""
    focus_steps: Annotated[int, Field(gt=0, le=5000)] = 4000
    """Steps of focus from 0 (near) to 1 (far)."""
    motors: Annotated[
        list[Literal["pan", "tilt", "roll", "focus"]], Field(min_length=1, max_length=8), AfterValidator(_distinct)
    ] = Field(default_factory=lambda: ["pan", "tilt", "roll", "focus"])
    """The axes, as motors 1, 2, 3, 4. One that the rig does not have stays at 0."""
    allow: list[Allowed] = Field(default_factory=list)
    """Addresses or networks that may move the rig; this computer and a serial line always may, and all may stop it."""
