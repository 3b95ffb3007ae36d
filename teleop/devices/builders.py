"""What serves each entry of a profile's sinks: the device with its guards, on the connection of its link.

Which class serves a type of sink is a row in the table at the end; a gimbal also takes what was found of its axes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from teleop.config.credentials import app_cipher, load_credentials
from teleop.config.flight_modes import FLIGHT_MODES, combination_of
from teleop.config.sinks_section import (
    MOVES,
    CameraSection,
    FlightSection,
    FocusSection,
    GimbalSection,
    VirtualRcSection,
)
from teleop.core.axes import Axis, Limits
from teleop.core.interfaces import Reporter, Sink
from teleop.core.response import Response
from teleop.devices.camera import CameraSink
from teleop.devices.connection import Connection
from teleop.devices.drone.control_mode import ControlMode
from teleop.devices.drone.last_enable import LastEnable, default_file
from teleop.devices.drone.movement import MovementControl
from teleop.devices.drone.preflight import Site
from teleop.devices.drone.sink import DroneSink
from teleop.devices.drone.telemetry import Telemetry
from teleop.devices.drone.virtual_rc import VirtualRcControl
from teleop.devices.focus import FocusReporter, FocusSink
from teleop.devices.gimbal.pi_correction import Gains
from teleop.devices.gimbal.position import Angles, PositionSink
from teleop.devices.gimbal.position_watch import PositionWatch
from teleop.devices.gimbal.speed import SpeedSink
from teleop.devices.gimbal.speed_control import SpeedControl
from teleop.devices.gimbal.stick import StickSink
from teleop.dji.drone.messages import Activate
from teleop.monitors.direction import DirectionGuard
from teleop.monitors.exchanged_axes import ExchangedAxesGuard


@dataclass(frozen=True)
class Device:
    """What serves one entry of a profile's sinks, and the axes it can move.

    `follow` is how far from commanded these may be found, in units, None where they are not measured, and `delay` how
    much later than that they move (s).
    """

    moves: Sequence[Axis]
    sink: Sink
    reporter: Reporter | None
    follow: float | None = 0.0
    delay: float = 0.0
    direction: DirectionGuard | None = None  # what notices that an axis goes the other way
    exchange: ExchangedAxesGuard | None = None  # and that one axis is reported in the place of another
    control: SpeedControl | None = None  # what identifies the axes that are sent speeds
    watch: PositionWatch | None = None  # what sees how late the axes are that are sent positions
    lines: list[str] | None = None  # what its guards have to say


def gimbal_device(
    section: GimbalSection, connection: Connection, limits: Mapping[Axis, Limits], priors: Mapping[Axis, Response]
) -> Device:
    wiring = section.wiring
    own = {axis: limits[axis] for axis in section.axes if axis is not None and axis in limits}
    delay = section.delay or 0.0
    guard = DirectionGuard(section.sign_line, delay, speeds=section.mode != "position")
    gains = Gains(section.gains.proportional, section.gains.integral)
    reporter = Angles(connection, wiring, section.legacy_angles)
    exchange = _exchange_guard(section, reporter, guard.found)

    def sent(now: float, speeds: Mapping[Axis, float]) -> None:
        guard.sent(now, speeds)
        if exchange:
            exchange.sent(now, speeds)

    sink: Sink
    match section.mode:
        case "position":
            sink = PositionSink(connection, section.rate, delay, wiring, own, guard.found)
        case "speed":
            sink = SpeedSink(connection, section.rate, section.delay, wiring, own, gains, sent, priors)
        case "stick":
            full = {axis: section.full(axis, of.velocity) for axis, of in own.items()}
            sink = StickSink(connection, section.rate, section.delay, wiring, own, full, gains, sent, priors)
    control = None if isinstance(sink, PositionSink) else sink.control
    watch = sink.watch if isinstance(sink, PositionSink) else None
    lines = sink.guard.lines if isinstance(sink, PositionSink) else sink.control.lines
    return Device(list(own), sink, reporter, section.max_following_error, delay, guard, exchange, control, watch, lines)


def _exchange_guard(section: GimbalSection, reporter: Angles, found: set[Axis]) -> ExchangedAxesGuard | None:
    """None for a gimbal that drives only one of pitch and roll."""
    pair, wiring = section.pitch_and_roll, section.wiring
    if pair is None:
        return None
    ratio = wiring.report_sign(pair[0]) * wiring.report_sign(pair[1])
    return ExchangedAxesGuard(
        *(pair, ratio, lambda: section.order_line(reporter.bare), section.delay or 0.0),
        section.mode != "position",
        found,
    )


def _focus(section: FocusSection, connection: Connection, limits: Mapping[Axis, Limits]) -> Device:  # noqa: ARG001
    sink, reporter = FocusSink(connection, section.rate), FocusReporter(connection)
    return Device(MOVES[section.type], sink, reporter, section.max_following_error)


def _camera(section: CameraSection, connection: Connection, limits: Mapping[Axis, Limits]) -> Device:  # noqa: ARG001
    return Device(MOVES[section.type], CameraSink(connection), None)


def _virtual_rc(section: VirtualRcSection, connection: Connection, limits: Mapping[Axis, Limits]) -> Device:  # noqa: ARG001
    last = None if connection.simulated else LastEnable(default_file())
    mode = VirtualRcControl(connection, section.back_to_rc, section.go_home, last)
    return _drone(section, mode, connection)


def _flight(section: FlightSection, connection: Connection, limits: Mapping[Axis, Limits]) -> Device:  # noqa: ARG001
    site = Site(section.guidance, section.indoors)
    combination, frame = combination_of(section.mode, section.vertical, section.yaw), FLIGHT_MODES[section.mode][1]
    mode = MovementControl(connection, combination, frame, section.full_scale.model_dump(), site)
    return _drone(section, mode, connection)


def _drone(section: VirtualRcSection | FlightSection, mode: ControlMode, connection: Connection) -> Device:
    activation = Activate(0) if connection.simulated else load_credentials().activation()
    telemetry = Telemetry(connection, activation, app_cipher(section.encrypted))
    sink = DroneSink(mode, telemetry, connection.opened, section.low_battery)
    return Device(MOVES[section.type], sink, sink, follow=None)


BUILDERS: Mapping[str, Callable[..., Device]] = {
    "focus": _focus,
    "camera": _camera,
    "virtual-rc": _virtual_rc,
    "flight": _flight,
}
