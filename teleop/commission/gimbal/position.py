"""The position command of one angle: whether it is obeyed, which way, how exactly, how fast; and the one after it."""

from __future__ import annotations

from collections.abc import Generator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.gimbal.base import WAYS, AxisStep, answered, direction_question
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import (
    FURTHEST,
    MOVED,
    SETTLE,
    TRIES,
    Shift,
    home,
    let_go,
    moving_part,
    rest,
    shift,
    wait,
)
from teleop.commission.gimbal.signs import main_angle, settle_order, sign_facts, sign_subjects
from teleop.commission.step import Question, Script, Wait
from teleop.config.wiring import half_turn

REACH, SECONDS, SHORT = 2.0, 1.0, 0.5  # deg and s
SLOWEST = 25.5  # s: a place that is not where it is thought to be is approached slowly
LEAPS = 0.6  # deg
LATEST, LONGEST = 0.9, 2.0  # s: the beginnings and lengths of a move that are tried
FIT = "the constant speed that the readings fit best"
NAMEABLE = ((-180.0, 180.0), (-30.0, 30.0), (-56.0, 146.0))  # yaw, roll, pitch: V2.5, figure 7


class PositionStep(AxisStep):
    """2 degrees to one side and back, at 2 deg/s; then what a second command does to the first."""

    def __init__(self, bench: GimbalBench, index: int) -> None:
        super().__init__(bench, index)
        name, way = self.name, WAYS[self.name][0]
        self.key, self.title = f"position-{name}", f"Position command: {name}"
        self.about = (
            f"{name} goes {REACH:g} deg to one side, slowly ({REACH / SECONDS:g} deg/s), and back.",
            f"By the document it should {way}: you are asked whether it did.",
            f"Then it goes {REACH:g} deg out again, and is called back on the way.",
            "It ends where it began.",
        )
        self.obeyed = Subject(f"position.obeyed.{name}", f"{name} obeys position commands (0E 00)", True)
        self.error = Subject(f"position.error.{name}", f"Where {name} arrives, less where it was sent", 0.0, "deg")
        self.travel = Subject(f"position.travel.{name}", f"Time of a move of {name} over {SECONDS:g} s", SECONDS, "s")
        self.brief = Subject(f"position.brief.{name}", f"Time of a move of {name} over {SHORT:g} s", SHORT, "s")
        self.absolute = Subject(f"position.absolute.{name}", f"Absolute positions of {name} are its readings", True)
        self.newer = Subject(f"position.newer.{name}", f"A newer command of {name} replaces the older one", True)
        self.step = Subject(f"angles.resolution.{name}", f"Steps of the angle of {name}", 0.1, "deg")
        self.age = Subject(f"angles.age.{name}", f"Age of a reading of {name}, at most", None, "s")
        self.signs = sign_subjects(name)
        own = (self.obeyed, self.error, self.travel, self.brief, self.absolute, self.newer, self.step, self.age)
        self.subjects = (*own, self.signs.order, self.signs.position, self.signs.report)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench, index = self.bench, self.index
        bench.allow(FURTHEST)
        first = yield from shift(bench, index, REACH, SECONDS, f"{self.name} goes {REACH:g} deg out")
        moved = main_angle(first.moved)
        if moved is None:
            return [self.obeyed.found(False, f"{answered(first.code)}, and it did not move")]
        order = settle_order(bench, self.signs.order, index, moved)
        way = half_turn(bench.mean()[index] - self._began(first))
        bench.position_signs[index], bench.obeys_position[index] = (1 if way > 0 else -1), True
        facts = [self.obeyed.found(True, f"{answered(first.code)}, moved {abs(way):.1f} of {REACH:g} deg"), *order]
        facts.append(self.error.found(round(abs(way) - REACH, 2), f"after {REACH:g} deg", within=0.2 + bench.noise))
        facts += self._track_facts(first)
        facts += yield from self._direction(way)
        yield from home(bench)
        facts += yield from self._second()
        facts += yield from self._frame()
        yield from home(bench)
        return facts

    def _began(self, first: Shift) -> float:
        """Where the angle was before; roll and pitch may only now be known to be exchanged."""
        track = moving_part(self.bench.since(first.sent - 0.3), self.index)
        before = [place for time, place in track if time <= first.sent]
        return sum(before) / len(before) if before else track[0][1]

    def _track_facts(self, first: Shift) -> list[Fact]:
        bench, index = self.bench, self.index
        track = moving_part(bench.since(first.sent - 0.3), index)
        fitted, steps = fitted_move(track), smallest_step(track)
        if fitted is None:
            facts = [each.not_seen("too few readings") for each in (self.travel, self.age)]
        else:
            late = max(0.0, fitted.begin - first.sent)
            how = "from the command to where the readings begin to move: with the dead time of the motion"
            facts = [self._time(self.travel, fitted.seconds, FIT), self.age.found(round(late, 2), how)]
        if bench.noise or steps is None:
            return [*facts, self.step.not_seen("the readings are noisy" if bench.noise else "too few readings")]
        return [*facts, self.step.found(round(steps, 2), "the smallest step between two readings", within=0.03)]

    def _time(self, subject: Subject, seconds: float, how: str) -> Fact:
        return subject.found(round(seconds, 2), how, within=0.15 + 0.3 * self.bench.noise)

    def _direction(self, way: float) -> Script:
        """Ask which way it went; where that was unclear, it goes once more."""
        while (seen := (yield direction_question(self.name))) == "u":
            yield from home(self.bench)
            again = yield from shift(self.bench, self.index, REACH, SECONDS, "once more")
            way = again.moved[self.index]
        report = (1 if way > 0 else -1) * (1 if seen == "y" else -1)
        return sign_facts(self.bench, self.signs, self.index, report)

    def _second(self) -> Script:
        """Out by 2 deg in 1 s, and half way the first half of that back."""
        bench, index = self.bench, self.index
        sign = bench.position_signs[index]
        tries = 0
        while True:
            begin, sent = bench.mean()[index], bench.now
            was_answered, tries = (yield from self._out_and_back()), tries + 1
            if was_answered or tries == TRIES:
                break
            yield from home(bench)
        track = [(time, sign * (place - begin)) for time, place in moving_part(bench.since(sent), index, begin)]
        furthest, end = max(place for _, place in track), track[-1][1]
        slack = 0.3 + 2 * bench.noise
        how = f"called back after {SHORT:g} s of {SECONDS:g}: it got {furthest:.1f} deg far and ended at {end:.1f}"
        replaces = furthest < REACH - slack and end < REACH / 2 + slack
        yield from home(bench)
        facts = [self.newer.found(replaces, how)]
        brief = yield from shift(bench, index, 1.0, SHORT, f"1 deg in {SHORT:g} s")
        fitted = fitted_move(moving_part(bench.since(brief.sent - 0.3), index))
        if fitted is None:
            return [*facts, self.brief.not_seen("too few readings")]
        return [*facts, self._time(self.brief, fitted.seconds, FIT)]

    def _out_and_back(self) -> Generator[Wait | Question, str, bool]:
        """Whether both commands were answered: one that is lost says nothing."""
        bench, index = self.bench, self.index
        sent = [bench.increment(index, REACH, SECONDS)]
        yield from wait(bench, SHORT, f"{self.name} goes out")
        sent.append(bench.increment(index, -REACH / 2, SHORT))
        yield from wait(bench, SHORT, "and is called back")
        yield from rest(bench)
        return all(bench.code(each) is not None for each in sent)

    def _frame(self) -> Script:
        """To where it is, as an absolute position: it must stay. Where it does not, it is on a long way, slowly."""
        bench, index = self.bench, self.index
        here = bench.mean()[index]
        angle = half_turn(bench.position_signs[index] * here)
        low, high = NAMEABLE[index]
        if not low <= angle <= high:
            return [self.absolute.not_seen(f"{angle:.0f} deg is beyond what a position command can say")]
        sequence = bench.target(index, angle, SLOWEST)
        yield from wait(bench, 1.5, "sent to where it is: it must not move")
        moved, code = half_turn(bench.mean()[index] - here), bench.code(sequence)
        yield from let_go(bench)
        stays = abs(moved) < LEAPS / 2 + bench.noise and not code
        return [self.absolute.found(stays, f"{answered(code)}, moved {moved:+.1f} deg when sent to where it was")]


