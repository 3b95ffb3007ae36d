"""STOP tried for real, and how late the gimbal is from end to end."""

from __future__ import annotations

import math

from teleop.commission.findings import Findings, Subject
from teleop.commission.gimbal.base import AxisStep, GimbalStep
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import FURTHEST, home, moving_part, rest, sender
from teleop.commission.page import STOP
from teleop.commission.step import Question, Script, Wait
from teleop.config.wiring import half_turn
from teleop.core.errors import DeviceError
from teleop.monitors.delay_estimate import estimate

SPEED, REACH = 3.0, 2.0  # deg/s and deg to either side
LONGEST = 60.0  # s in which the operator is to press space
STOPPED = Subject("stop.works", "Space stops it", True)
STOP_TIME = Subject("stop.seconds", "From the key to rest", None, "s")
STOP_WAY = Subject("stop.way", "How far it went from the key to rest", None, "deg")
AIM = 0.1  # s that a position is sent ahead, as a move does
PERIOD, SWINGS = 2.0, 6  # s of a swing, and how many


class StopStep(GimbalStep):
    """An axis goes to and fro until the operator presses space."""

    key, title = "stop", "STOP, tried for real"
    subjects = (STOPPED, STOP_TIME, STOP_WAY)
    moves = True

    @property
    def about(self) -> tuple[str, ...]:  # pyright: ignore[reportIncompatibleVariableOverride] - it changes with the bench
        return (
            f"{self._name} goes {REACH:g} deg to and fro at {SPEED:g} deg/s, until you press space.",
            "Press it while the axis moves. Then it goes back to where it began.",
            "STOP is not an emergency stop: the motors stay powered.",
        )

    @property
    def _index(self) -> int | None:
        bench = self.bench
        return next((index for index in bench.driven if can_move(bench, index)), None)

    @property
    def _name(self) -> str:
        return "an axis" if self._index is None else self.bench.name(self._index)

    def unfit(self, findings: Findings) -> str:
        return super().unfit(findings) or ("" if self._index is not None else "no axis was found to move")

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench, index = self.bench, self._index
        if index is None:
            raise DeviceError("no axis was found to move")
        bench.allow(FURTHEST)
        yield from self._to_and_fro(index)
        pressed, at = bench.now, bench.mean(0.05)[index]
        while (after := bench.rest.release(bench.now)) is not None:
            yield Wait(max(0.01, after - bench.now), "STOP")
        track = moving_part(bench.since(pressed), index)
        end = bench.mean()[index]
        rests = next((time for time, place in track if abs(place - track[-1][1]) < 0.15), bench.now)
        way = abs(half_turn(end - at))
        yield from rest(bench)
        drifted = abs(half_turn(bench.mean()[index] - end)) > 0.3 + bench.noise
        yield from home(bench)
        return [
            STOPPED.found(not drifted, "it rested, and stayed there"),
            STOP_TIME.found(round(rests - pressed, 2), "by the readings"),
            STOP_WAY.found(round(way, 1), "by the readings"),
        ]

    def _to_and_fro(self, index: int) -> Script:
        """Until space."""
        bench, begin, side = self.bench, self.bench.now, 1.0
        start = bench.mean()[index]
        while bench.now < begin + LONGEST:
            off = half_turn(bench.mean(0.06)[index] - start)
            side = -side if off * side > REACH - 0.4 else side
            move(bench, index, side * SPEED, 0.1)
            if (yield Question(f"{self._name} moves: press space", {STOP: "STOP"}, seconds=0.1)) == STOP:
                return ()
        raise DeviceError(f"nothing was pressed for {LONGEST:g} s: stopped")


class LatencyStep(AxisStep):
    """Slow swings by positions, as a move sends them."""

    def __init__(self, bench: GimbalBench, index: int) -> None:
        super().__init__(bench, index)
        self.key, self.title = f"latency-{self.name}", f"Latency from end to end: {self.name}"
        self.about = (
            f"{self.name} swings {REACH:g} deg to one side and back, {SWINGS} times in {PERIOD * SWINGS:g} s,",
            "sent as a move sends it. How late the readings are is the latency.",
        )
        self.late = Subject(
            f"latency.{self.name}", f"From a commanded position of {self.name} to its reading", None, "s"
        )
        self.scale = Subject(f"latency.scale.{self.name}", f"How far {self.name} goes, of what was commanded", 1.0)
        self.subjects = (self.late, self.scale)

    def unfit(self, findings: Findings) -> str:
        obeys = self.bench.obeys_position[self.index]
        return super().unfit(findings) or ("" if obeys else f"{self.name} was not found to obey positions")

    def script(self, findings: Findings) -> Script:
        bench, index = self.bench, self.index
        absolute = findings.value(f"position.absolute.{self.name}")
        if absolute is not True:
            raise DeviceError("absolute positions are not what the readings say: there is no move to measure")
        bench.allow(FURTHEST)
        start, (commanded, begin) = bench.mean()[index], (yield from self._swings())
        yield from rest(bench)
        late = estimate(commanded, moving_part(bench.since(begin), index, start), begin, begin + PERIOD * SWINGS)
        yield from home(bench)
        if late is None or not math.isfinite(late.doubt):
            return [each.not_seen("the readings do not say") for each in self.subjects]
        how = f"{SWINGS} swings of {REACH:g} deg; doubt {late.doubt:.3f} s"
        return [
            self.late.found(round(max(0.0, late.seconds), 3), how),
            self.scale.found(round(late.scale, 2), how, within=0.05 + 0.2 * bench.noise),
        ]

    def _swings(self):
        """What was commanded, and when it began."""
        bench, index = self.bench, self.index
        start, begin, sign = bench.mean()[index], bench.now, bench.position_signs[index]
        rate, commanded = 2 * math.pi / PERIOD, list[tuple[float, float]]()
        while (elapsed := bench.now - begin) < PERIOD * SWINGS:
            place = REACH * (1 - math.cos(rate * elapsed)) / 2
            speed = REACH * rate * math.sin(rate * (elapsed + 0.01)) / 2
            commanded.append((bench.now, start + place))
            bench.target(index, sign * (start + place + AIM * speed), AIM)
            yield Wait(0.02, f"{self.name} swings, {PERIOD * SWINGS - elapsed:.0f} s left")
        return commanded, begin


def can_move(bench: GimbalBench, index: int) -> bool:
    """Whether something was found that moves it."""
    return bench.obeys_position[index] or bool(bench.speed_signs[index] or bench.full_stick[index])


def move(bench: GimbalBench, index: int, speed: float, seconds: float) -> None:
    """On at `speed` (deg/s, in the sign of readings) for a moment, by what the axis was found to obey."""
    if bench.obeys_position[index]:
        bench.increment(index, bench.position_signs[index] * speed * seconds, seconds)
    else:
        sender(bench, index, by_speed=bool(bench.speed_signs[index]))(speed)
