"""How the simulated gimbal of a `sim:` link moves and reports: the `simulated` key of a gimbal in a profile."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, NamedTuple, get_args

from pydantic import BeforeValidator, Field

from teleop.config.documents.document import joined
from teleop.config.documents.messages import decimal_comma, shown
from teleop.config.simulated_firmware import SimulatedFirmwareSection
from teleop.config.wiring import Angle


class Range(NamedTuple):
    """The least and the greatest value, with their unit."""

    low: float
    high: float
    unit: str = ""

    def wrong(self, value: Any) -> str:
        """What is wrong with a value; "" for a number within the range."""
        if isinstance(value, bool) or not isinstance(value, int | float) or math.isnan(value):
            comma = decimal_comma(value)
            return f": {comma}" if comma else f"must be a number, not {shown(value)}"
        if not self.low <= value <= self.high:
            return f"must be {self.low:g}..{self.high:g}{self.unit and f' {self.unit}'}, not {value:g}"
        return ""


RANGES: Mapping[str, Range] = {
    "lag": Range(0, 2, "s"),
    "dead_time": Range(0, 1, "s"),
    "gain": Range(0.1, 3),
    "drift": Range(-10, 10, "deg/s"),
    "position_lag": Range(0, 2, "s"),
    "natural_frequency": Range(0, 50, "Hz"),
    "damping": Range(0.01, 0.99),
    "backlash": Range(0, 10, "deg"),
    "resolution": Range(0, 10, "deg"),
    "report_age": Range(0, 1, "s"),
    "noise": Range(0, 5, "deg"),
}
"""Of the keys that each axis can have a value of its own for."""
AXES: Sequence[str] = get_args(Angle)
MOUNT = Range(-180, 180, "deg")
LOST_READINGS = Range(0, 1)


def _in_range(key: str) -> BeforeValidator:
    of = RANGES[key]

    def check(value: Any) -> Any:
        if not isinstance(value, Mapping):
            if wrong := of.wrong(value):
                raise ValueError(wrong)
            return value
        for name, each in value.items():
            if name not in AXES:
                raise ValueError(f": it has no axis {shown(name)}; a gimbal has {', '.join(AXES)}")
            if wrong := of.wrong(each):
                raise ValueError(f": {joined(name, wrong)}")
        return value

    return BeforeValidator(check)


ByAxis = float | dict[Angle, float]


class SimulatedSection(SimulatedFirmwareSection):
    """How the simulated gimbal moves, reports and answers. Numbers may differ by axis: `{pan: 0.1, tilt: 0.05}`."""

    lag: Annotated[ByAxis, _in_range("lag")] = 0.05
    """Time constant with which a speed is reached, 0..2 s."""
    dead_time: Annotated[ByAxis, _in_range("dead_time")] = 0.0
    """Time from a command to its first effect, 0..1 s."""
    gain: Annotated[ByAxis, _in_range("gain")] = 1.0
    """Speed reached as a share of the commanded one, 0.1..3."""
    drift: Annotated[ByAxis, _in_range("drift")] = 0.0
    """Speed added to each commanded speed, 0 included, -10..10 deg/s."""
    position_lag: Annotated[ByAxis, _in_range("position_lag")] = 0.0
    """Time constant behind a commanded position, 0..2 s."""
    natural_frequency: Annotated[ByAxis, _in_range("natural_frequency")] = 0.0
    """Frequency of a second-order mode, 0..50 Hz; 0 for none."""
    damping: Annotated[ByAxis, _in_range("damping")] = 0.3
    """Damping of that mode as a share of the critical damping, 0.01..0.99."""
    backlash: Annotated[ByAxis, _in_range("backlash")] = 0.0
    """Backlash of the gear, 0..10 deg."""
    resolution: Annotated[ByAxis, _in_range("resolution")] = 0.1
    """Steps of the reported angles, 0..10 deg; the wire has 0.1."""
    report_age: Annotated[ByAxis, _in_range("report_age")] = 0.0
    """How much older than its question or push a reported angle is, 0..1 s."""
    noise: Annotated[ByAxis, _in_range("noise")] = 0.0
    """Noise of the reported angles: standard deviation, 0..5 deg."""
    mount: Annotated[float | None, Field(ge=MOUNT.low, le=MOUNT.high)] = None
    """Yaw in deg to which the mount is turned when the gimbal boots; unless given, the yaw of the gimbal's `mount`."""
    lost_readings: Annotated[float, Field(ge=LOST_READINGS.low, le=LOST_READINGS.high)] = 0.0
    """Share of the reported angles that get lost, 0..1."""
    bus_errors: Annotated[float, Field(ge=0, le=1)] = 0.0
    """Share of the frames that end as error frames, 0..1, as on a bus without termination."""
    adapter_reset: Annotated[float, Field(ge=0)] = 0.0
    """Time in s after which the adapter is gone once; 0: never."""
    foreign_traffic: bool = False
    """Frames of other ids, 400 a second, as gimbals send them."""

    def of(self, axis: str | None) -> dict[str, float]:
        """The values of one axis, by key; None for an axis that the mapping leaves out."""
        return dict(self._of(axis))

    def _of(self, axis: str | None) -> Iterator[tuple[str, float]]:
        for key in RANGES:
            value = getattr(self, key)
            if isinstance(value, Mapping):
                value = value.get(axis, type(self).model_fields[key].default)
            yield key, float(value)
