"""What the steps of a drone have in common: none of them begins before the propellers are confirmed to be off."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence

from teleop.commission.drone.bench import DroneBench
from teleop.commission.findings import Findings, Subject
from teleop.commission.step import Pause, Question, Script, Wait
from teleop.core.errors import DeviceError
from teleop.dji.message import Message

OFF = Subject("drone.propellers", "Propellers off, typed by the operator", True)
LOOK = 0.02  # s between two looks
ANSWERED = 4.0  # s for an answer: an activation is sent three times, a second apart


class DroneStep:
    """A step on a bench."""

    key = title = consent = ""
    about: Sequence[str] = ()
    subjects: Sequence[Subject] = ()
    automatic = False

    def __init__(self, bench: DroneBench) -> None:
        self.bench = bench

    def unfit(self, findings: Findings) -> str:
        return "" if findings.value(OFF.key) else "the propellers are not confirmed to be off"

    def script(self, findings: Findings) -> Script:
        raise NotImplementedError


class ActivatedStep(DroneStep):
    """A step for which the drone has to be activated."""

    def unfit(self, findings: Findings) -> str:
        return super().unfit(findings) or ("" if self.bench.activated else "the drone is not activated")


def wait(bench: DroneBench, seconds: float, progress: str = "") -> Pause:
    """Nothing for so long, by the bench's time."""
    end = bench.now + seconds
    while bench.now < end - 1e-6:
        yield Wait(min(LOOK, end - bench.now), progress)


def until(
    bench: DroneBench, holds: Callable[[], bool], seconds: float, progress: str = ""
) -> Generator[Wait | Question, str, bool]:
    """Wait until it holds, for so long at most; whether it does."""
    end = bench.now + seconds
    while not holds():
        if bench.now >= end - 1e-6:
            return False
        yield Wait(LOOK, progress)
    return True


def answer(bench: DroneBench, sequence: int) -> Generator[Wait | Question, str, Message | None]:
    """The answer to a request, None where none comes."""
    yield from until(bench, lambda: sequence in bench.answers, ANSWERED, "asking")
    return bench.reply(sequence)


def until_or_key(
    bench: DroneBench, holds: Callable[[], bool], text: str, seconds: float
) -> Generator[Wait | Question, str, bool]:
    """As `until`, while the operator is asked to do something and may say that it cannot be done."""
    end = bench.now + seconds
    while not holds():
        if bench.now >= end or (yield Question(text, {"n": "cannot be done"}, seconds=LOOK)) == "n":
            return False
    return True


def check_on_ground(bench: DroneBench) -> None:
    """Raises DeviceError unless the drone reports, now, that it stands by with its motors off."""
    if not bench.stands:
        raise DeviceError("the drone does not report standby: put it down, motors off")
