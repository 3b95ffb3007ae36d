"""One frame: written down, focused, pressed, released, answered, each at its time."""

from __future__ import annotations

import pytest
from timelapse_bench import Book

from teleop.core.events import Exposure, ShutterResult, ShutterStep
from teleop.timelapse.budget import Phases
from teleop.timelapse.frame_log import FrameLog
from teleop.timelapse.frame_shutter import ANSWER_TIMEOUT, FrameShutter
from teleop.timelapse.journal import FrameState
from teleop.timelapse.progress import Progress
from teleop.timelapse.schedule import Schedule


def shutter(book: Book, prefocus: float = 1.0) -> FrameShutter:
    phases = Phases(prefocus=prefocus, exposure=0.5, post=0.2, settle=0.3, below=None)
    return FrameShutter(phases, FrameLog(book, Progress(Schedule(5, 5, 10), None), False))


def test_it_is_ready_when_it_is_focused_and_on_the_disk() -> None:
    book = Book()
    book.writes = False
    one = shutter(book)
    one.begin(3, 10.0)
    assert one.take_events() == [Exposure(3, ShutterStep.FOCUS)]
    assert not one.ready(11.0), "not on the disk yet"
    book.notes[-1].safe = True
    assert not one.ready(10.99)
    assert one.ready(11.0)


def test_its_steps_have_their_times_and_each_event_is_given_once() -> None:
    one = shutter(Book())
    one.begin(3, 10.0)
    one.press(11.0)
    assert (one.exposed_at, one.done_at) == (11.5, 11.7)
    one.release()
    steps = [event.step for event in one.take_events() if isinstance(event, Exposure)]
    assert steps == [ShutterStep.FOCUS, ShutterStep.PRESS, ShutterStep.RELEASE]
    assert one.take_events() == []


def test_an_answer_counts_when_the_frame_is_done_and_only_once() -> None:
    book = Book()
    one = shutter(book)
    one.begin(3, 10.0)
    one.press(11.0)
    one.on_result(ShutterResult(2, 0))
    assert not one.answered, "that was another frame"
    one.on_result(ShutterResult(3, 0))
    assert book.states(3) == [FrameState.BEGUN, FrameState.DONE]
    assert one.result(11.69) is None
    assert one.result(11.7) == ShutterResult(3, 0)
    assert one.result(11.8) is None


def test_a_silent_camera_is_given_time_for_a_lost_link_to_be_found_out() -> None:
    one = shutter(Book())
    one.begin(3, 10.0)
    one.press(11.0)
    one.on_result(ShutterResult(3, None))
    assert one.result(11.0 + ANSWER_TIMEOUT - 0.001) is None
    assert one.result(11.0 + ANSWER_TIMEOUT) == ShutterResult(3, None)


@pytest.mark.parametrize(("prefocus", "steps"), [(1.0, [ShutterStep.FOCUS, ShutterStep.RELEASE]), (0.0, [])])
def test_a_frame_that_is_given_up_counts_as_not_begun(prefocus: float, steps: list[ShutterStep]) -> None:
    book = Book()
    one = shutter(book, prefocus)
    one.begin(3, 10.0)
    one.give_up()
    assert [event.step for event in one.take_events() if isinstance(event, Exposure)] == steps
    assert book.states(3) == [FrameState.BEGUN, FrameState.UNSHOT]
