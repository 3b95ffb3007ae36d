"""An event device's bytes become reports: whole frames, what was held at the start, dropped events, unplugging."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest
from fake_evdev import ABS, EAST, KEY, REL, SOUTH, SYN, FakeEvents, X, Y

from teleop.inputs.evdev.device import EventDevice
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.descriptor.report import read_report


class Reader:
    def __init__(self, events: FakeEvents) -> None:
        self.device = EventDevice(events, keeps_names=False)
        self._descriptor = parse_descriptor(self.device.get_report_descriptor())

    def values(self, report: bytes) -> dict[str, int]:
        return {control.name: control.value for control in read_report(self._descriptor, report)}

    def next(self, *names: str) -> list[int] | None:
        """These values of the next report; None when there is none."""
        report = self.device.read(0)
        return [self.values(report)[name] for name in names] if report else None


@pytest.fixture
def events() -> Iterator[FakeEvents]:
    events = FakeEvents()
    yield events
    assert events.grabbed == 0


def test_the_first_report_is_the_device_as_it_was_when_opened(events: FakeEvents) -> None:
    events.axes[X].value = -20000
    events.held.add(EAST)
    reader = Reader(events)
    assert reader.next("X", "Y", "Button 1", "Button 2") == [-20000, 0, 0, 1]
    assert reader.next() is None


def test_a_frame_is_one_report_and_nothing_is_lost_between_two_reads(events: FakeEvents) -> None:
    reader = Reader(events)
    reader.device.read(0)
    events.frame((ABS, X, 100), (ABS, Y, -200))
    events.frame((KEY, SOUTH, 1))
    events.frame((KEY, SOUTH, 0))
    names = "X", "Y", "Button 1"
    assert [reader.next(*names) for _ in range(4)] == [[100, -200, 0], [100, -200, 1], [100, -200, 0], None]


def test_a_frame_that_has_not_ended_and_one_of_nothing_that_is_read_are_no_reports(events: FakeEvents) -> None:
    reader = Reader(events)
    reader.device.read(0)
    events.raw((ABS, X, 7))
    events.raw((4, 4, 99))  # EV_MSC
    assert reader.next() is None
    events.raw((SYN, 0, 0), (4, 4, 99), (SYN, 0, 0))
    assert [reader.next("X"), reader.next("X")] == [[7], None]


def test_an_event_cut_in_two_by_a_pipe_is_put_together(events: FakeEvents) -> None:
    reader = Reader(events)
    reader.device.read(0)
    end, events._end = events._end, os.open(os.devnull, os.O_WRONLY)
    receive, send = os.pipe()
    events._end = send
    events.frame((ABS, X, 7))
    data = os.read(receive, 4096)
    os.write(end, data[:30])
    assert reader.next("X") is None
    os.write(end, data[30:])
    assert reader.next("X") == [7]


def test_after_dropped_events_the_kernel_is_asked_and_what_was_in_between_does_not_count(events: FakeEvents) -> None:
    reader = Reader(events)
    reader.device.read(0)
    events.raw((ABS, X, 50), (SYN, 3, 0), (ABS, X, 60))  # SYN_DROPPED
    events.axes[X].value = 70
    events.held.add(EAST)
    events.raw((ABS, Y, 5), (SYN, 0, 0))
    assert reader.next("X", "Y", "Button 2") == [70, 0, 1]
    events.frame((ABS, Y, 6))
    assert reader.next("X", "Y") == [70, 6]


def test_counts_of_a_wheel_belong_to_their_frame() -> None:
    events = FakeEvents(keys=[SOUTH], wheels=[7])
    reader = Reader(events)
    reader.device.read(0)
    events.frame((REL, 7, 1), (REL, 7, 2))
    events.frame((ABS, X, 1))
    assert [reader.next("Dial"), reader.next("Dial")] == [[3], [0]]


def test_asked_it_answers_as_long_as_the_kernel_has_it(events: FakeEvents) -> None:
    reader = Reader(events)
    events.frame((ABS, X, 9))
    reader.device.read(0)
    reader.device.read(0)
    report = reader.device.get_input_report(0, 4096)
    assert reader.values(report)["X"] == 9
    events.pull()
    with pytest.raises(OSError, match="No such device"):
        reader.device.get_input_report(0, 4096)


def test_unplugged_it_raises_and_not_before_its_last_events_are_read(events: FakeEvents) -> None:
    reader = Reader(events)
    reader.device.read(0)
    events.frame((KEY, EAST, 1))
    events.pull()
    assert reader.next("Button 2") == [1]
    with pytest.raises(OSError, match="No such device"):
        reader.device.read(0)
    reader.device.close()
    assert events.closed == 1


def test_a_key_that_repeats_itself_is_pressed_once(events: FakeEvents) -> None:
    reader = Reader(events)
    reader.device.read(0)
    events.frame((KEY, EAST, 1))
    events.frame((KEY, EAST, 2))
    assert [reader.next("Button 2"), reader.next("Button 2")] == [[1], [1]]
