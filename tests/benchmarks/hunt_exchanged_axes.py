"""Hunt for false alarms and misses of the guard for exchanged axes: random gimbals under speed control, and hands.

python tests/benchmarks/hunt_exchanged_axes.py [gimbals]
"""

from __future__ import annotations

import math
import random
import sys

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.devices.gimbal.pi_correction import PiCorrection
from teleop.monitors.exchanged_axes import ExchangedAxesGuard
from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.motors import Motor

PAIR = Axis.TILT, Axis.ROLL
LIMITS = Limits(-180, 180, 80, 240, 1200)


def gimbal(dice: random.Random) -> list[Motor]:
    """Two motors, each with dynamics of its own."""
    motors = [Motor(0.0, 0.05), Motor(0.0, 0.05)]
    for motor in motors:
        motor.dynamics = Dynamics(
            lag=dice.uniform(0.03, 0.2),
            dead_time=dice.uniform(0, 0.1),
            gain=dice.uniform(0.85, 1.1),
            drift=dice.uniform(-1, 1),
            backlash=dice.choice([0.0, 0.1]),
            noise=dice.choice([0.0, 0.05, 0.1]),
        )
    return motors


def swing(reach: float, rate: float, time: float) -> State:
    """There and back, after half a second of rest."""
    angle = rate * max(0.0, time - 0.5)
    acceleration = reach * rate * rate * math.cos(angle) / 2 if angle else 0.0
    return State(reach * (1 - math.cos(angle)) / 2, reach * rate * math.sin(angle) / 2, acceleration)


def found_after(seed: int, exchanged: bool) -> float | None:
    """How far an axis had gone (deg) when the guard raised; None when it did not within 5 s."""
    dice = random.Random(seed)
    motors = gimbal(dice)
    guard = ExchangedAxesGuard(PAIR, 1, lambda: "", 0.0, speeds=True, found=set())
    correction = PiCorrection(dict.fromkeys(PAIR, LIMITS), 0.02)
    reaches = dice.uniform(-30, 30), dice.choice([0.0, 0.0, dice.uniform(-20, 20)])
    rates = dice.uniform(0.2, 2.5), dice.uniform(0.2, 2.5)
    held, begin = dice.choice([None, None, 0, 1]), round(dice.uniform(0, 3), 2)
    reported: dict[Axis, Reading] = {}
    for count in range(500):
        now = count / 100
        if held is not None and count in (round(100 * begin), round(100 * begin) + 100):
            motors[held].hold(now, count == round(100 * begin))
        if count % 4 == 0:
            angles = [round(motor.at(now)[0] + dice.gauss(0, motor.dynamics.noise), 1) for motor in motors]
            order = reversed(angles) if exchanged else angles
            reported = {axis: Reading(angle, now) for axis, angle in zip(PAIR, order, strict=True)}
        motion = {axis: swing(reach, rate, now) for axis, reach, rate in zip(PAIR, reaches, rates, strict=True)}
        tick = Tick(now, motion, {}, (), reported)
        correction.note(tick)
        if count % 2 == 0:
            speeds = correction.speeds(tick)
            guard.sent(now, speeds)
            for motor, axis in zip(motors, PAIR, strict=True):
                motor.cruise(now, speeds[axis], now + 0.5)
        try:
            guard.observe(tick)
        except DeviceError:
            return max(abs(motor.at(now)[0]) for motor in motors)
    return None


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    alarms = [seed for seed in range(count) if found_after(seed, exchanged=False) is not None]
    ways = [found_after(seed, exchanged=True) for seed in range(count)]
    found = sorted(way for way in ways if way is not None)
    print(f"{count} gimbals: {len(alarms)} false alarms {alarms}, {count - len(found)} exchanges missed")
    print("deg gone when found, by tenths:", *(f"{found[len(found) * tenth // 10]:.1f}" for tenth in range(1, 10)))


if __name__ == "__main__":
    main()
