"""Random gimbals that nobody has measured: how far beyond a soft limit, how far from a key, and against knowing them.

    python tests/benchmarks/unknown_gimbals.py [first] [last] [--more]

Each number is a gimbal, a profile and a move of its own. Without --more the gimbals are those that the program must
cope with: lag 0.03..0.2 s, dead time 0..0.1 s, gain 0.85..1.1, drift to 1 deg/s, answers at 25 Hz in steps of 0.1 deg.
With --more each has one more fault: a second-order mode, backlash, noise, old or lost reports, or pushes only. Half of
them are the program's own simulated gimbal, half one that shares no code with it. The last column is against a run that
is given the true response as its prior.
"""

import random
import sys
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from plant_bench import KEYS, PAN, TracedGimbal, into_limit, keyed, profile_of
from unknown_gimbal import UnknownGimbal

from teleop.core.axes import Axis
from teleop.core.response import Response
from teleop.sim.gimbal.dynamics import Dynamics

PANS = (
    PAN,
    {**PAN, "max": 60},
    {**PAN, "acceleration": 120, "jerk": 600},
    {**PAN, "max": 90, "velocity": 100, "acceleration": 400, "jerk": 4000},
    {**PAN, "max": 45, "velocity": 90, "acceleration": 180, "jerk": 900},
)
MOVES = (
    KEYS,
    [{"at": "0s", "pan": 0}, {"at": "2s", "pan": 45}, {"at": "5s", "pan": 45}],
    [{"at": "0s", "pan": 0}, {"at": "2s", "pan": 45}, {"at": "3.5s", "pan": 60}, {"at": "5s", "pan": 100}],
    [{"at": "0s", "pan": 0}, {"at": "1s", "pan": 10}, {"at": "3s", "pan": 55}, {"at": "5s", "pan": 20}],
)


class Found(NamedTuple):
    beyond: float  # deg
    first: float  # deg, the worst at a key in the first run,
    second: float  # and in the second, whose prior is from the first
    known: float  # and in one whose prior is the truth
    notes: list[str]
    what: str


def found(number: int, more: bool) -> Found:
    chance = random.Random(number)
    dynamics: dict[str, float] = {
        "dead_time": chance.uniform(0.0, 0.1),
        "lag": chance.uniform(0.03, 0.2),
        "gain": chance.uniform(0.85, 1.1),
        "drift": chance.uniform(-1.0, 1.0),
    }
    make: Any = chance.choice([TracedGimbal, UnknownGimbal])
    far: dict[str, Any] = {}
    match chance.choice(["mode", "backlash", "age", "noise", "lost", "pushes"]) if more else "":
        case "mode":
            mode = {"natural_frequency": chance.uniform(2.5, 8), "damping": chance.uniform(0.5, 0.9)}
            dynamics |= {**mode, "lag": chance.uniform(0.02, 0.08)}
        case "backlash":
            dynamics["backlash"] = chance.uniform(0.02, 0.15)
        case "age":
            dynamics["report_age"] = chance.uniform(0.005, 0.04)
        case "noise":
            dynamics["noise"] = chance.uniform(0.02, 0.1)
        case "lost":
            share = chance.uniform(0.05, 0.3)
            far = {"lost": share} if make is UnknownGimbal else {"lost_readings": share}
        case "pushes":
            make, far = UnknownGimbal, {"pushes_at": chance.choice([10, 25, 50])}
    mode = chance.choice(["speed", "speed", "stick"])
    rate, pan, keys = chance.choice([25, 50, 50, 100]), chance.choice(PANS), chance.choice(MOVES)
    start, setting = chance.choice([-20.0, -8.0, 30.0]), {"full_stick": {"pan": 120.0}} if mode == "stick" else {}
    of = Dynamics(**dynamics)
    beyond, ran = into_limit(of, profile_of(mode, rate, pan, **setting), chance.choice([0.0, -30.0]), make=make, **far)
    profile = profile_of(mode, rate, {**pan, "max": 180}, **setting)
    first, one = keyed(of, profile, start, keys, make, **far)
    second, two = keyed(of, profile, start, keys, make, one.responses, **far)
    truth = {Axis.PAN: Response(of.dead_time, of.lag, of.gain, of.drift, 0.005, 0.01, 0.05)}
    known, three = keyed(of, profile, start, keys, make, truth, **far)
    runs = ran, one, two, three
    notes = [*(note for each in runs for note in each.notes if "otherwise" in note)]
    notes += [reason for each in runs for reason in each.reasons]
    what = {name: round(value, 3) for name, value in dynamics.items()} | far
    return Found(beyond, first, second, known, notes, f"{mode} {rate} Hz, {make.__name__}, {what}")


def main() -> None:
    numbers = [int(each) for each in sys.argv[1:] if each.isdecimal()] or [0, 100]
    more = "--more" in sys.argv
    rows = []
    for number in range(*numbers):
        rows.append(row := found(number, more))
        if row.beyond > 0.5 or row.first > 0.6 or row.second > 0.3 or row.notes:
            print(f"{number}: beyond {row.beyond:.2f}, keys {row.first:.2f}, {row.second:.2f}; {row.what} {row.notes}")
    print("deg                       median    90 %     worst")
    for name in ("beyond", "first", "second", "known"):
        values = sorted(getattr(row, name) for row in rows)
        shown = values[len(values) // 2], values[int(0.9 * len(values))], values[-1]
        print(f"{name:24}" + "".join(f"{value:9.2f}" for value in shown))
    print(f"first against known, rms {_rms(row.first for row in rows) / _rms(row.known for row in rows):.2f}")
    print(f"second against known, rms {_rms(row.second for row in rows) / _rms(row.known for row in rows):.2f}")


def _rms(values: Any) -> float:
    kept = [value * value for value in values]
    return float((sum(kept) / len(kept)) ** 0.5)


if __name__ == "__main__":
    main()
