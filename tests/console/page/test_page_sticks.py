"""Sticks of the page: 50 messages a second while a finger is down, three zeros at release, no way to lose a hand."""

from __future__ import annotations

import re

import pytest
from page_bench import PHONE, take_control, until
from playwright.sync_api import expect

ZERO = {"pan": 0, "tilt": 0}


HANG = """setTimeout(() => {
    const end = Date.now() + 2000;
    while (Date.now() < end);
    window.hung = performance.now();
})"""


def press(page, testid="stick-pan-tilt", dx=0.25, dy=-0.1):
    """The mouse down in the middle of a stick, then dragged by shares of its width."""
    box = page.get_by_test_id(testid).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + dx * box["width"], y + dy * box["width"], steps=4)


def ended(rig):
    """Whether the stream has ended with three zeros, each not held."""
    tail = rig.sticks[-3:]
    return len(tail) == 3 and all(not any(each["axes"].values()) and not each["hold"] for each in tail)


@pytest.fixture
def held(visit, rig):
    page = visit()
    take_control(page)
    press(page)
    until(lambda: len(rig.sticks) > 5 and any(rig.sticks[-1]["axes"].values()))
    return page


def test_a_drag_moves_and_a_release_ends_with_three_zeros_then_silence(held, rig):
    until(lambda: rig.at["pan"] > 1)
    assert held.get_by_test_id("measured-pan").inner_text().startswith("+")
    held.mouse.up()
    until(lambda: ended(rig))
    count = len(rig.sticks)
    held.wait_for_timeout(300)
    assert len(rig.sticks) == count
    assert rig.sticks[0]["axes"] == ZERO  # seen centered first
    assert rig.sticks[-4]["axes"] == {"pan": 0.694, "tilt": 0.278}


def test_messages_are_numbered_and_fifty_a_second(held, rig):
    first = rig.sticks[-1]
    until(lambda: rig.sticks[-1]["seq"] >= first["seq"] + 50)
    held.mouse.up()
    numbers = [each["seq"] for each in rig.sticks]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    since = [each for each in rig.sticks if first["seq"] <= each["seq"] <= first["seq"] + 50]
    assert (since[-1]["time"] - since[0]["time"]) / 50 >= 19.5  # ms; a busy machine sends fewer, never more


@pytest.mark.parametrize("event", ["blur", "pagehide", "freeze", "orientationchange"])
def test_what_takes_the_page_away_releases_the_stick(held, rig, event):
    held.evaluate(f"window.dispatchEvent(new Event('{event}'))")
    until(lambda: ended(rig))


@pytest.mark.parametrize("event", ["pointercancel", "lostpointercapture"])
def test_a_pointer_that_is_lost_releases_the_stick(held, rig, event):
    held.evaluate(
        f"""document.querySelector('[data-testid=stick-pan-tilt]').dispatchEvent(
            new PointerEvent('{event}', {{pointerId: 1, bubbles: true}}))"""
    )
    until(lambda: ended(rig))


def test_a_page_that_is_hidden_in_mid_drag_releases_the_stick(held, rig):
    held.evaluate(
        """Object.defineProperty(document, 'hidden', {get: () => true});
           document.dispatchEvent(new Event('visibilitychange'))"""
    )
    until(lambda: ended(rig))
    count = len(rig.sticks)
    held.mouse.move(5, 5)  # the finger is still down: it moves nothing until it comes down again
    held.wait_for_timeout(200)
    assert len(rig.sticks) == count


def test_a_script_that_hangs_in_mid_drag_comes_back_as_a_watcher_and_moves_nothing(held, rig):
    held.evaluate(HANG)
    held.get_by_test_id("take-control").wait_for()
    held.mouse.move(9, 9)
    ended_at = held.evaluate("window.hung")
    deflected = [each["time"] for each in rig.sticks if any(each["axes"].values())]
    assert deflected[-1] < ended_at - 1900  # after the hang came zeros, if anything
    assert abs(rig.speed["pan"]) == 0


def test_nothing_moves_without_control_and_the_page_says_why(visit, rig):
    page = visit()
    page.get_by_test_id("take-control").wait_for()
    press(page)
    page.get_by_text("take control first").wait_for()
    page.mouse.up()
    assert rig.sticks == []


