"""The live planner from random states: `python tests/benchmarks/hunt_live.py --cases 100000 --seed 1`.

Each case has random limits and starts one axis at a random position, velocity and acceleration, a third up to
10 % outside the limits. The target changes its kind and its value at random while the axis moves. What must hold at
every tick: values are finite, jerk keeps J, and position, velocity and acceleration keep their limits, or what the
fastest stop from the start cannot avoid. At the end a `Stop` must bring the axis to rest. Prints every case that breaks
this, and the largest excess; exits with 1 if there was one. `--seed S --first N --cases 1` repeats case N.
"""

from __future__ import annotations

import argparse
import math
import random
import sys
from dataclasses import dataclass

from teleop.core.axes import Axis, Limits, State
from teleop.core.guard_stop import inevitable_velocity, stop_reach
from teleop.core.setpoints import PositionTarget, Setpoint, StateTarget, Stop, VelocityTarget
from teleop.planner.live import Live

AXIS = Axis.PAN
DT = 0.01
TOLERANCE = 1e-6  # share of a limit, and units
CHANGES = 4  # targets of a case
LONGEST = 40  # ticks of one target


@dataclass(frozen=True)
class Bounds:
    """What a motion from its start must keep: position, then magnitudes."""

    low: float
    high: float
    velocity: float
    acceleration: float
    jerk: float

    @classmethod
    def of(cls, limits: Limits, start: State) -> Bounds:
        """The limits, or what the fastest stop from `start` cannot avoid."""
        hardest = max(limits.acceleration, abs(start.acceleration))
        later = inevitable_velocity(start.velocity, start.acceleration, limits.jerk)
        low, high = start.position, start.position
        # The acceleration comes back inside its limit first, and then the stop has no more than that.
        for state, acceleration in ((start, hardest), (eased(start, limits), limits.acceleration)):
            down, up = stop_reach(state.velocity, state.acceleration, acceleration, limits.jerk)
            low, high = min(low, state.position + down), max(high, state.position + up)
        velocity = max(limits.velocity, abs(start.velocity), abs(later))
        return cls(min(limits.minimum, low), max(limits.maximum, high), velocity, hardest, limits.jerk)

    def excess(self, before: State, after: State, seconds: float) -> float:
        """The largest excess of a step, as a share of a limit, of a position in units; NaN counts as infinite."""
        jerk = abs(after.acceleration - before.acceleration) / seconds
        found = (
            self.low - after.position,
            after.position - self.high,
            abs(after.velocity) / self.velocity - 1,
            abs(after.position - before.position) / seconds / self.velocity - 1,
            abs(after.acceleration) / self.acceleration - 1,
            jerk / self.jerk - 1,
        )
        return max(found) if all(map(math.isfinite, after)) else math.inf


def eased(start: State, limits: Limits) -> State:
    """Where `start` is once its acceleration is within its limit, at full jerk."""
    position, velocity, acceleration = start
    beyond = max(0.0, abs(acceleration) - limits.acceleration)
    jerk, t = -math.copysign(limits.jerk, acceleration), beyond / limits.jerk
    return State(
        position + t * (velocity + t * (acceleration / 2 + t * jerk / 6)),
        velocity + t * (acceleration + t * jerk / 2),
        acceleration + t * jerk,
    )


def random_limits(rng: random.Random) -> Limits:
    """From a focus motor to a fast gimbal; one of five is endless."""
    velocity = 10 ** rng.uniform(-1, 2.3)
    acceleration = velocity * 10 ** rng.uniform(-0.5, 1)
    jerk = acceleration * 10 ** rng.uniform(-0.5, 1.5)
    room = velocity * 10 ** rng.uniform(-1, 1.5)
    low, high = (-math.inf, math.inf) if rng.random() < 0.2 else (-room, room)
    return Limits(low, high, velocity, acceleration, jerk)


def random_state(rng: random.Random, limits: Limits, share: float) -> State:
    """Anywhere within `share` of the limits; exactly on one now and then."""
    room = 10 * limits.velocity if limits.continuous else limits.maximum
    values = [rng.choice([-1, 0, 1, *(rng.uniform(-1, 1) for _ in range(5))]) for _ in range(3)]
    return State(*(share * x * of for x, of in zip(values, (room, limits.velocity, limits.acceleration), strict=True)))


def random_setpoint(rng: random.Random, limits: Limits) -> Setpoint | None:
    """Any kind of target, beyond the limits too."""
    where, velocity, acceleration = random_state(rng, limits, 1.2)
    gentle = rng.uniform(0.01, 1.2)
    return rng.choice(
        [
            VelocityTarget(velocity),
            VelocityTarget(velocity, gentle * limits.acceleration, gentle * limits.jerk),
            PositionTarget(where, rng.choice([None, rng.uniform(0, 8)])),
            StateTarget(where, velocity, acceleration),
            Stop(),
            None,
        ]
    )


def run_case(rng: random.Random) -> tuple[float, str]:
    """The largest excess of one case, and what led to it."""
    limits = random_limits(rng)
    start = random_state(rng, limits, rng.choice([0.9, 1.0, 1.1]))
    live, bounds, worst, story = Live({AXIS: limits}, DT), Bounds.of(limits, start), -math.inf, ""
    live.reset({AXIS: start})
    for _ in range(CHANGES):
        setpoint = random_setpoint(rng, limits)
        for tick in range(rng.randint(1, LONGEST)):
            steps = rng.choice([1] * 12 + [2, 3, 7])
            before, after = live.motion[AXIS], live.step({} if setpoint is None else {AXIS: setpoint}, steps)[AXIS]
            found = bounds.excess(before, after, steps * DT)
            if found > worst:
                worst, story = (
                    found,
                    f"{limits}\n  {start}\n  tick {tick} x {steps} of {setpoint}\n  {before}\n  {after}",
                )
            if isinstance(setpoint, StateTarget):
                setpoint = setpoint._replace(position=setpoint.position + setpoint.velocity * steps * DT)
    if not comes_to_rest(live, limits):
        return math.inf, f"{limits}\n  {start}\n  does not come to rest: {live.motion[AXIS]}"
    return worst, story


def comes_to_rest(live: Live, limits: Limits) -> bool:
    """Whether a Stop ends at rest in the time that a stop may take, with long ticks."""
    seconds = 4 * (limits.velocity / limits.acceleration + 2 * limits.acceleration / limits.jerk)
    for _ in range(40):
        live.step({AXIS: Stop()}, max(1, math.ceil(seconds / 40 / DT)))
    return live.motion[AXIS][1:] == (0.0, 0.0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    bad, largest = 0, -math.inf
    for number in range(arguments.first, arguments.first + arguments.cases):
        found, story = run_case(random.Random(f"{arguments.seed} {number}"))
        largest = max(largest, found)
        if found > TOLERANCE:
            bad += 1
            sys.stdout.write(f"seed {arguments.seed}, case {number}: excess {found:.3g}\n  {story}\n")
    sys.stdout.write(f"{arguments.cases} cases, {bad} broke a limit, largest excess {largest:.2g}\n")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
