"""A profile brought to life: its links open, its devices at hand, and all of it closed in reverse whatever happens.

Which class serves a type of sink is a row in a table. Devices that share a link share one connection, because two
frames must never interleave on a bus. A simulated device is an ordinary one on a link that ends in this process.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

from teleop.links import open_link, parse
from teleop.loop import PERIOD, Loop
from teleop.motion import Axis, Limits
from teleop.planner.live import Live
from teleop.ports import Clock, Reporter, Sink, Source
from teleop.profile import MOVES, CameraSection, FocusSection, GimbalSection, Profile
from teleop.sim.gimbal import SimulatedGimbal
from teleop.sim.link import SimLink
from teleop.sinks.camera import CameraSink
from teleop.sinks.connection import Connection
from teleop.sinks.correction import Gains
from teleop.sinks.focus import FocusReporter, FocusSink
from teleop.sinks.gimbal import Angles, PositionSink
from teleop.sinks.gimbal_speed import SpeedSink
from teleop.sinks.gimbal_stick import StickSink
from teleop.sinks.stall import StallGuard
from teleop.sinks.wiring import Wiring


@dataclass(frozen=True)
class Device:
    """What serves one entry of a profile's sinks, and the axes it can move.

    `follow` is how far from commanded these may be found, in units, and `delay` how much later than that they move (s).
    """

    moves: Sequence[Axis]
    sink: Sink
    reporter: Reporter | None
    follow: float = 0.0
    delay: float = 0.0


class Rig:
    """An open rig. By link name, `connections` and `simulated`, the devices behind the links that are `sim:`."""

    def __init__(
        self,
        profile: Profile,
        clock: Clock,
        devices: Sequence[Device],
        connections: Mapping[str, Connection],
        simulated: Mapping[str, SimulatedGimbal],
    ) -> None:
        self.profile, self.clock, self.connections, self.simulated = profile, clock, connections, simulated
        self._devices = devices

    def loop(self, axes: Sequence[Axis], sources: Sequence[Source], watchers: Sequence[Sink] = ()) -> Loop:
        """A run of `sources` over the axes in use; devices that move none of them are left alone.

        `watchers` are sinks that only look on, and see each tick after the devices.
        """
        limits = {axis: self.profile.limits[axis] for axis in axes}
        used = [device for device in self._devices if not device.moves or set(device.moves) & set(axes)]
        sinks = [device.sink for device in used]
        reporters = [device.reporter for device in used if device.reporter is not None]
        guarded = {axis: device for device in used for axis in device.moves if axis in limits}
        guard = StallGuard(
            limits,
            {axis: device.follow for axis, device in guarded.items()},
            {axis: device.delay for axis, device in guarded.items()},
        )
        planner = Live(limits, PERIOD)
        return Loop(self.clock, planner, limits, sources, [*sinks, guard, *watchers], reporters)


@contextmanager
def open_rig(profile: Profile, clock: Clock) -> Iterator[Rig]:
    """The rig with its links open; raises LinkError when one cannot be opened, and closes those that were."""
    with ExitStack() as stack:
        simulated: dict[str, SimulatedGimbal] = {}
        connections: dict[str, Connection] = {}
        for name, url in profile.links.items():
            if parse(url).kind == "sim":
                simulated[name] = SimulatedGimbal(continuous=_turns_for_ever(profile))
                sim = SimLink(simulated[name], clock.now)
                connections[name] = Connection(name, url, sim, clock.now())
            else:
                link = open_link(url, now=clock.now)
                stack.callback(link.close)
                connections[name] = Connection(name, url, link, clock.now(), link.counts)
        limits = profile.limits
        devices = [BUILDERS[section.type](section, connections[section.link], limits) for section in profile.sinks]
        yield Rig(profile, clock, devices, connections, simulated)


def _turns_for_ever(profile: Profile) -> bool:
    """Whether the simulated gimbal must, because the profile says that the real one does."""
    return Axis.PAN in profile.limits and profile.limits[Axis.PAN].continuous


def _gimbal(section: GimbalSection, connection: Connection, limits: Mapping[Axis, Limits]) -> Device:
    wiring = Wiring(section.axes, {Axis(axis): sign for axis, sign in section.signs.items()})
    own = {axis: limits[axis] for axis in section.axes if axis is not None and axis in limits}
    gains = Gains(section.gains.proportional, section.gains.integral)
    sink: Sink
    match section.mode:
        case "position":
            sink = PositionSink(connection, section.rate, section.delay, wiring, own)
        case "speed":
            sink = SpeedSink(connection, section.rate, section.delay, wiring, own, gains)
        case "stick":
            full = {axis: section.full(axis, of.velocity) for axis, of in own.items()}
            sink = StickSink(connection, section.rate, section.delay, wiring, own, full, gains)
    return Device(list(own), sink, Angles(connection, wiring), section.follow, section.delay)


def _focus(section: FocusSection, connection: Connection, limits: Mapping[Axis, Limits]) -> Device:  # noqa: ARG001
    return Device(MOVES[section.type], FocusSink(connection, section.rate), FocusReporter(connection), section.follow)


def _camera(section: CameraSection, connection: Connection, limits: Mapping[Axis, Limits]) -> Device:  # noqa: ARG001
    return Device(MOVES[section.type], CameraSink(connection), None)


BUILDERS: Mapping[str, Callable[..., Device]] = {"gimbal": _gimbal, "focus": _focus, "camera": _camera}