def test_two_fingers_move_four_axes(visit, rig):
    page = visit(PHONE, touch=True)
    take_control(page)
    client = page.context.new_cdp_session(page)
    left, right = (page.get_by_test_id(name).bounding_box() for name in ("stick-pan-tilt", "stick-roll-focus"))
    points = [
        {"x": box["x"] + box["width"] / 2 + dx, "y": box["y"] + box["height"] / 2, "id": number}
        for number, (box, dx) in enumerate([(left, 0), (right, 0)])
    ]
    client.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": points})
    moved = [{**point, "x": point["x"] + 40, "y": point["y"] - 20} for point in points]
    client.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": moved})
    until(lambda: rig.sticks and len([each for each in rig.sticks[-1]["axes"].values() if each > 0.1]) == 4)
    client.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    until(lambda: ended(rig))


def test_a_locked_stick_moves_one_axis_or_none(visit, rig):
    page = visit()
    take_control(page)
    lock = page.get_by_role("button", name="Lock of stick pan and tilt")
    lock.click()
    press(page)
    until(lambda: rig.sticks and rig.sticks[-1]["axes"]["pan"] > 0.5)
    page.mouse.up()
    assert not any(each["axes"].get("tilt") for each in rig.sticks)
    until(lambda: ended(rig))
    count = len(rig.sticks)
    lock.click()
    lock.click()
    press(page)
    page.mouse.up()
    page.get_by_text("this stick is locked").wait_for()
    assert len(rig.sticks) == count


GAMEPAD = """
window.pad = {connected: true, mapping: "standard", index: 0, axes: [0, 0, 0, 0], buttons: []};
navigator.getGamepads = () => [window.pad];
"""


def test_a_gamepad_is_a_stick_that_must_be_centered_first(visit, rig):
    page = visit()
    page.evaluate(GAMEPAD + "window.pad.axes = [0.55, 0, 0, 0]; window.dispatchEvent(new Event('gamepadconnected'))")
    take_control(page)
    page.wait_for_timeout(200)
    assert rig.sticks == []
    expect(page.get_by_test_id("gamepad")).to_have_text("center its sticks")
    page.evaluate("window.pad.axes = [0, 0, 0, 0]")
    expect(page.get_by_test_id("gamepad")).to_have_text("ready")
    page.evaluate("window.pad.axes = [0.55, 0, 0, 0]")
    until(lambda: rig.sticks and rig.sticks[-1]["axes"]["pan"] == 0.5)
    page.evaluate("window.dispatchEvent(new Event('blur'))")
    until(lambda: ended(rig))
    page.wait_for_timeout(200)
    assert ended(rig)  # still deflected: it counts again once it was centered
    expect(page.get_by_test_id("gamepad")).to_have_text("center its sticks")


def test_a_gamepad_that_is_unplugged_in_mid_deflection_is_released(visit, rig):
    page = visit()
    take_control(page)
    page.evaluate(GAMEPAD + "window.dispatchEvent(new Event('gamepadconnected'))")
    expect(page.get_by_test_id("gamepad")).to_have_text("ready")
    page.evaluate("window.pad.axes = [0, -1, 0, 0]")
    until(lambda: rig.sticks and rig.sticks[-1]["axes"]["tilt"] == 1)
    page.evaluate("window.pad.connected = false; window.dispatchEvent(new Event('gamepaddisconnected'))")
    until(lambda: ended(rig))
    expect(page.get_by_test_id("gamepad")).to_have_count(0)


def test_a_late_stick_is_amber_before_it_ramps_and_the_page_says_what_was_missed(visit, rig):
    page = visit()
    chip = page.get_by_test_id("stick-age")
    for age, missed, text, tone in (
        (None, 0, "0 missed", "chip"),
        (40.0, 0, "40 ms, 0 missed", "good"),
        (180.0, 0, "180 ms, 0 missed", "warn"),
        (400.0, 3, "400 ms, 3 missed", "bad"),
        (None, 3, "3 missed", "warn"),
    ):
        rig.more["sticks"].update(age_ms=age, missed=missed)
        expect(chip).to_have_text(text)
        expect(chip.locator("..")).to_have_class(re.compile(rf"\b{tone}\b"))
