"""The table of a run's states, as properties of every path through it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.supervisor import TRANSITIONS, Event, IllegalEventError, Result, Run, Supervisor

ORDER = list(Run)


def test_there_is_no_way_back() -> None:
    for (before, _), after in TRANSITIONS.items():
        assert ORDER.index(after) >= ORDER.index(before)


def test_fault_and_interrupt_are_legal_until_it_is_over() -> None:
    for state in ORDER[:-1]:
        for event in (Event.FAULT, Event.INTERRUPT):
            assert (state, event) in TRANSITIONS


def test_what_moves_comes_to_rest_before_it_is_released() -> None:
    into_release = [key for key, after in TRANSITIONS.items() if after is Run.RELEASING and key[0] is Run.RUNNING]
    assert into_release == []


@given(st.lists(st.sampled_from(list(Event)), max_size=20))
def test_results_only_get_worse(events: list[Event]) -> None:
    supervisor = Supervisor()
    for event in events:
        before = supervisor.result
        try:
            supervisor.happened(event, event.name)
        except IllegalEventError:
            assert (supervisor.state, event) not in TRANSITIONS
            continue
        assert supervisor.result >= before
        if event is Event.FAULT:
            assert supervisor.result is Result.FAILED


def test_the_first_reasons_are_kept_and_said_once() -> None:
    supervisor = Supervisor(Run.RUNNING)
    for number in range(100):
        supervisor.happened(Event.FAULT, "the bus is off")
        supervisor.happened(Event.FAULT, f"fault {number}")
    assert supervisor.reasons[:3] == ["the bus is off", "fault 0", "fault 1"]
    assert len(supervisor.reasons) < 10


def test_an_event_outside_the_table_is_a_defect() -> None:
    with pytest.raises(IllegalEventError, match="AT_REST while WAITING"):
        Supervisor().happened(Event.AT_REST)
