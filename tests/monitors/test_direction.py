"""The direction guard: a wrong sign is named within about a degree, and lag, noise, backlash and hands are none."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from teleop.cli import run
from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.devices.gimbal.pi_correction import PiCorrection
from teleop.monitors.direction import DirectionGuard
from teleop.sim.gimbal.firmware import DOCUMENTED

LIMITS = Limits(-180, 180, 60, 240, 1200)
PERIOD = 0.01  # s
Course = Callable[[float], float]


def swing(reach: float, seconds: float, begin: float = 1.0) -> Course:
    """There and back as a raised cosine, again and again."""
    return lambda time: 0.0 if time < begin else reach / 2 * (1 - math.cos(2 * math.pi * (time - begin) / seconds))


def drift(speed: float, begin: float = 1.0) -> Course:
    """Off at a steady speed, smoothly begun over a quarter of a second."""
    return lambda time: 0.0 if time < begin else speed * (time - begin) * min(1.0, (time - begin) / 0.5)


@dataclass
class Plant:
    """An axis: how it is sent, late, scaled and measured; a `hand` says where it is held, None where it is not."""

    speeds: bool = True
    sign: int = 1
    dead_time: float = 0.0
    lag: float = 0.05
    gain: float = 1.0
    backlash: float = 0.0
    noise: float = 0.0
    rate: int = 25
    hand: Callable[[float, float], float | None] = lambda _time, _place: None

    def watch(self, plan: Course, seconds: float, seed: int = 0) -> tuple[float, float, str]:
        """When it was said, how far from its first place the axis was by then, and what was said."""
        dice = random.Random(seed)
        guard = DirectionGuard(lambda axis: f"speed_signs: {{{axis}: -1}}", 0.0, self.speeds)
        correction = PiCorrection({Axis.PAN: LIMITS}, 0.0)
        pending: list[tuple[float, float]] = []
        place = shown = speed = command = 0.0
        reading = Reading(0.0, 0.0)
        for number in range(round(seconds / PERIOD)):
            now = number * PERIOD
            while pending and pending[0][0] <= now:
                command = pending.pop(0)[1]
            if self.speeds:
                speed += (self.sign * self.gain * command - speed) * PERIOD / max(self.lag, PERIOD)
                place += speed * PERIOD
            else:
                place += (self.sign * self.gain * command - place) * PERIOD / max(self.lag, PERIOD)
            if (held := self.hand(now, place)) is not None:
                place, speed = held, 0.0
            shown = min(max(shown, place - self.backlash / 2), place + self.backlash / 2)
            if number % (100 // self.rate) == 0:
                reading = Reading(round(shown + dice.gauss(0, self.noise), 1), now)
            state = State(plan(now), (plan(now + PERIOD) - plan(now - PERIOD)) / (2 * PERIOD))
            tick = Tick(now, {Axis.PAN: state}, {}, (), {Axis.PAN: reading})
            correction.note(tick)
            if number % 2 == 0:
                speeds = correction.speeds(tick)
                if self.speeds:
                    guard.sent(now, speeds)
                pending.append((now + self.dead_time, speeds[Axis.PAN] if self.speeds else state.position))
            try:
                guard.observe(tick)
            except DeviceError as error:
                return now, abs(place), str(error)
        return math.inf, abs(place), ""


PLANS = [swing(10.0, 4.0), swing(60.0, 4.0), swing(2.0, 4.0), drift(60.0), drift(-5.0), drift(0.5)]
PLANTS = [
    {},
    {"lag": 0.2},
    {"lag": 0.03, "dead_time": 0.1},
    {"noise": 0.1},
    {"noise": 0.1, "dead_time": 0.1, "backlash": 0.2, "gain": 0.92},
    {"backlash": 0.3, "lag": 0.12},
]


@pytest.mark.parametrize("speeds", [True, False], ids=["speeds", "positions"])
@pytest.mark.parametrize("plant", PLANTS, ids=str)
@pytest.mark.parametrize("plan", range(len(PLANS)))
def test_the_right_way_is_never_the_other(plan: int, plant: dict, speeds: bool) -> None:
    for seed in range(3):
        assert Plant(speeds=speeds, **plant).watch(PLANS[plan], 12.0, seed)[0] == math.inf


@pytest.mark.parametrize("speeds", [True, False], ids=["speeds", "positions"])
@pytest.mark.parametrize("plant", PLANTS, ids=str)
@pytest.mark.parametrize("plan", range(len(PLANS)))
def test_the_other_way_is_named_within_about_a_degree_or_a_third_of_a_second(
    plan: int, plant: dict, speeds: bool
) -> None:
    for seed in range(3):
        when, place, said = Plant(speeds=speeds, sign=-1, **plant).watch(PLANS[plan], 30.0, seed)
        began = next(n / 100 for n in range(3000) if abs(PLANS[plan](n / 100)) > 0.05)
        late = Plant(**plant).dead_time + Plant(**plant).lag + Plant(**plant).noise  # noise takes a reading or two more
        assert place < 1.7 or when - began < 0.35 + late, (when, place)
        assert said.startswith("pan goes the other way: sent ")
        assert said.endswith("the gimbal's entry in the profile needs speed_signs: {pan: -1}")


def held_at(place: float, begin: float) -> Callable[[float, float], float | None]:
    return lambda time, _place: place if time > begin else None


def pushed(far: float, begin: float, seconds: float) -> Callable[[float, float], float | None]:
    """Pushed smoothly, then held there."""

    def hand(time: float, _place: float) -> float | None:
        share = min(1.0, (time - begin) / seconds)
        return None if time < begin else far * share**3 * (10 - 15 * share + 6 * share * share)

    return hand


@pytest.mark.parametrize("speeds", [True, False], ids=["speeds", "positions"])
@pytest.mark.parametrize(
    "hand",
    [held_at(0.0, 0.0), held_at(0.3, 1.2), pushed(-3.0, 0.5, 0.3), pushed(-5.0, 1.2, 0.2), pushed(-2.0, 0.3, 0.2)],
)
@pytest.mark.parametrize("plan", range(len(PLANS)))
def test_a_hand_is_no_wrong_sign(plan: int, hand: Callable[[float, float], float | None], speeds: bool) -> None:
    for noise in (0.0, 0.1):
        when, _, said = Plant(speeds=speeds, hand=hand, noise=noise).watch(PLANS[plan], 4.0)
        assert when == math.inf, said


def test_a_hand_at_an_axis_at_rest_is_none_either() -> None:
    for far in (-4.5, 1.5, 3.0, 4.5):
        for seconds in (0.3, 0.5, 0.8, 1.2):
            when, _, said = Plant(hand=pushed(far, 1.0, seconds), noise=0.05).watch(lambda _time: 0.0, 4.0)
            assert when == math.inf, (far, seconds, said)


def test_an_axis_that_runs_away_at_rest_is_named_before_it_counts_as_stalled() -> None:
    """The correction of noise drives it off, with nothing planned."""
    for seed in range(5):
        when, place, said = Plant(sign=-1, noise=0.1).watch(lambda _time: 0.0, 10.0, seed)
        assert when < math.inf
        assert place < 5.0
        assert "goes the other way" in said


def test_an_axis_that_has_moved_the_right_way_is_not_doubted_again() -> None:
    def away(time: float, place: float) -> float | None:
        return place - 0.2 if 6.0 < time < 7.0 else None

    assert Plant(hand=away).watch(swing(10.0, 4.0), 12.0)[0] == math.inf


PROFILE = """
name: Other way
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 1200}
  tilt: {min: -56,  max: 146, velocity: 60, acceleration: 180, jerk: 900}
