"""The drone of a run: what is checked before a port opens, and what is recorded and shown of it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import fields, is_dataclass

from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.core.errors import UsageError
from teleop.devices.drone.sink import DroneSink
from teleop.devices.drone.state import DroneState
from teleop.devices.rig import Rig

HOVER = 10.0  # m


def is_flown(axes: Collection[Axis]) -> bool:
    return any(axis.is_stick for axis in axes)


def refuse_offsets(profile: Profile) -> None:
    """Raises UsageError for a drone whose sticks are places: a hand cannot hold one, a sequence can."""
    for section in profile.sinks:
        if section.type == "flight" and section.mode.startswith("offset"):
            raise UsageError(f"mode: {section.mode} is for sequences: teleop play; a stick is a velocity or a tilt")


class Aboard:
    """The drone of a run, once its rig is open; until then, and in a rig without one, nothing."""

    def __init__(self) -> None:
        self._drone: DroneSink | None = None
        self._now: Callable[[], float] = lambda: 0.0

    def board(self, rig: Rig, axes: Collection[Axis], notify: Callable[[str], object], by_script: bool) -> None:
        """`notify` is for what the drone says; `by_script` engages it at the start.

        A drone is flown up by its pilot before a script has it, so a simulated one is found in the air.
        """
        self._drone, self._now = rig.drone(list(axes)), rig.clock.now
        if self._drone is None:
            return
        self._drone.notify, self._drone.by_script = notify, by_script
        for simulated in rig.simulated_drones.values() if by_script else ():
            simulated.autopilot.flight.hover(HOVER)
            notify(f"the simulated drone hovers at {HOVER:g} m")

    def state(self) -> DroneState | None:
        return self._drone.state(self._now()) if self._drone else None

    def status(self, of: object = None) -> object:
        """What a take records beside the motion: the operator's status, if any, and what is known of the drone."""
        state = self.state()
        if state is None:
            return of
        own: Mapping[str, object] = {}
        if is_dataclass(of) and not isinstance(of, type):
            own = {each.name: getattr(of, each.name) for each in fields(of)}
        return {**own, "drone": state}
