"""What must hold before a drone is taken, and while it is held: each condition a line that the operator reads.

The conditions of the movement modes are the appendix's ("Control mode"); those of every taking are
docs/protocol-facts.md: the pilot's way out is to leave F mode, so a drone whose RC is not in F is not taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone.enums import ControlDevice, RcMode
from teleop.dji.drone.movement import Combination, Horizontal, Vertical

GPS_HEALTH = 3  # of 5: Appendix.md, Control mode
LOW_HEIGHT = 3.0  # m, as far as ultrasound reaches


@dataclass(frozen=True)
class Site:
    """What the profile says of the drone and the place: whether Guidance is on board, and whether it flies indoors."""

    guidance: bool = False
    indoors: bool = False


def mode_refusals(combination: Combination, site: Site, health: int | None) -> Iterator[str]:
    """Why a movement mode would not work with a GPS of this `health`, None for one that says nothing."""
    if health is not None and health >= GPS_HEALTH:
        return
    found = "the GPS reports nothing" if health is None else f"GPS health is {health} of 5"
    if combination.horizontal == Horizontal.POSITION:
        yield f"{found}: horizontal positions need {GPS_HEALTH}"
    elif combination.horizontal == Horizontal.VELOCITY and not site.guidance:
        yield f"{found}: horizontal velocities need {GPS_HEALTH}, or Guidance declared in the profile"


def mode_warnings(combination: Combination, site: Site, height: float | None) -> Iterator[str]:
    """What a movement mode is not trusted with at this `height` (m), None for one that is not known."""
    if combination.vertical != Vertical.POSITION:
        return
    if height is None:
        yield "the drone does not report how high it is: a height may not be kept"
    elif site.indoors and not (site.guidance and height <= LOW_HEIGHT):
        yield f"indoors, without Guidance or above {LOW_HEIGHT:g} m, the barometer misleads: a height may not be kept"
    elif height < LOW_HEIGHT:
        yield f"below {LOW_HEIGHT:g} m a height that is a little wrong is the ground"


def refusals(seen: Telemetry, now: float, low_battery: int) -> Iterator[str]:
    """Why a drone that says this must not be taken now."""
    if not seen.activated:
        yield "the drone is not activated yet"
        return
    if seen.get("status", now) is None:
        yield "the drone does not report its flight status"
    battery = seen.get("battery", now)
    if battery is None:
        yield "the drone does not report its battery"
    elif battery <= low_battery:
        yield f"the battery is at {battery} %: {low_battery} % is too low to begin with"
    rc = seen.get("rc", now)
    if rc is None:
        yield "the drone does not report where its RC's mode switch is"
    elif rc.mode != RcMode.F:
        where = rc.mode.name if isinstance(rc.mode, RcMode) else rc.mode
        yield f"its RC's mode switch is in {where}: it must be in F, which its pilot leaves to take the drone back"
    yield from _mobile_device(seen, now)


def troubles(seen: Telemetry, now: float, low_battery: int) -> Iterator[str]:
    """Why a drone that is held must be given back now."""
    if seen.get("status", now) is None:
        yield "the drone no longer reports its flight status"
    battery = seen.get("battery", now)
    if battery is None:
        yield "the drone no longer reports its battery"
    elif battery <= low_battery:
        yield f"the battery is at {battery} %"
    yield from _mobile_device(seen, now)


def _mobile_device(seen: Telemetry, now: float) -> Iterator[str]:
    control = seen.get("control", now)
    if control is not None and control.device == ControlDevice.MOBILE_DEVICE:
        yield "the mobile device has control"
