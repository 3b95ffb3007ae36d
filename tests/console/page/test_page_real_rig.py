"""The page on `teleop console` with the simulated gimbal: its gateway stopped, killed, and shut to strangers."""

from __future__ import annotations

import os
import signal
import urllib.error
import urllib.request
from contextlib import ExitStack

import pytest
from page_bench import PHONE, REFUSED, take_control, until
from playwright.sync_api import expect
from real_console import RealConsole


@pytest.fixture(scope="module")
def consoles():
    with ExitStack() as stack:
        yield stack, []


@pytest.fixture
def console(consoles, tmp_path):
    """One for all tests; a new one where a stall of this computer has ended it, as it has to."""
    stack, made = consoles
    if not made or not made[-1].lives:
        made.append(stack.enter_context(RealConsole(tmp_path)))
    (made[-1].folder / "mine.yaml").write_text(MOVE)
    return made[-1]


@pytest.fixture
def visit(browser, console):
    browser.errors.clear()
    browser.allowed = REFUSED  # the gateway is killed in some of these
    yield lambda *args, at="", **options: browser.open(console.url + at, *args, **options)
    browser.close()
    assert browser.errors == []
    until(lambda: console.state.get("holder") is None)


MOVE = """\
# From the left to the right.
title: Mine
keyframes:
  - {at: 0, pan: 0, tilt: 0}      # begin
  - {at: 2s, pan: 10, tilt: 4}    # the door
  - {at: 4s, pan: 0}
"""


def drag(page, testid="stick-pan-tilt", dx=0.3, dy=0.0):
    page.get_by_test_id(testid).scroll_into_view_if_needed()
    box = page.get_by_test_id(testid).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + dx * box["width"], y + dy * box["width"], steps=4)


@pytest.fixture
def moving(visit, console):
    page = visit()
    take_control(page)
    drag(page)
    until(lambda: console.axis("pan")["speed"] > 1)
    return page


def test_a_drag_moves_the_gimbal_and_a_release_brings_it_to_rest(moving, console):
    before = console.axis("pan")["measured"]
    until(lambda: console.axis("pan")["measured"] > before + 0.5)
    moving.mouse.up()
    until(lambda: console.rests)
    at = console.axis("pan")
    shown = moving.get_by_test_id("measured-pan")
    until(lambda: abs(float(shown.inner_text()) - console.axis("pan")["measured"]) < 0.02)
    assert console.axis("pan")["commanded"] == at["commanded"]


def test_stop_from_a_watcher_ends_what_another_moves(moving, visit, console):
    watcher = visit(PHONE, touch=True)
    watcher.get_by_test_id("stop").tap()
    until(lambda: console.state["stopped"] and console.rests)
    moving.mouse.up()
    expect(moving.get_by_test_id("clear")).to_be_visible()
    moving.get_by_test_id("clear").click()
    until(lambda: not console.state["stopped"])


def test_a_page_that_is_hidden_in_mid_drag_leaves_the_rig_at_rest(moving, console):
    moving.evaluate(
        """Object.defineProperty(document, 'hidden', {get: () => true});
           document.dispatchEvent(new Event('visibilitychange'))"""
    )
    until(lambda: console.rests)
    at = console.axis("pan")["commanded"]
    moving.mouse.move(9, 9)
    moving.wait_for_timeout(200)
    assert console.axis("pan")["commanded"] == at


HAND_OVER = "[...document.querySelectorAll('button')].find((each) => each.innerText === 'Hand over')?.click()"


def test_control_is_handed_over_at_rest_and_the_first_ones_stick_moves_nothing_any_more(moving, visit, console):
    second = visit(PHONE, touch=True, at="?name=bob")
    second.get_by_test_id("take-control").tap()
    # Who asks gets it after 5 s in any case: a busy computer may show the question for less.
    until(lambda: console.state["holder"] == "bob" or moving.evaluate(HAND_OVER))
    expect(second.get_by_test_id("release-control")).to_be_visible()
    expect(moving.get_by_test_id("holder")).to_have_text("bob")
    until(lambda: console.rests)
    moving.mouse.up()
    at = console.axis("pan")["commanded"]
    drag(moving)
    moving.wait_for_timeout(200)
    moving.mouse.up()
    assert console.axis("pan")["commanded"] == at


@pytest.mark.parametrize("how", [signal.SIGSTOP, signal.SIGKILL])
def test_a_gateway_that_stops_or_dies_in_mid_drag_leaves_the_rig_at_rest_and_the_page_comes_back(moving, console, how):
    gateway = console.gateway
    os.kill(gateway, how)
    expect(moving.get_by_text("Connection lost")).to_be_visible(timeout=20_000)
    if how == signal.SIGSTOP:
        os.kill(gateway, signal.SIGCONT)
    expect(moving.get_by_test_id("take-control")).to_be_enabled(timeout=20_000)
    until(lambda: console.rests)
    moving.mouse.move(9, 9)
    at = console.axis("pan")["commanded"]
    moving.wait_for_timeout(300)
    assert console.axis("pan")["commanded"] == at


