"""Which devices of a rig are there when a live run begins: what is absent takes its own axes out, and no others.

A gimbal has to be there. A focus motor, a camera and a drone do not: a hand on the sticks can do without them, where a
sequence that moves them cannot. Each is given as long to answer as the loop would give it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from types import MappingProxyType

from teleop.config.profile import Profile
from teleop.config.sinks_section import MOVES
from teleop.core.axes import Axis
from teleop.core.errors import DeviceError, LinkError, TeleopError
from teleop.core.interfaces import Clock
from teleop.core.response import Response
from teleop.core.timing import FIRST_REPORT, PERIOD
from teleop.devices.builders import Device
from teleop.devices.gimbal.position import Angles
from teleop.devices.rig import DRONE_FIRST_REPORT, Rig, open_rig

CURES = {
    Axis.FOCUS: "plug it in, switch the wheel to CAN and calibrate it (teleop send focus calibrate auto)",
    Axis.STICK_ROLL: "switch it on, check its cable",
}


def open_present(
    stack: ExitStack, profile: Profile, clock: Clock, priors: Mapping[Axis, Response] = MappingProxyType({})
) -> tuple[Rig, Sequence[Axis], Sequence[str]]:
    """The rig, open until the stack is left, the axes that are there, and a line for each device that is not.

    Raises LinkError, DeviceError and DocumentError for what has to be there, or where nothing is left to be moved.
    """
    notes: list[str] = []
    reasons: list[TeleopError] = []

    def absent(link: str, reason: TeleopError) -> None:
        reasons.append(reason)
        moved = [axis for section in profile.sinks if section.link == link for axis in MOVES[section.type]]
        axes = [axis for axis in moved if axis in profile.axes]
        notes.append(_left_out(axes, reason) if axes else f"the camera is left out: {reason}")

    rig = stack.enter_context(open_rig(profile, clock, absent, priors))
    axes = list(rig.axes)
    for device, reason in _silent(rig, clock):
        reasons.append(reason)
        notes.append(_left_out([axis for axis in device.moves if axis in axes], reason))
        axes = [axis for axis in axes if axis not in device.moves]
    if not axes:
        raise reasons[0]
    return rig, axes, notes


def _silent(rig: Rig, clock: Clock) -> list[tuple[Device, TeleopError]]:
    """The optional devices that do not say where their axes are, and why. Raises what another device raises."""
    waiting = [device for device in rig.devices if _is_optional(device) and device.reporter is not None]
    absent: list[tuple[Device, TeleopError]] = []
    begin = clock.now()
    while waiting:
        now = clock.now()
        for device in rig.devices:
            if device.reporter is not None and isinstance(device.reporter, Angles):
                device.reporter.report(now)  # or a link on which only the focus motor is silent would seem lost
        for device in list(waiting):
            if answered := _answer(device, now, begin):
                waiting.remove(device)
                if isinstance(answered, TeleopError):
                    absent.append((device, answered))
        clock.sleep_until(now + PERIOD)
    return absent


def _answer(device: Device, now: float, begin: float) -> TeleopError | bool:
    """Whether the device has reported its axes, or its absence is explained; False until then."""
    assert device.reporter is not None
    try:
        readings = device.reporter.report(now)
    except (LinkError, DeviceError) as error:
        return error
    if any(axis in readings for axis in device.moves):
        return True
    drone = any(axis.is_stick for axis in device.moves)
    if now - begin > (DRONE_FIRST_REPORT if drone else FIRST_REPORT):
        return DeviceError(f"the {'drone' if drone else 'focus motor'} does not answer")
    return False


def _is_optional(device: Device) -> bool:
    return not isinstance(device.reporter, Angles)


def _left_out(axes: Sequence[Axis], reason: TeleopError) -> str:
    return f"{' and '.join(axes)} left out: {reason}; {CURES.get(axes[0], 'mend it')}, then start again"
