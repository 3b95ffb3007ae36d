"""Small motions on the bench, each a script that waits until it is over. None is faster or further than it is allowed.

"Nothing above 5 deg/s and 5 deg until the operator agrees to more": the limits are here, and every step keeps them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Mapping
from typing import TYPE_CHECKING, NamedTuple

from teleop.commission.gimbal.places import Places, gone
from teleop.commission.step import Pause, Question, Wait
from teleop.config.wiring import half_turn
from teleop.dji.gimbal.joystick import FULL_DEFLECTION
from teleop.dji.message import Message

if TYPE_CHECKING:
    from teleop.commission.gimbal.bench import GimbalBench

FASTEST, FURTHEST = 5.0, 5.0  # deg/s and deg, until the operator agrees to more
STILL_WITHIN = 3.0  # s in which everything is to rest after a motion
SETTLE = 0.35  # s at rest, over which a place is measured
LATE = 0.6  # s by which the effect of a command may be late
ANSWERED, TRIES = 0.3, 3  # s for an answer, and how often it is asked for
MOVED = 0.35  # deg: less is noise
PARTS = 5  # of a way back, beside those that its length asks for
LAPSES, ROOM = 2.0, 4.6  # s and deg in which a command that is not repeated is to end
ASTRAY = 3.0  # deg that a way back may lead away, until it is given up
STEER, ARRIVED = 2.0, 0.12  # 1/s and deg of a way that is steered by speeds


class Shift(NamedTuple):
    """What an increment did: how far each angle went (deg), the code of its answer, and the readings on the way."""

    moved: tuple[float, float, float]
    code: int | None
    track: list[Places]
    sent: float


class Lapse(NamedTuple):
    """How far (deg) an angle went by a command that was sent for `sent` s, and whether it stopped by itself."""

    went: float
    sent: float
    stopped: bool


def wait(bench: GimbalBench, seconds: float, progress: str = "") -> Pause:
    """Nothing for so long, measured by the bench's time."""
    end = bench.now + seconds
    while bench.now < end - 1e-6:
        yield Wait(end - bench.now, progress)


def rest(bench: GimbalBench, late: float = LATE) -> Pause:
    """Until everything rests; at least as long as the effect of a command may be late."""
    yield from wait(bench, late)
    end = bench.now + STILL_WITHIN
    while not bench.still and bench.now < end:
        yield Wait(0.02)
    yield from wait(bench, SETTLE)


def answer(bench: GimbalBench, message: Message, tries: int = TRIES) -> Generator[Wait | Question, str, Message | None]:
    """The answer to a request, None where none comes, however often it is asked: a bus may lose one."""
    for _ in range(tries):
        sequence = bench.request(message)
        end = bench.now + ANSWERED
        while sequence not in bench.answered and bench.now < end:
            yield Wait(0.01)
        found = bench.answered.get(sequence)
        if found is not None and found.reply is not None:
            return found.reply
    return None


def shift(
    bench: GimbalBench, index: int, way: float, seconds: float, progress: str = ""
) -> Generator[Wait | Question, str, Shift]:
    """Turn one angle by `way` (deg) with a position command, and see where it went.

    One that was lost on the way, without an answer and without a motion, is sent again.
    """
    tries = 0
    while True:
        before, sent = bench.mean(), bench.now
        sequence = bench.increment(index, way, seconds)
        yield from wait(bench, seconds, progress)
        yield from rest(bench)
        done = Shift(gone(before, bench.mean()), bench.code(sequence), bench.since(sent), sent)
        tries += 1
        if done.code is not None or max(map(abs, done.moved)) >= MOVED or tries == TRIES:
            return done


def cruise(
    bench: GimbalBench, speed: float, seconds: float, send: Callable[[float], object], progress: str = ""
) -> Pause:
    """Send a speed again and again for so long."""
    end = bench.now + seconds
    while bench.now < end - 1e-6:
        send(speed)
        yield Wait(min(0.04, end - bench.now), progress)


def pulse(
    bench: GimbalBench, value: float, seconds: float, send: Callable[[float], object], progress: str = ""
) -> Generator[Wait | Question, str, tuple[float, float, float]]:
    """How far each angle goes while `value` is sent for so long and zero thereafter, before control is released."""
    before = bench.mean()
    yield from cruise(bench, value, seconds, send, progress)
    yield from cruise(bench, 0.0, LATE, send)
    moved = gone(before, bench.mean(0.15))
    yield from let_go(bench)
    yield from rest(bench, 0.1)
    return moved


