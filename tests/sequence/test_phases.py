"""The table of a sequence's phases: nothing leads nowhere, and the end is reached from everywhere."""

from __future__ import annotations

from teleop.sequence.phases import BEFORE_THE_MOVE, TIMED, TRANSITIONS, PhaseEvent, SequencePhase


def test_every_phase_is_reached_and_only_the_last_is_never_left() -> None:
    reached = {SequencePhase.EASING, *TRANSITIONS.values()}
    left = {phase for phase, _ in TRANSITIONS}
    assert reached == set(SequencePhase)
    assert left == set(SequencePhase) - {SequencePhase.OVER}
    assert {event for _, event in TRANSITIONS} == set(PhaseEvent)


def test_what_can_be_stopped_can_be_resumed() -> None:
    resumed = {
        phase: TRANSITIONS[phase, PhaseEvent.RESUME] for phase in SequencePhase if phase is not SequencePhase.OVER
    }
    assert set(resumed.values()) <= TIMED, "an axis that was stopped is first eased to where it should be"
    assert {resumed[phase] for phase in BEFORE_THE_MOVE} == {SequencePhase.EASING}
