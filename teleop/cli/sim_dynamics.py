"""The options of `teleop sim` for how its gimbals move and report."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

from cyclopts import Group, Parameter

from teleop.config.simulated_section import LOST_READINGS, MOUNT, RANGES, Range
from teleop.core.errors import UsageError
from teleop.sim.gimbal.dynamics import Dynamics

DYNAMICS = Group("Motion of the gimbal", sort_key=3)
AXES = "yaw", "roll", "pitch"


def _by_axis(key: str, about: str) -> Parameter:
    of = RANGES[key]
    unit = f" {of.unit}" if of.unit else ""
    text = f"{about}, {of.low:g}..{of.high:g}{unit}."
    return Parameter(metavar="VALUE|AXIS=VALUE", group=DYNAMICS, help=text, show_default=False)


@Parameter(name="*")
@dataclass(frozen=True)
class DynamicsSim:
    """How the simulated gimbals move: for all axes (0.1), or for some (yaw=0.1,pitch=0.05).

    What is not given is as the rig's profile has it.
    """

    lag: Annotated[str, _by_axis("lag", "Time constant with which a speed is reached")] = ""
    dead_time: Annotated[str, _by_axis("dead_time", "Time from a command to its first effect")] = ""
    gain: Annotated[str, _by_axis("gain", "Speed reached as a share of the commanded one")] = ""
    drift: Annotated[str, _by_axis("drift", "Speed added to each commanded speed, 0 included")] = ""
    position_lag: Annotated[str, _by_axis("position_lag", "Time constant behind a commanded position")] = ""
    natural_frequency: Annotated[str, _by_axis("natural_frequency", "Frequency of a second-order mode, 0 for none")] = (
        ""
    )
    damping: Annotated[str, _by_axis("damping", "Damping of that mode as a share of the critical damping")] = ""
    backlash: Annotated[str, _by_axis("backlash", "Backlash of the gear")] = ""
    resolution: Annotated[str, _by_axis("resolution", "Steps of the reported angles; the wire has 0.1 deg")] = ""
    report_age: Annotated[str, _by_axis("report_age", "How much older than its question a reported angle is")] = ""
    noise: Annotated[str, _by_axis("noise", "Standard deviation of the reported angles")] = ""
    mount: Annotated[
        float | None,
        Parameter(metavar="DEGREES", group=DYNAMICS, help="Yaw to which the mount is turned at boot, -180..180 deg."),
    ] = None
    lost_readings: Annotated[
        float | None,
        Parameter(metavar="SHARE", group=DYNAMICS, help="Share of the reported angles that get lost, 0..1."),
    ] = None

    def settings(self, profile: Mapping[str, Any]) -> dict[str, Any]:
        """The settings of a SimulatedGimbal: those of the profile, with what was given. Raises UsageError."""
        made = dict(profile)
        dynamics = [*made.get("dynamics", [Dynamics()] * len(AXES))]
        given = {key: self._given(key) for key in RANGES}
        made["dynamics"] = [
            replace(own, **{key: given[key][axis] for key in RANGES if axis in given[key]})
            for axis, own in zip(AXES, dynamics, strict=True)
        ]
        for key, of in (("mount", MOUNT), ("lost_readings", LOST_READINGS)):
            if (value := getattr(self, key)) is not None:
                made[key] = _checked(key, value, of)
        return made

    def _given(self, key: str) -> dict[str, float]:
        values = numbers_by_axis(_option(key), getattr(self, key))
        return {axis: _checked(key, value, RANGES[key]) for axis, value in values.items()}


def numbers_by_axis(option: str, text: str) -> dict[str, float]:
    """`0.1` for every axis, `yaw=0.1,pitch=0.05` for some. Raises UsageError."""
    values: dict[str, float] = {}
    for part in filter(None, text.replace(" ", "").split(",")):
        axis, equals, written = part.rpartition("=")
        try:
            value = float(written)
        except ValueError:
            raise UsageError(f"{option} {text}: write a number, or yaw=NUMBER,pitch=NUMBER") from None
        if equals and axis not in AXES:
            raise UsageError(f"{option} {text}: write yaw, roll or pitch, as in yaw={written}")
        values |= dict.fromkeys([axis] if equals else AXES, value)
    return values


def _checked(key: str, value: float, of: Range) -> float:
    if wrong := of.wrong(value):
        raise UsageError(f"{_option(key)} {wrong}")
    return value


def _option(key: str) -> str:
    return f"--{key.replace('_', '-')}"


DYNAMICS_DEFAULTS = DynamicsSim()
