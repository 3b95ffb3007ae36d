"""Whatever is raised in a call becomes a fault with a reason; only leaving at once goes through."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from teleop.core.errors import DeviceError, Interrupted, LeaveAtOnce
from teleop.core.guarded_calls import FAULTS, GuardedCalls
from teleop.core.run_state import Result, RunState, RunStateMachine


class WordlessError(Exception):
    def __str__(self) -> str:
        raise ValueError("no text")


def raising(error: BaseException) -> Callable[[], object]:
    def call() -> object:
        raise error

    return call


def running() -> tuple[RunStateMachine, list[str], GuardedCalls]:
    run, interrupts = RunStateMachine(RunState.RUNNING), []
    return run, interrupts, GuardedCalls(run, interrupts.append)


def test_a_call_that_returns_is_passed_through():
    run, _, calls = running()
    assert calls.guarded(lambda one, other: one + other, 2, 3, default=0) == 5
    assert (run.state, calls.faults) == (RunState.RUNNING, [])


@pytest.mark.parametrize(
    ("error", "result", "reason"),
    [
        (DeviceError("no reply"), Result.FAILED, "no reply"),
        (ValueError("odd"), Result.FAILED, "ValueError: odd"),
        (SystemExit(3), Result.FAILED, "SystemExit: 3"),
        (WordlessError(), Result.FAILED, "WordlessError"),
        (Interrupted("stopped by keys"), Result.INTERRUPTED, "stopped by keys"),
    ],
)
def test_what_is_raised_stops_the_run_with_a_reason(error: BaseException, result: Result, reason: str):
    run, _, calls = running()
    assert calls.guarded(raising(error), default="default") == "default"
    assert (run.state, run.result, run.reasons) == (RunState.STOPPING, result, [reason])
    assert calls.faults == [error]


def test_a_ctrl_c_without_a_handler_is_an_interrupt_and_no_fault():
    run, interrupts, calls = running()
    assert calls.guarded(raising(KeyboardInterrupt())) is None
    assert (interrupts, calls.faults, run.state) == (["Ctrl-C"], [], RunState.RUNNING)


def test_leaving_at_once_goes_through_both():
    _, _, calls = running()
    for call in (calls.guarded, calls.quietly):
        with pytest.raises(LeaveAtOnce):
            call(raising(LeaveAtOnce("SIGTERM")))


def test_a_quiet_call_changes_nothing_about_the_run():
    run, interrupts, calls = running()
    assert calls.quietly(raising(ValueError("late")), default=7) == 7
    assert calls.quietly(raising(KeyboardInterrupt()), default=8) == 8
    assert (run.state, run.result, interrupts, calls.faults) == (RunState.RUNNING, Result.DONE, [], [])


def test_a_fault_of_every_tick_is_kept_a_few_times():
    _, _, calls = running()
    for number in range(3 * FAULTS):
        calls.guarded(raising(DeviceError(f"tick {number}")))
    assert [str(fault) for fault in calls.faults] == [f"tick {number}" for number in range(FAULTS)]
