"""What every section of a YAML file is checked by: known keys only, values taken as they are, nothing converted."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from teleop.config.documents.messages import shown

Finite = Annotated[float, Field(allow_inf_nan=False)]


def _no_truth(value: Any) -> Any:
    if isinstance(value, bool):
        raise ValueError(f"must be a number, not {shown(value)}")
    return value


NoTruth = BeforeValidator(_no_truth)
"""For a Literal of numbers, to which pydantic counts true as 1."""


class Section(BaseModel):
    """A mapping in a file, as an immutable object.

    The docstrings of its fields are what a schema says of them (`app/json_schema`); a check need not read them.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    RENAMED: ClassVar[Mapping[str, str]] = {}
    """Old names of keys, and what they are called now: an old one is refused with its new name."""


class PositionsSection(Section):
    """Positions of axes by their names, in the axes' units; None for one that is not given."""

    pan: Finite | None = None
    """Pan in deg; + is right."""
    tilt: Finite | None = None
    """Tilt in deg; + is up."""
    roll: Finite | None = None
    """Roll in deg; + is clockwise seen from behind the camera."""
    focus: Finite | None = None
    """Focus, 0 (near) to 1 (far)."""
    stick_roll: Finite | None = None
    """Right stick of the drone sideways, -1 to 1; + is right."""
    stick_pitch: Finite | None = None
    """Right stick of the drone forward, -1 to 1; + is forward."""
    stick_throttle: Finite | None = None
    """Left stick of the drone up, -1 to 1; + is up."""
    stick_yaw: Finite | None = None
    """Left stick of the drone sideways, -1 to 1; + turns clockwise seen from above."""