def test_a_browser_that_hangs_in_mid_drag_leaves_the_rig_at_rest(moving, console):
    moving.evaluate("setTimeout(() => { const end = Date.now() + 2000; while (Date.now() < end); })")
    until(lambda: console.rests)
    moving.mouse.up()
    expect(moving.get_by_test_id("take-control")).to_be_enabled(timeout=20_000)


def test_keys_from_the_hand_are_set_jogged_and_played(visit, console):
    page = visit()
    take_control(page)
    page.get_by_test_id("set-key").click()
    until(lambda: len(console.state["keys"]) == 1)
    page.get_by_role("button", name="Jog by 10 degrees").click()
    page.get_by_role("button", name="Jog pan down").click()
    until(lambda: console.rests and abs(console.axis("pan")["speed"]) == 0)
    page.get_by_test_id("set-key").click()
    until(lambda: len(console.state["keys"]) == 2)
    page.get_by_label("Preroll").fill("0")
    page.get_by_label("Preroll").press("Enter")
    page.get_by_test_id("play").click()
    until(lambda: console.state.get("move"))
    expect(page.get_by_test_id("pause")).to_be_enabled(timeout=20_000)
    page.get_by_test_id("pause").click()
    until(lambda: console.state["move"]["phase"] == "paused")
    expect(page.get_by_test_id("pause")).to_have_accessible_name("Resume")
    page.get_by_role("button", name="End the move").click()
    until(lambda: console.state["move"] is None)


def test_a_focus_mark_is_the_rigs_every_page_has_it_and_so_has_the_file(visit, console):
    page, other = visit(), visit(PHONE, touch=True)
    take_control(page)
    page.get_by_label("Focus, 0 near").fill("0.3")
    until(lambda: abs(console.axis("focus")["commanded"] - 0.3) < 1e-6 and console.rests)
    for each in (page, other):
        expect(each.get_by_test_id("focus-mark-B")).to_contain_text("set")
    page.get_by_test_id("focus-mark-B").click()
    for each in (page, other):
        expect(each.get_by_test_id("focus-mark-B")).to_contain_text("0.300")
    (file,) = (console.folder / "state").rglob("presets-*.yaml")
    until(lambda: "focus_marks: {B: 0.3}" in file.read_text())
    page.get_by_label("Seconds of a focus pull").fill("1.5")
    page.get_by_label("Focus, 0 near").fill("0.6")
    until(lambda: abs(console.axis("focus")["commanded"] - 0.6) < 1e-6 and console.rests)
    page.get_by_test_id("focus-mark-B").click()
    until(lambda: abs(console.axis("focus")["commanded"] - 0.3) < 1e-6 and console.rests)


def test_a_key_that_is_edited_is_planned_and_saved_with_the_comments(visit, console):
    page = visit()
    page.get_by_test_id("tab-move").click()
    key = page.get_by_test_id("key-pan-2")
    key.fill("12.5")
    key.blur()
    page.get_by_test_id("save").click()
    expect(page.get_by_text("mine saved")).to_be_visible()
    saved = (console.folder / "mine.yaml").read_text()
    assert saved == MOVE.replace("pan: 10", "pan: 12.5")


@pytest.fixture(scope="module")
def locked(tmp_path_factory):
    with RealConsole(tmp_path_factory.mktemp("locked"), "--token", "a-long-enough-token") as console:
        yield console


def test_a_wrong_token_opens_nothing_and_the_right_one_the_page(browser, locked):
    page = browser.open(locked.url)
    try:
        page.get_by_test_id("login-token").fill("wrong")
        page.get_by_test_id("login-button").click()
        expect(page.get_by_test_id("login-error")).to_have_text("wrong token")
        page.get_by_test_id("login-token").fill("a-long-enough-token")
        page.get_by_test_id("login-button").click()
        expect(page.get_by_test_id("measured-pan")).to_be_visible()
        take_control(page)
    finally:
        browser.close()


def test_a_page_of_another_origin_gets_no_state_and_gives_no_command(console):
    for path, body in (("api/state", None), ("api/command", b'{"do": "stop"}')):
        request = urllib.request.Request(console.url + path, body, {"Origin": "http://evil.example"})
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(request, timeout=10)
        assert refused.value.code == 403
    assert not console.state["stopped"]


def test_a_message_of_10_mb_ends_the_connection_and_the_page_comes_back(visit, console):
    page = visit()
    expect(page.get_by_test_id("age")).not_to_have_text("--")
    code = page.evaluate(
        """() => new Promise((done) => {
            const socket = new WebSocket(`ws://${location.host}/ws`);
            socket.onclose = (event) => done(event.code);
            socket.onopen = () => socket.send("x".repeat(10_000_000));
        })"""
    )
    assert code in (1006, 1009)
    expect(page.get_by_test_id("take-control")).to_be_enabled()
    assert not console.state["stopped"]
