"""A sequence on a simulated rig: with and without keys, with a trim, and ended in the tick in which a cue is due."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Self, cast

import pytest
from fake_hid import FakeBackend
from silent_screen import SilentScreen, no_signals

from teleop.app import operator_inputs, stop_inputs
from teleop.app.planning import plan_content
from teleop.app.play import devices_in_use, source_of
from teleop.app.sequence_run import NO_INPUT, SequenceReport, SequenceRun
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.core.events import Tick
from teleop.core.operator_input import Command, Held, Press
from teleop.core.run_state import Result
from teleop.devices import rig
from teleop.inputs.keyboard import Keyboard
from teleop.sequence.cycle import Cycle
from teleop.sim.gimbal.device import SimulatedGimbal

FILMED = {
    "keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pan": 10}],
    "cues": [{"at": 0, "camera": "record"}, {"at": 1, "camera": "stop"}],
}


class Keys:
    """The keys of a terminal: each press at a time (s) of the loop's clock."""

    name = "keys"

    def __init__(self, presses: Sequence[tuple[float, Command]]) -> None:
        self._presses = list(presses)
        self.entered = threading.Event()

    def read(self, now: float) -> Held:
        due = [Press(command) for at, command in self._presses if at <= now + 1e-6]
        self._presses = [(at, command) for at, command in self._presses if at > now + 1e-6]
        return Held(presses=due, stop="")

    def observe(self, tick: Tick) -> None: ...

    def __enter__(self) -> Self:
        self.entered.set()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


@pytest.fixture
def gimbals(monkeypatch: pytest.MonkeyPatch) -> list[SimulatedGimbal]:
    """Those that are made for the rig."""
    made: list[SimulatedGimbal] = []

    def make(**options: Any) -> SimulatedGimbal:
        made.append(SimulatedGimbal(**options))
        return made[-1]

    monkeypatch.setattr(rig, "SimulatedGimbal", make)
    monkeypatch.setattr(stop_inputs, "AllDevices", FakeBackend)
    monkeypatch.setattr(operator_inputs, "AllDevices", FakeBackend)
    return made


def run_of(
    screen: SilentScreen, keys: Keys | None = None, share: float = 1.0, cycle: Cycle | None = None
) -> SequenceRun:
    plan = plan_content(FILMED, load_profile("sim"))
    profile = devices_in_use(plan, shoots=False)
    source = source_of(plan.sequence, profile, share, 1.0, cycle or Cycle())
    keyboard = cast(Keyboard | None, keys)
    return SequenceRun(profile, plan.sequence, source, VirtualClock(), keyboard, screen.notify, screen.notify, share)


def performed(screen: SilentScreen, run: SequenceRun) -> SequenceReport:
    return run.perform(lambda _limits, _status, _recorder: screen, no_signals)


def test_a_sequence_is_played_to_its_end(gimbals: list[SimulatedGimbal]):
    screen = SilentScreen()
    report = performed(screen, run_of(screen))
    assert (report.run.result, report.trim, report.repeatability) == (Result.DONE, None, None)
    assert screen.ticks[-1].motion[Axis.PAN].position == pytest.approx(10)
    assert not gimbals[0]._camera.recording


def test_passes_are_compared(gimbals: list[SimulatedGimbal]):
    screen = SilentScreen()
    report = performed(screen, run_of(screen, cycle=Cycle(passes=2, compared=True)))
    assert report.repeatability is not None
    assert list(report.repeatability.passes) == [2]


def test_a_stop_by_the_keys_holds_the_run_and_is_among_the_reasons(gimbals: list[SimulatedGimbal]):
    screen = SilentScreen()
    keys = Keys([(1.0, Command.STOP), (5.0, Command.QUIT)])
    report = performed(screen, run_of(screen, keys))
    assert keys.entered.is_set()
    assert report.run.result is Result.INTERRUPTED
    assert report.run.reasons[-1] == "ended while stopped: STOP by keys"
    assert any(line.startswith("STOP by keys") for line in screen.said)
    assert screen.ticks[-1].time > 5.0


@pytest.mark.parametrize("ticks", [-1, 0, 1])
def test_a_camera_is_stopped_whatever_the_tick_in_which_an_operator_ends_the_run(
    gimbals: list[SimulatedGimbal], ticks: int
):
    first = SilentScreen()
    performed(first, run_of(first))
    due = next(tick.time for tick in first.ticks if "stop" in tick.actions)
    screen = SilentScreen()
    report = performed(screen, run_of(screen, Keys([(due + ticks * 0.01, Command.QUIT)])))
    assert report.run.result is Result.INTERRUPTED
    assert any("record" in tick.actions for tick in screen.ticks)
    assert any("stop" in tick.actions for tick in screen.ticks) == (ticks > 0)
    assert not gimbals[-1]._camera.recording


def test_a_trim_needs_something_to_trim_with(gimbals: list[SimulatedGimbal]):
    screen = SilentScreen()
    with pytest.raises(UsageError, match=NO_INPUT):
        performed(screen, run_of(screen, share=0.8))
    assert gimbals == []  # refused before a link is opened
    report = performed(screen, run_of(screen, Keys([]), share=0.8))
    assert report.trim is not None
    assert report.run.result is Result.DONE
