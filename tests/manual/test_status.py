"""The operator's messages: newest first, none twice, one for each change of an input."""

from __future__ import annotations

from hands import FakeInput

from teleop.core.axes import Axis
from teleop.manual.interlock import Interlock
from teleop.manual.status import KEPT, MessageLog


def test_the_newest_message_comes_first_and_a_repeated_one_is_only_renewed() -> None:
    log = MessageLog()
    for time, text in enumerate(["one", "two", "two"]):
        log.notify(time, text)
    assert [(message.time, message.text) for message in log.messages] == [(2, "two"), (0, "one")]


def test_only_so_many_are_kept() -> None:
    log = MessageLog()
    for number in range(KEPT + 5):
        log.notify(number, str(number))
    assert len(log.messages) == KEPT
    assert log.messages[0].text == str(KEPT + 4)


def test_a_lost_input_is_named_with_the_axes_that_it_stops_and_once() -> None:
    pad, log = FakeInput(), MessageLog()
    lock = Interlock(pad)
    lock.read(0.0, True)
    pad.trouble = "pad: unplugged"
    lock.read(0.1, True)
    assert list(log.changes([lock], {Axis.PAN: lock})) == ["pad: unplugged: pan stopped"]
    assert list(log.changes([lock], {})) == []
    pad.trouble = ""
    lock.read(0.2, True)
    assert list(log.changes([lock], {})) == ["pad: ready"]


def test_a_locked_input_that_is_deflected_is_explained_once_until_it_is_unlocked() -> None:
    pad, log = FakeInput(), MessageLog()
    lock = Interlock(pad)
    pad.hold(pan=1.0)
    lock.read(0.0, True)
    assert list(log.changes([lock], {})) == ["pad is locked: center its sticks"]
    assert list(log.changes([lock], {})) == []
    pad.hold(pan=0.0)
    lock.read(0.1, True)
    assert list(log.changes([lock], {})) == []
    lock.relock()
    pad.hold(pan=1.0)
    lock.read(0.2, True)
    assert list(log.changes([lock], {})) == ["pad is locked: center its sticks"]
