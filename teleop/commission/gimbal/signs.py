"""Which way the gimbal counts, and in which order: what positions, readings and speeds have to do with each other.

The operator's eyes say which way an axis went. The sign of a reading follows from that, and the others from readings.
"""

from __future__ import annotations

from typing import NamedTuple

from teleop.commission.findings import Fact, Subject
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import MOVED
from teleop.commission.gimbal.places import ANGLES
from teleop.core.errors import DeviceError

SECOND, THIRD = 1, 2  # roll and pitch: what some firmware exchanges in its replies


class SignSubjects(NamedTuple):
    order: Subject
    position: Subject
    report: Subject
    speed: Subject
    stick: Subject


def sign_subjects(name: str) -> SignSubjects:
    """Of one axis, but for the order, which all have in common."""
    return SignSubjects(
        Subject("reply.order", "Order of the angles in replies", "yaw, roll, pitch"),
        Subject(f"sign.position.{name}", f"Sign of {name} in position commands", 1),
        Subject(f"sign.report.{name}", f"Sign of {name} in reported angles", 1),
        Subject(f"sign.speed.{name}", f"Sign of {name} in speed commands (0E 01)", 1),
        Subject(f"sign.stick.{name}", f"Sign of {name} in pushes of the joystick (0E 0A)", 1),
    )


def main_angle(moved: tuple[float, float, float], least: float = MOVED) -> int | None:
    """Which of the angles went the furthest, None where none went."""
    index = max(range(3), key=lambda each: abs(moved[each]))
    return index if abs(moved[index]) >= least else None


def seen_angle(bench: GimbalBench, moved: tuple[float, float, float], index: int, least: float) -> int | None:
    """The angle that answered: the one that was sent, where the order is known; another may drift meanwhile."""
    if bench.knows_order:
        return index if abs(moved[index]) >= least else None
    return main_angle(moved, least)


def settle_order(bench: GimbalBench, subject: Subject, index: int, moved: int) -> list[Fact]:
    """What follows from the angle that moved when another was sent. Raises DeviceError where that makes no sense."""
    if moved != index:
        if {moved, index} != {SECOND, THIRD} or bench.knows_order:
            raise DeviceError(f"{ANGLES[moved]} moved where {ANGLES[index]} was sent: repeat this step")
        bench.exchange()
    elif index not in (SECOND, THIRD):
        return []
    bench.knows_order = True
    order = "yaw, pitch, roll" if bench.swapped else "yaw, roll, pitch"
    return [subject.found(order, f"the angle that moved when {ANGLES[index]} was sent")]


def sign_facts(bench: GimbalBench, subjects: SignSubjects, index: int, report: int) -> list[Fact]:
    """Of positions and readings, from which way the operator saw it go."""
    facts = [subjects.report.found(report, "the operator saw which way it went, and the reading which way it counts")]
    if bench.obeys_position[index]:
        sign = report * bench.position_signs[index]
        facts.append(subjects.position.found(sign, "the operator saw which way a positive position goes"))
    return facts
