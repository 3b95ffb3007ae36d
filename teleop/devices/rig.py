"""A profile brought to life: its links open, its devices at hand, and all of it closed in reverse whatever happens.

Devices that share a link share one connection, because two frames must never interleave on a bus. A simulated
device is an ordinary one on a link that ends in this process. Whether a link ends at a gimbal or at a drone follows
from the sinks that use it.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from types import MappingProxyType

from teleop.config.credentials import app_cipher
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.config.sinks_section import (
    GimbalSection,
    SinkSection,
)
from teleop.core.axes import Axis
from teleop.core.control_loop import ControlLoop
from teleop.core.errors import LinkError, TeleopError
from teleop.core.interfaces import Clock, Observer, Sink, Source
from teleop.core.response import Response
from teleop.core.timing import LoopTiming
from teleop.devices.builders import BUILDERS, Device, gimbal_device
from teleop.devices.camera import CameraSink
from teleop.devices.connection import Connection
from teleop.devices.drone.sink import DroneSink
from teleop.devices.gimbal.guard_notes import GuardNotes
from teleop.devices.gimbal.outlook import Foreseen
from teleop.devices.gimbal.simulated import simulated_gimbal, simulated_wire
from teleop.devices.gimbal.speed_control import SpeedControl
from teleop.dji.drone.session import OnboardSession
from teleop.dji.gimbal.session import Session
from teleop.links import open_link, parse
from teleop.monitors.following_error import FollowingErrorGuard
from teleop.planner.live import Live
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.link import SimLink

HOLDING = 0.04  # s between looks at a resting axis that may drift: what is sent speeds holds no place by itself
DRONE_FIRST_REPORT = 8.0  # s: an activation may be asked for three times, a second each


class Rig:
    """An open rig.

    By link name: `connections`, and `simulated` and `simulated_drones`, the devices behind the links that are `sim:`.
    """

    def __init__(
        self,
        profile: Profile,
        clock: Clock,
        devices: Sequence[Device],
        connections: Mapping[str, Connection],
        simulated: Mapping[str, SimulatedGimbal],
        simulated_drones: Mapping[str, SimulatedDrone],
    ) -> None:
        self.profile, self.clock, self.connections = profile, clock, connections
        self.simulated, self.simulated_drones = simulated, simulated_drones
        self._devices = devices

    def drone(self, axes: Sequence[Axis]) -> DroneSink | None:
        """The drone that moves some of the axes."""
        sinks = [device.sink for device in self._used(axes) if isinstance(device.sink, DroneSink)]
        return sinks[0] if sinks else None

    @property
    def axes(self) -> Sequence[Axis]:
        """Those that some device here moves."""
        return [axis for axis in self.profile.axes if any(axis in device.moves for device in self._devices)]

    @property
    def devices(self) -> Sequence[Device]:
        return self._devices

    @property
    def camera(self) -> CameraSink | None:
        """The camera that the profile names."""
        return next((device.sink for device in self._devices if isinstance(device.sink, CameraSink)), None)

    @property
    def _controls(self) -> Sequence[SpeedControl]:
        """Of the devices that are sent speeds."""
        return [device.control for device in self._devices if device.control is not None]

    def _used(self, axes: Sequence[Axis]) -> Sequence[Device]:
        return [device for device in self._devices if not device.moves or set(device.moves) & set(axes)]

    @property
    def responses(self) -> Mapping[Axis, Response]:
        """How each axis answers that a gimbal moves, and that has moved enough to be sure of it."""
        seen = [each for device in self._devices for each in (device.control, device.watch) if each is not None]
        return {axis: response for each in seen for axis, response in each.responses.items()}

    @property
    def relied_on(self) -> Mapping[Axis, Response]:
        """Those of the responses by which speeds are corrected: none where the profile's delay counts."""
        return {axis: response for control in self._controls for axis, response in control.relied_on.items()}

    @property
    def changed(self) -> Collection[Axis]:
        """The axes that have answered otherwise than was known of them before."""
        return {axis for control in self._controls for axis in control.changed}

    def suppose(self, priors: Mapping[Axis, Response | None]) -> None:
        """Take other priors for these axes, which are identified anew from them; None is no prior."""
        for control in self._controls:
            for axis in control.estimators.keys() & priors.keys():
                control.estimators[axis].suppose(priors[axis])

    def _obeys(self, axis: Axis, since: float) -> bool | None:
        controls = [device.control for device in self._devices if device.control and axis in device.moves]
        return controls[0].estimators[axis].obeys(since) if controls else None

    def foresee(self, foreseen: Foreseen | None) -> None:
        """Have what is sent speeds led by a plan that is known ahead: where it will be at a time of the loop's.

        None ends that.
        """
        for control in self._controls:
            control.foresee(foreseen)

    def rest_needed(self, axes: Collection[Axis]) -> float:
        """How long (s) the axes should rest before a move at least, by what is known of how they answer."""
        return max((control.rest_needed(axes) for control in self._controls), default=0.0)

    def notes(self, notify: Callable[[str], object]) -> GuardNotes:
        """An observer that says when a soft limit holds an axis back, and when one answers otherwise than before."""
        return GuardNotes([device.lines for device in self._devices if device.lines is not None], notify)

    def loop(
        self,
        axes: Sequence[Axis],
        sources: Sequence[Source],
        observers: Sequence[Observer] = (),
        sinks: Sequence[Sink] = (),
    ) -> ControlLoop:
        """A run of `sources` over the axes in use; devices that move none of them are left alone.

        `sinks` come after those of the devices, `observers` after every sink and the guards.
        """
        limits = {axis: self.profile.limits[axis] for axis in axes}
        used = self._used(axes)
        reporters = [device.reporter for device in used if device.reporter is not None]
        measured = [(axis, device) for device in used for axis in device.moves if axis in limits]
        guard = FollowingErrorGuard(
            limits,
            {axis: device.follow for axis, device in measured if device.follow is not None},
            {axis: device.delay for axis, device in measured},
            [device.direction.found for device in used if device.direction],
            self._obeys,
        )
        timing = LoopTiming(keep_alive=HOLDING) if any(device.control for device in used) else LoopTiming()
        if drone := self.drone(axes):
            timing = LoopTiming(keep_alive=drone.period, first_report=DRONE_FIRST_REPORT)
        directions = [guard for device in used for guard in (device.direction, device.exchange) if guard]
        return ControlLoop(
            self.clock,
            Live(limits, timing.period),
            limits,
            sources,
            [*(device.sink for device in used), *sinks],
            reporters,
            [*directions, guard, *observers],
            timing,
        )


