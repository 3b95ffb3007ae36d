"""What is known of a drone, as one immutable value: for the live view, a take and a report."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from teleop.core.axes import Axis
from teleop.devices.drone.control_mode import Deflections, attitude, word_of
from teleop.devices.drone.engagement import Stage
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone.enums import RcMode


@dataclass(frozen=True, slots=True)
class DroneState:
    """`stage` is the engagement's, `sticks` are what is sent while it is engaged; the rest is what the drone says.

    None is what it does not say, or no longer. Angles are in deg, latitude and longitude too; roll right, pitch nose
    up and yaw from north to east are positive. Height is in m, velocity north, east and up in m/s, battery in %. `rc`
    are its sticks, -1..1, and `rc_mode` is its mode switch. `virtual_rc` is the bit that says whether that is on.
    """

    stage: str
    sticks: Mapping[Axis, float]
    activated: bool
    status: str | None = None
    attitude: tuple[float, float, float] | None = None
    latitude: float | None = None
    longitude: float | None = None
    height: float | None = None
    gps_health: int | None = None
    velocity: tuple[float, float, float] | None = None
    battery: int | None = None
    rc: tuple[float, float, float, float] | None = None
    rc_mode: str | None = None
    gimbal: tuple[float, float, float] | None = None
    device: str | None = None
    virtual_rc: bool | None = None


def drone_state(seen: Telemetry, now: float, stage: Stage, sticks: Deflections) -> DroneState:
    """The state at `now` (s)."""
    parts = {
        name: seen.get(name, now)
        for name in ("quaternion", "velocity", "position", "rc", "gimbal", "status", "battery", "control")
    }
    position, velocity, rc = parts["position"], parts["velocity"], parts["rc"]
    gimbal, control, quaternion = parts["gimbal"], parts["control"], parts["quaternion"]
    return DroneState(
        stage=stage.value,
        sticks=sticks,
        activated=seen.activated,
        status=None if parts["status"] is None else word_of(parts["status"]),
        attitude=None if quaternion is None else attitude(quaternion),
        latitude=None if position is None else math.degrees(position.latitude),
        longitude=None if position is None else math.degrees(position.longitude),
        height=None if position is None else position.height,
        gps_health=None if position is None else position.health,
        velocity=None if velocity is None or not velocity.valid else (velocity.x, velocity.y, velocity.z),
        battery=parts["battery"],
        rc=None if rc is None else (rc.roll / 1e4, rc.pitch / 1e4, rc.throttle / 1e4, rc.yaw / 1e4),
        rc_mode=None if rc is None else rc.mode.name if isinstance(rc.mode, RcMode) else str(rc.mode),
        gimbal=None if gimbal is None else (gimbal.roll, gimbal.pitch, gimbal.yaw),
        device=None if control is None else word_of(control.device),
        virtual_rc=None if control is None else control.virtual_rc,
    )
