"""`teleop calibrate` under a STOP of an input and a signal: what leaves on the wire, and what is measured then."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from silent_screen import SilentScreen, no_signals
from wire import Tap, tapped

from teleop.app.calibration import measure_response
from teleop.app.calibration.measure_response import ResponseReport, measure_responses
from teleop.app.run import Signals
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.operator_input import Command, Held, Press
from teleop.core.run_state import Result
from teleop.devices import rig as rigs
from teleop.dji.gimbal import messages as gimbal
from teleop.manual.stop_guard import Relay, StopGuard

PROFILE = """
name: Bench
links: {gimbal: "sim:"}
axes: {pan: {min: -90, max: 90, velocity: 60, acceleration: 240, jerk: 1200}}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50, simulated: {lag: 0.12, dead_time: 0.06}}]
"""
Presses = Sequence[tuple[float, Command]]


class Pad:
    """A pad whose buttons are pressed at times (s) of the loop's clock."""

    name = "pad"

    def __init__(self, presses: Presses) -> None:
        self._presses = list(presses)

    def read(self, now: float) -> Held:
        due = [Press(command) for at, command in self._presses if at <= now]
        self._presses = [each for each in self._presses if each[0] > now]
        return Held(presses=due)


class Bench:
    """Measures pan of a rig under a pad, with a tap on its wire."""

    def __init__(self, folder: Path, presses: Presses, patch: pytest.MonkeyPatch) -> None:
        self.taps: list[Tap] = []
        self.clock, self._profile = VirtualClock(), folder / "rig.yaml"
        self._profile.write_text(PROFILE)
        open_rig = rigs.open_rig

        @contextmanager
        def opened(*given: Any, **options: Any) -> Iterator[rigs.Rig]:
            with open_rig(*given, **options) as rig:
                self.taps.append(tapped(rig))
                yield rig

        patch.setattr(measure_response, "open_rig", opened)
        patch.setattr(
            measure_response, "guarded", lambda _stack, move, *_: (StopGuard(move, [Relay(Pad(presses))]), [])
        )

    def measure(self, signals: Signals = no_signals) -> ResponseReport:
        screen = SilentScreen()
        profile = load_profile(str(self._profile))
        return measure_responses(profile, Axis.PAN, self.clock, lambda *_: screen, signals, print, None)

    def speeds(self, begin: float, end: float) -> list[gimbal.Speed]:
        """Those that were sent between the two times."""
        return [message for time, message in self.taps[0].of(gimbal.Speed) if begin <= time <= end]

    @property
    def given_back(self) -> bool:
        return not self.taps[0].of(gimbal.Speed)[-1][1].take_over


def test_a_stop_of_an_input_brings_it_to_rest_and_it_is_measured_from_the_first_swing_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = Bench(tmp_path, [(6.0, Command.STOP), (10.0, Command.CLEAR), (10.5, Command.GO)], monkeypatch)
    report = bench.measure()
    assert any(speed.yaw for speed in bench.speeds(5.0, 6.0))
    assert all(abs(speed.yaw) < 0.2 for speed in bench.speeds(7.0, 10.0))  # the axis is held, and no more
    assert bench.given_back
    assert report.result is Result.DONE
    [found] = report.axes
    assert found.response.delay == pytest.approx(0.18, abs=0.01)
    assert found.readings[0].time > 10.5


def test_a_stop_and_an_end_measure_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(tmp_path, [(6.0, Command.STOP), (8.0, Command.QUIT)], monkeypatch)
    report = bench.measure()
    assert report.result is not Result.DONE
    assert not report.axes
    assert bench.given_back
    assert not any(speed.yaw for speed in bench.speeds(7.0, 60.0))


def test_a_signal_brings_it_to_rest_and_measures_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench(tmp_path, [], monkeypatch)

    @contextmanager
    def signals(interrupt: Callable[[str], object], *_: object) -> Iterator[None]:
        begin, sleep = bench.clock.now(), bench.clock.sleep_until

        def slept(time: float) -> None:
            sleep(time)
            if time > begin + 6.0:
                interrupt("SIGTERM received")

        monkeypatch.setattr(bench.clock, "sleep_until", slept)
        yield

    report = bench.measure(signals)
    assert (report.result, list(report.reasons)) == (Result.INTERRUPTED, ["SIGTERM received"])
    assert not report.axes
    assert any(speed.yaw for speed in bench.speeds(5.0, 6.0))
    assert bench.given_back
    assert not any(speed.yaw for speed in bench.speeds(7.0, 60.0))