class FittedMove(NamedTuple):
    """A move at constant speed: when it began, and how long it took (s)."""

    begin: float
    seconds: float


def fitted_move(track: list[tuple[float, float]]) -> FittedMove | None:
    """Of all moves at constant speed the one that the readings fit best; None with too few of them."""
    if len(track) < 8:
        return None
    times, places = np.asarray(track).T
    settled = places[times > times[-1] - SETTLE]
    start, end = places[0], settled.mean()
    if abs(end - start) < MOVED:
        return None
    shares = (places - start) / (end - start)
    begins = np.arange(times[0], times[0] + LATEST, 0.01)[:, None, None]
    lengths = np.arange(0.1, LONGEST, 0.02)[None, :, None]
    left = ((np.clip((times - begins) / lengths, 0.0, 1.0) - shares) ** 2).sum(axis=2)
    begin, length = np.unravel_index(left.argmin(), left.shape)
    return FittedMove(float(begins[begin, 0, 0]), float(lengths[0, length, 0]))


def smallest_step(track: list[tuple[float, float]]) -> float | None:
    """The smallest difference between two readings in a row, in deg."""
    steps = [abs(b - a) for (_, a), (_, b) in pairwise(track) if abs(b - a) > 0.01]
    return min(steps) if len(steps) >= 3 else None