def lapse(
    bench: GimbalBench, index: int, value: float, seconds: float, send: Callable[[float], object]
) -> Generator[Wait | Question, str, Lapse]:
    """Send `value` for so long, and then no more: how far the angle goes says how long the last one held."""
    start, begin = bench.mean()[index], bench.now
    yield from cruise(bench, value, seconds, send, "the last command is on its way")
    last = bench.now - 0.02  # between the last one and the next that did not come
    end = bench.now + LAPSES
    while bench.now < end and abs(half_turn(bench.mean(0.06)[index] - start)) < ROOM:
        yield Wait(0.02, "nothing is sent: it should stop by itself")
        if bench.now > last + 0.8 and bench.still:
            break
    stopped = bench.still
    if stopped:
        yield from wait(bench, 0.1 + SETTLE)
    return Lapse(abs(half_turn(bench.mean()[index] - start)), last - begin, stopped)


def less(moved: tuple[float, float, float], baseline: tuple[float, float, float]) -> tuple[float, float, float]:
    """Without what zero does: a drift."""
    yaw, roll, pitch = (a - b for a, b in zip(moved, baseline, strict=True))
    return yaw, roll, pitch


def let_go(bench: GimbalBench) -> Pause:
    """Everything to rest by the same way as STOP, control given back."""
    while (after := bench.rest.release(bench.now)) is not None:
        yield from wait(bench, after - bench.now)


def home(bench: GimbalBench) -> Pause:
    """Back to where everything began: one angle after the other, in parts, each measured before the next.

    It ends where that leads nowhere: nothing must be driven on and on.
    """
    start = bench.ways_back()
    for index in bench.driven:
        before, failed, sign = math.inf, 0, 1.0
        left = PARTS + abs(bench.ways_back().get(index, 0.0)) / bench.back_speed
        while (way := bench.ways_back().get(index, 0.0)) and failed < 4 and left > 0 and not _astray(bench, start):
            failed = failed + 1 if abs(way) > before - 0.1 else 0
            sign = -sign if failed in (2, 3) else sign
            before, left = abs(way), left - 1
            yield from _home_by(bench, index, sign, way, f"{bench.name(index)} goes back, {abs(way):.1f} deg left")


def _astray(bench: GimbalBench, start: Mapping[int, float]) -> bool:
    """Whether the way back has led an angle further away."""
    ways = bench.ways_back()
    return any(abs(way) > abs(start.get(index, 0.0)) + ASTRAY + 4 * bench.noise for index, way in ways.items())


def _home_by(bench: GimbalBench, index: int, sign: float, way: float, progress: str) -> Pause:
    """One part of the way back, by the means that the gimbal obeys."""
    by_speed, full = bench.speed_signs[index], bench.full_stick[index]
    if bench.obeys_position[index] or not (by_speed or full):
        part = math.copysign(min(abs(way), 2.5 * bench.back_speed if bench.obeys_position[index] else 1.0), way)
        seconds = min(25.5, max(0.1, math.ceil(10 * abs(part) / bench.back_speed) / 10))
        bench.increment(index, sign * bench.position_signs[index] * part, seconds)
        yield from wait(bench, seconds, progress)
    else:
        yield from _steer(bench, index, bench.mean()[index] + way, sender(bench, index, bool(by_speed)), progress)
        yield from let_go(bench)
    yield from rest(bench, 0.3)


def _steer(bench: GimbalBench, index: int, target: float, send: Callable[[float], object], progress: str) -> Pause:
    """To a reading, by speeds that shrink on the way; for as long as that should take, and a little."""
    way = half_turn(target - bench.mean()[index])
    end = bench.now + abs(way) / bench.back_speed + 2.0
    most = abs(way) + ASTRAY
    while bench.now < end and ARRIVED < abs(way) < most:
        send(max(-bench.back_speed, min(bench.back_speed, STEER * way)))
        yield Wait(0.04, progress)
        way = half_turn(target - bench.mean(0.06)[index])


def sender(bench: GimbalBench, index: int, by_speed: bool) -> Callable[[float], object]:
    """Sends deg/s, in the signs of readings, as a speed, or as a push of the stick."""
    if by_speed:
        sign = bench.speed_signs[index] or 1
        return lambda value: bench.speed(index, sign * value)
    return lambda value: bench.push(index, round(FULL_DEFLECTION * value / bench.full_stick[index]))


def moving_part(track: list[Places], index: int, near: float | None = None) -> list[tuple[float, float]]:
    """The readings of one angle, times and deg, unrolled: within half a turn of `near`, or of the first of them."""
    if not track:
        return []
    near = track[0].angles[index] if near is None else near
    return [(each.time, near + half_turn(each.angles[index] - near)) for each in track]
