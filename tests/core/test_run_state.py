"""The table of a run's states, as properties of every path through it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.run_state import TRANSITIONS, IllegalEventError, Result, RunEvent, RunState, RunStateMachine

ORDER = list(RunState)


def test_there_is_no_way_back() -> None:
    for (before, _), after in TRANSITIONS.items():
        assert ORDER.index(after) >= ORDER.index(before)


def test_fault_and_interrupt_are_legal_until_it_is_over() -> None:
    for state in ORDER[:-1]:
        for event in (RunEvent.FAULT, RunEvent.INTERRUPT):
            assert (state, event) in TRANSITIONS


def test_what_moves_comes_to_rest_before_it_is_released() -> None:
    into_release = [
        key for key, after in TRANSITIONS.items() if after is RunState.RELEASING and key[0] is RunState.RUNNING
    ]
    assert into_release == []


@given(st.lists(st.sampled_from(list(RunEvent)), max_size=20))
def test_results_only_get_worse(events: list[RunEvent]) -> None:
    supervisor = RunStateMachine()
    for event in events:
        before = supervisor.result
        try:
            supervisor.handle(event, event.name)
        except IllegalEventError:
            assert (supervisor.state, event) not in TRANSITIONS
            continue
        assert supervisor.result >= before
        if event is RunEvent.FAULT:
            assert supervisor.result is Result.FAILED


def test_the_first_reasons_are_kept_and_said_once() -> None:
    supervisor = RunStateMachine(RunState.RUNNING)
    for number in range(100):
        supervisor.handle(RunEvent.FAULT, "the bus is off")
        supervisor.handle(RunEvent.FAULT, f"fault {number}")
    assert supervisor.reasons[:3] == ["the bus is off", "fault 0", "fault 1"]
    assert len(supervisor.reasons) < 10


def test_an_event_outside_the_table_is_a_defect() -> None:
    with pytest.raises(IllegalEventError, match="AT_REST while WAITING"):
        RunStateMachine().handle(RunEvent.AT_REST)
