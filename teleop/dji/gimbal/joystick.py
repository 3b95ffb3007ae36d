"""From a joystick's analogue readings to the deflections that the gimbal is sent (V2.5 section 2.3.4.11).

The document calls `adc_range` the sampling precision; only with the half span, the largest distance from the middle,
does full stick reach 15000 (docs/protocol-facts.md).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from teleop.dji.gimbal.messages import Joystick
from teleop.dji.message import FieldError

FULL_DEFLECTION: Final = 15000

X_TO_YAW: Final = {"pitch": "y", "yaw": "x"}  # figure 19, the default
X_TO_ROLL: Final = {"pitch": "y", "roll": "x"}  # figure 20


def deflection(adc: float, middle: float, adc_range: float) -> int:
    """A reading as -15000..15000, rounded and clamped; `adc_range` is the half span, in the reading's units.

    Raises FieldError for a range that is not positive.
    """
    if not adc_range > 0:
        raise FieldError(f"gimbal.joystick: adc_range must be positive, not {adc_range:g}")
    value = round((adc - middle) / adc_range * FULL_DEFLECTION)
    return max(-FULL_DEFLECTION, min(FULL_DEFLECTION, value))


def push(deflections: Mapping[str, int], mapping: Mapping[str, str] = X_TO_YAW) -> Joystick:
    """The message for these `deflections` by stick axis; `mapping` says which of them moves pitch, roll and yaw.

    A gimbal axis that is not in the mapping stays at rest. Raises FieldError for axes that are not there.
    """
    strange = mapping.keys() - {"pitch", "roll", "yaw"} | set(mapping.values()) - deflections.keys()
    if strange:
        raise FieldError(f"gimbal.joystick: no axis {', '.join(sorted(strange))}")
    moved = {axis: deflections[stick] for axis, stick in mapping.items()}
    return Joystick(moved.get("pitch", 0), moved.get("roll", 0), moved.get("yaw", 0))
