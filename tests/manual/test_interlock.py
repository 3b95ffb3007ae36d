"""Whether an input may move anything: centered once, enabled anew, and nothing in trouble."""

from __future__ import annotations

from hands import FakeInput
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis
from teleop.manual.interlock import CENTER, ENABLE, JITTER, OFF, Interlock


def test_an_input_is_locked_until_its_sticks_were_centered() -> None:
    pad = FakeInput()
    lock = Interlock(pad)
    pad.hold(pan=0.5)
    lock.read(0.0, True)
    assert lock.waits_for == CENTER
    pad.hold(pan=0.0)
    lock.read(0.1, True)
    assert lock.unlocked
    pad.hold(pan=0.5)
    lock.read(0.2, True)
    assert lock.unlocked, "once is enough"


def test_an_enable_button_held_from_the_beginning_does_not_count() -> None:
    pad = FakeInput(enabled=True)
    lock = Interlock(pad)
    waits = []
    for held in (True, False, True, False):
        pad.enabled = held
        lock.read(0.0, True)
        waits.append(lock.waits_for)
    assert waits == [ENABLE, ENABLE, "", ENABLE]


def test_the_switch_is_for_inputs_without_an_enable_button() -> None:
    plain, with_button = Interlock(FakeInput()), FakeInput(enabled=False)
    lock = Interlock(with_button)
    plain.read(0.0, False)
    assert plain.waits_for == OFF
    lock.read(0.0, False)
    with_button.enabled = True
    lock.read(0.1, False)
    assert lock.unlocked


def test_after_a_trouble_it_must_be_centered_again() -> None:
    pad = FakeInput()
    lock = Interlock(pad)
    lock.read(0.0, True)
    pad.trouble = "pad: unplugged"
    pad.hold(pan=1.0)
    lock.read(0.1, True)
    assert lock.waits_for == "pad: unplugged"
    pad.trouble = ""
    lock.read(0.2, True)
    assert lock.waits_for == CENTER


@given(st.lists(st.floats(0, 1), min_size=1, max_size=30))
def test_a_slider_counts_as_moved_only_when_it_moved_further_than_jitter(places: list[float]) -> None:
    pad = FakeInput()
    lock = Interlock(pad)
    last = places[0]
    for index, place in enumerate(places):
        pad.positions = {Axis.FOCUS: place}
        lock.read(0.0, True)
        moved = index > 0 and abs(place - last) > JITTER
        assert lock.slid() == ({Axis.FOCUS: place} if moved else {})
        last = place if moved else last
