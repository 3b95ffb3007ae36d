"""The table of a timelapse's phases: a pause is only between two frames, and a shutter that was pressed ends."""

from __future__ import annotations

from teleop.timelapse.phases import TRANSITIONS, PhaseEvent, TimelapsePhase


def test_every_phase_is_reached_and_only_the_last_is_never_left() -> None:
    assert {TimelapsePhase.APPROACH, *TRANSITIONS.values()} == set(TimelapsePhase)
    assert {phase for phase, _ in TRANSITIONS} == set(TimelapsePhase) - {TimelapsePhase.OVER}
    assert {event for _, event in TRANSITIONS} == set(PhaseEvent)


def test_a_pause_comes_only_between_two_frames() -> None:
    assert [phase for phase, event in TRANSITIONS if event is PhaseEvent.PAUSE] == [TimelapsePhase.WAIT]


def test_a_frame_whose_shutter_was_pressed_is_exposed_to_its_end() -> None:
    assert [event for phase, event in TRANSITIONS if phase is TimelapsePhase.EXPOSE] == [PhaseEvent.EXPOSED]


def test_after_a_stop_the_frame_is_approached_again() -> None:
    stopped = {TRANSITIONS[phase, event] for phase, event in TRANSITIONS if event is PhaseEvent.STOP}
    assert stopped == {TimelapsePhase.STOPPED}
    assert TRANSITIONS[TimelapsePhase.STOPPED, PhaseEvent.RESTART] is TimelapsePhase.APPROACH