@contextmanager
def open_rig(
    profile: Profile,
    clock: Clock,
    absent: Callable[[str, TeleopError], object] | None = None,
    priors: Mapping[Axis, Response] = MappingProxyType({}),
) -> Iterator[Rig]:
    """The rig with its links open; raises LinkError when one cannot be opened, and closes those that were.

    Raises DocumentError when a drone on a real link has no credentials. With `absent` the rig does without the devices
    on an optional link that cannot be opened, and `absent` is called with the link's name and the reason. `priors` are
    the responses that were found before; each is verified in the first motion before it is fully used.
    """
    with ExitStack() as stack:
        opening = _Opening(profile, clock, stack, priors)
        for name in profile.links:
            try:
                opening.open(name)
            except (LinkError, DocumentError) as error:
                if absent is None or name not in profile.optional:
                    raise
                absent(name, error)
        yield opening.rig()


class _Opening:
    """A rig while its links are opened, one after the other, until `stack` is left."""

    def __init__(self, profile: Profile, clock: Clock, stack: ExitStack, priors: Mapping[Axis, Response]) -> None:
        self._priors = priors
        self._profile, self._clock, self._stack = profile, clock, stack
        self._devices: dict[int, Device] = {}  # by their places among the profile's sinks
        self._connections: dict[str, Connection] = {}
        self._simulated: dict[str, SimulatedGimbal] = {}
        self._drones: dict[str, SimulatedDrone] = {}

    def open(self, name: str) -> None:
        """Open a link and what is at its end. Raises LinkError and DocumentError."""
        with ExitStack() as stack:
            connection = self._connected(name, stack)
            for place, section in enumerate(self._profile.sinks):
                if section.link == name:
                    self._devices[place] = self._device(section, connection)
            self._connections[name] = connection
            self._stack.push(stack.pop_all())

    def _device(self, section: SinkSection, connection: Connection) -> Device:
        limits = self._profile.limits
        if isinstance(section, GimbalSection):
            return gimbal_device(section, connection, limits, self._priors)
        return BUILDERS[section.type](section, connection, limits)

    def rig(self) -> Rig:
        profile = self._profile.with_links(self._connections)
        devices = [device for _, device in sorted(self._devices.items(), key=lambda item: item[0])]
        return Rig(profile, self._clock, devices, self._connections, self._simulated, self._drones)

    def _connected(self, name: str, stack: ExitStack) -> Connection:
        profile, clock, url = self._profile, self._clock, self._profile.links[name]
        session: Session | OnboardSession = Session(first_sequence=_unlike_others(clock))
        if name in profile.drones:
            session = OnboardSession(first_sequence=_unlike_the_last())
        if parse(url).kind != "sim":
            link = open_link(url, now=clock.now)
            stack.callback(link.close)
            return Connection(name, url, link, clock.now(), link.counts, session)
        far: SimulatedGimbal | SimulatedDrone
        if name in profile.drones:
            far = self._drones[name] = SimulatedDrone(now=clock.now(), cipher=app_cipher(name in profile.encrypted))
        else:
            far = self._simulated[name] = simulated_gimbal(profile, name, SimulatedGimbal)
            wire = simulated_wire(profile, name, far, clock.now)
            return Connection(name, url, wire, clock.now(), wire.counts, session)
        return Connection(name, url, SimLink(far, clock.now), clock.now(), None, session)


def _unlike_the_last() -> int:
    """Where a session with a drone begins to number: the same numbers as a run before would look like its retries."""
    return secrets.randbelow(0x10000)


def _unlike_others(clock: Clock) -> int:
    """Where a session with a gimbal begins to number: elsewhere than another program on its bus, by the time in us."""
    return round(clock.now() * 1e6) & 0xFFFF