sinks: [{type: gimbal, link: gimbal, mode: MODE, rate: 50, SIGNS}]
"""


@pytest.mark.parametrize(
    ("mode", "signs", "needs"),
    [
        ("speed", "speed_signs: {pan: -1}", "speed_signs: {pan: 1}"),
        ("stick", "speed_signs: {pan: -1}", "speed_signs: {pan: 1}"),
        ("speed", "signs: {pan: -1}, speed_signs: {pan: 1}", "speed_signs: {pan: -1}"),
        ("position", "report_signs: {pan: -1}", "report_signs: {pan: 1}"),
        ("speed", "signs: {pan: -1}", ""),
        ("position", "signs: {tilt: -1}", ""),
    ],
)
def test_a_run_stops_with_the_line_for_the_profile_which_mends_it(
    mode: str,
    signs: str,
    needs: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The gimbal counts as documented, whatever the profile claims."""
    monkeypatch.setattr("teleop.devices.gimbal.simulated.profile_firmware", lambda _profile, _link: DOCUMENTED)
    path = tmp_path / "rig.yaml"
    path.write_text(PROFILE.replace("MODE", mode).replace("SIGNS", signs))
    code = run(["play", "nudge", "--rig", str(path), "--fast"])
    said = capsys.readouterr().err
    assert code == (1 if needs else 0), said
    if needs:
        assert "pan goes the other way: sent " in said
        assert said.count("stopped:") == 1, "and no second reason"
        assert needs in said
        path.write_text(path.read_text().replace(signs.rpartition("}, ")[2], needs))
        assert run(["play", "nudge", "--rig", str(path), "--fast"]) == 0
