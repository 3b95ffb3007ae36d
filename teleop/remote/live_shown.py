"""What clients see of a rig in an operator's hands."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from teleop.config.presets import Presets
from teleop.core.axes import Axis
from teleop.devices.drone.state import DroneState
from teleop.manual.operator import Operator
from teleop.manual.status import OperatorStatus
from teleop.remote.jobs import JobSource
from teleop.remote.keys import HandKeys
from teleop.remote.pass_errors import ShownPasses
from teleop.remote.play_job import PlayJob
from teleop.remote.shoot_job import ShootJob


class LiveShown:
    """`drone` is what is known of the drone, None in a rig without one."""

    def __init__(
        self,
        operator: Operator,
        presets: Presets,
        jobs: JobSource,
        keys: HandKeys,
        passes: ShownPasses,
        drone: Callable[[], DroneState | None],
    ) -> None:
        self._operator, self._presets, self._jobs, self._keys = operator, presets, jobs, keys
        self._passes, self._drone = passes, drone

    @property
    def status(self) -> OperatorStatus:
        return self._operator.status

    @property
    def stopped_by(self) -> str:
        return self._operator.stopped_by

    @property
    def changes(self) -> object:
        return self._keys.changes, self._presets.changes

    @property
    def errors(self) -> Mapping[str, Any] | None:
        return self._passes.shown

    @property
    def battery(self) -> float | None:
        return battery(self._drone())

    @property
    def keys(self) -> Sequence[Mapping[str, float]]:
        return self._keys.keys

    @property
    def presets(self) -> Mapping[str, Mapping[str, Any]]:
        return {str(number): self._preset(number) for number in self._presets.names}

    def _preset(self, number: int) -> Mapping[str, Any]:
        preset = self._presets.get(number)
        if preset is None:
            return {}
        named = {"name": preset.name} if preset.name else {}
        return {**{axis.value: position for axis, position in preset.positions.items()}, **named}

    def drivers(self) -> Mapping[Axis, str]:
        job = self._jobs.job
        if job is None or (isinstance(job, PlayJob | ShootJob) and job.paused):
            return {}
        return dict.fromkeys(job.axes, job.title)

    def move(self, now: float) -> Mapping[str, Any] | None:
        job = self._jobs.job
        return job.state(now) if isinstance(job, PlayJob) else None

    def shoot(self, now: float) -> Mapping[str, Any] | None:
        job = self._jobs.job
        return job.state(now) if isinstance(job, ShootJob) else None


def battery(drone: DroneState | None) -> float | None:
    """In %, None where it is not known: a gimbal does not report its own."""
    return None if drone is None else drone.battery
