"""The Live page: STOP, control and its handover, what is shown, presets, keys from the hand, the keyboard."""

from __future__ import annotations

import re

from page_bench import PHONE, take_control, until
from playwright.sync_api import expect

from teleop.inputs.keymaps import HELP, INVITE
from teleop.inputs.playback_keymap import KEYS, LEFT, RIGHT


def commands(rig, name):
    return [each for each in rig.commands if each["do"] == name]


def was_asked(rig, name, fields):
    found = commands(rig, name)
    return found and fields.items() <= found[-1].items()


def test_stop_from_a_watcher_is_obeyed_and_says_who_and_when(visit, rig):
    operator, watcher = visit(at="?name=laptop"), visit(PHONE, touch=True, at="?name=phone")
    take_control(operator)
    expect(watcher.get_by_test_id("holder")).not_to_have_text("free")
    watcher.get_by_test_id("stop").tap()
    for page in (operator, watcher):
        expect(page.get_by_text("STOPPED")).to_be_visible()
        expect(page.locator(".banners")).to_contain_text(re.compile(r"by phone at \d\d:\d\d:\d\d"))
    count = len(commands(rig, "stop"))
    watcher.wait_for_timeout(400)
    assert len(commands(rig, "stop")) == count  # repeated until the state shows it, and no longer
    expect(operator.get_by_test_id("preset-1")).to_be_visible()
    operator.get_by_test_id("clear").click()
    expect(operator.get_by_text("STOPPED")).to_be_hidden()


def test_stop_is_sent_again_until_the_state_shows_it(visit, rig):
    page = visit()
    expect(page.get_by_test_id("age")).not_to_have_text("--")
    rig._stop = lambda *_: None  # it is answered, and nothing stops
    page.get_by_test_id("stop").click()
    until(lambda: len(commands(rig, "stop")) > 5)
    expect(page.get_by_test_id("stop")).to_contain_text("sending")
    rig.more["stopped"] = True
    expect(page.get_by_text("STOPPED")).to_be_visible()


def test_stop_is_large_on_every_screen_and_in_reach_of_the_keyboard(visit, rig):
    page = visit(PHONE, touch=True)
    box = page.get_by_test_id("stop").bounding_box()
    assert min(box["width"], box["height"]) >= 72
    assert box["x"] + box["width"] > PHONE[0] - 12
    assert box["y"] < 12
    expect(page.get_by_test_id("age")).not_to_have_text("--")
    page.get_by_test_id("tab-takes").click()
    page.keyboard.press(" ")
    until(lambda: rig.more["stopped"])


def test_what_is_shown_is_what_the_rig_reported(visit, rig):
    page = visit()
    take_control(page)
    rig._jog = lambda *_: None  # accepted, and nothing moves
    page.get_by_role("button", name="Jog pan up").click()
    until(lambda: commands(rig, "jog"))
    page.wait_for_timeout(200)
    expect(page.get_by_test_id("commanded-pan")).to_have_text("+0.00")
    rig.at.update(pan=-12.345, focus=0.5)
    expect(page.get_by_test_id("measured-pan")).to_have_text(re.compile(r"-12\.3[45]"))
    expect(page.get_by_test_id("measured-focus")).to_have_text("+0.500")


def test_jogs_are_bounded_by_themselves(visit, rig):
    page = visit()
    take_control(page)
    for size, by in (("0.1", 0.1), ("1", 1), ("10", 10)):
        page.get_by_role("button", name=f"Jog by {size} degrees").click()
        page.get_by_role("button", name="Jog tilt down").click()
        until(lambda by=by: commands(rig, "jog") and commands(rig, "jog")[-1]["by"] == -by)
    assert all(0 < each["within"] <= 5 for each in commands(rig, "jog"))
    page.get_by_role("button", name="Jog focus up").click()
    until(lambda: commands(rig, "jog")[-1]["axis"] == "focus")
    assert commands(rig, "jog")[-1]["by"] == 0.1


def test_control_passes_when_the_holder_hands_it_over(visit, rig):
    first, second = visit(at="?name=one"), visit(at="?name=two")
    take_control(first)
    second.get_by_test_id("take-control").filter(has_text="Ask for control").click()
    expect(first.get_by_text("asks for control")).to_be_visible()
    first.get_by_role("button", name="Keep control").click()
    expect(first.get_by_text("asks for control")).to_be_hidden()
    assert commands(rig, "deny_control")
    first.get_by_role("button", name="Release").click()
    second.get_by_test_id("take-control").filter(has_text="Take control").click()
    expect(second.get_by_test_id("release-control")).to_be_visible()
    expect(first.get_by_test_id("holder")).not_to_contain_text("you")


def test_a_preset_is_stored_by_holding_and_recalled_by_a_tap_in_the_set_time(visit, rig):
    page = visit()
    take_control(page)
    rig.at["pan"] = 25.0
    tile = page.get_by_test_id("preset-4")
    expect(page.get_by_test_id("measured-pan")).to_have_text("+25.00")
    tile.click(delay=900)
    until(lambda: rig.more["presets"])
    expect(tile).to_contain_text("25")
    assert not commands(rig, "preset_recall")  # the press that stores recalls nothing
    rig.at["pan"] = 0.0
    page.get_by_label("Seconds of a recall").fill("1.5")
    page.get_by_label("Seconds of a recall").press("Enter")
    tile.click()
    until(lambda: commands(rig, "preset_recall"))
    assert commands(rig, "preset_recall")[0]["seconds"] == 1.5
    until(lambda: abs(rig.at["pan"] - 25) < 0.01)


def test_there_is_always_an_empty_preset_and_a_long_list_scrolls(visit, rig):
    page = visit()
    take_control(page)
    rig.more["presets"] = {str(number): {"pan": float(number)} for number in range(12)}
    last = page.get_by_test_id("preset-12")
    last.click(delay=900)
    until(lambda: "12" in rig.more["presets"])
    expect(page.get_by_test_id("preset-13")).to_be_attached()
    assert page.locator(".tiles").evaluate("(each) => each.scrollHeight > each.clientHeight")


def test_keys_from_the_hand_play_and_become_a_move_with_even_times(visit, rig):
    page = visit()
    take_control(page)
    for pan in (0.0, 20.0, 5.0):
        rig.at["pan"] = pan
        page.get_by_test_id("set-key").click()
        until(lambda pan=pan: rig.more["keys"] and rig.more["keys"][-1]["pan"] == pan)
    expect(page.get_by_text("3 keys")).to_be_visible()
    page.get_by_test_id("play").click()
    until(lambda: commands(rig, "play"))
    assert commands(rig, "play")[0]["move"] == "keys"
    page.get_by_role("button", name="Edit as a move").click()
    expect(page.get_by_label("Time of key 3")).to_have_value("8")
    expect(page.get_by_test_id("key-pan-2")).to_have_value("20")
    page.get_by_label("Name of the new move").fill("by-hand")
    page.get_by_test_id("save").click()
    expect(page.get_by_text("by-hand saved")).to_be_visible()


def test_the_keys_of_the_terminal_work(visit, rig):
    page = visit()
    take_control(page)
    for key, name, fields in (
        ("ArrowRight", "jog", {"axis": "pan", "by": 1}),
        ("Shift+ArrowUp", "jog", {"axis": "tilt", "by": 10}),
        ("Control+ArrowLeft", "jog", {"axis": "pan", "by": -0.1}),
        ("k", "jog", {"axis": "tilt", "by": 0.1}),
        ("Shift+H", "jog", {"axis": "pan", "by": -10}),
        ("]", "jog", {"axis": "focus", "by": 0.01}),
        (">", "jog", {"axis": "roll", "by": 1}),
        ("v", "range", {"number": 3}),
        ("z", "recenter", {}),
        ("r", "record", {}),
        (".", "shutter", {}),
        ("e", "manual", {"on": False}),
        ("b", "drone", {"command": "disengage"}),
        ("g", "play", {}),
    ):
        page.keyboard.press(key)
        until(lambda name=name, fields=fields: was_asked(rig, name, fields))
    for first, second, name, fields in (
        ("s", "3", "preset_store", {"number": 3}),
        ("f", "y", "follow", {"mode": "yaw"}),
        ("x", "3", "preset_delete", {"number": 3}),
    ):
        page.keyboard.press(first)
        page.keyboard.press(second)
        until(lambda name=name, fields=fields: was_asked(rig, name, fields))
    page.get_by_role("button", name="Recenter").focus()
    count = len(commands(rig, "recenter"))
    page.keyboard.press(" ")  # STOP, also where a button has the focus
    until(lambda: rig.more["stopped"])
    assert len(commands(rig, "recenter")) == count
    page.keyboard.press("c")
    until(lambda: not rig.more["stopped"])
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_be_visible()


def test_words_are_typed_as_in_the_terminal_and_space_is_stop_in_them_too(visit, rig):
    page = visit()
    take_control(page)
    for key, word, name, fields in (
        ("d", "Home-off", "drone", {"command": "home-off"}),
        ("t", "door,4.2", "mark_target", {"text": "door,4.2"}),
    ):
        page.keyboard.type(key + word)  # at once: no key of the word is one of the console's
        page.keyboard.press("Enter")
        until(lambda name=name, fields=fields: was_asked(rig, name, fields))
        expect(page.locator(".word")).to_have_count(0)
    page.keyboard.press("d")
    page.keyboard.press("Escape")
    expect(page.locator(".word")).to_have_count(0)
    page.keyboard.type("dar m")
    until(lambda: rig.more["stopped"])
    assert len(commands(rig, "drone")) == 1


MOVE = {
    "title": "reveal",
    "phase": "playing",
    "at": 1.0,
    "duration": 8.0,
    "speed": 1.0,
    "max_speed": 1.25,
    "key": 1,
    "keys": 5,
    "pass": 1,
    "passes": 1,
}
SHOOT = {
    "title": "dusk",
    "frames_done": 3,
    "frames": 240,
    "eta": None,
    "missed": 0,
    "paused": True,
    "phase": "paused",
    "why": "",
}


def test_the_keys_of_teleop_play_work_while_a_move_plays_and_those_of_a_shoot_in_one(visit, rig):
    page = visit()
    take_control(page)
    rig.more["move"] = MOVE
    expect(page.get_by_test_id("pause")).to_be_enabled()
    for key, name, fields in (
        ("-", "speed", {"share": 0.9}),
        ("+", "speed", {"share": 1.1}),
        (">", "next_key", {}),
        ("ArrowLeft", "previous_key", {}),
        ("p", "pause", {}),
        ("g", "resume", {}),
        ("q", "abort", {}),
    ):
        page.keyboard.press(key)
        until(lambda name=name, fields=fields: was_asked(rig, name, fields))
    assert not commands(rig, "jog")
    assert not commands(rig, "range")
    rig.commands.clear()
    rig.more.update(move=None, shoot=SHOOT)
    expect(page.get_by_test_id("pause")).to_be_disabled()
    for key, name in ((".", "next_key"), (",", "previous_key"), ("p", "resume"), ("q", "abort")):
        page.keyboard.press(key)
        until(lambda name=name: commands(rig, name))
    assert not commands(rig, "shutter")


def test_the_list_of_keys_has_every_key_of_the_terminal(visit):
    page = visit()
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_be_visible()
    shown = {"".join(each.split()) for each in page.locator("dialog dt").all_inner_texts()}
    own = {"q", INVITE}  # of the terminal alone: its run, and the way to this page
    assert {"".join(key.split()) for key, _ in HELP} - own <= shown
    of_moves = "".join(page.locator("dialog dl").nth(1).locator("dt").all_inner_texts())
    arrows = (*RIGHT, *LEFT)
    missing = set(KEYS) - {" ", "c", "\n", "\r", "=", *arrows} - set(of_moves)
    assert missing == set()
    assert "arrows" in of_moves


def test_a_focus_mark_is_set_by_holding_and_reached_by_a_tap(visit, rig):
    page = visit()
    take_control(page)
    rig.at["focus"] = 0.25
    expect(page.get_by_test_id("measured-focus")).to_have_text("+0.250")
    mark = page.get_by_test_id("focus-mark-B")
    mark.click(delay=900)
    expect(mark).to_contain_text("0.250")
    rig.at["focus"] = 0.9
    mark.click()
    until(lambda: was_asked(rig, "focus_mark_recall", {"name": "B", "seconds": 1}))
    page.get_by_label("Focus, 0 near").fill("0.254")  # a value that is typed is no drag near the mark
    until(lambda: was_asked(rig, "focus", {"to": 0.254}))


def test_a_tracker_is_followed_by_a_button_and_by_a_key_and_the_page_says_how_that_goes(visit, rig):
    page = visit()
    take_control(page)
    expect(page.get_by_test_id("track-1")).to_have_count(0)  # no tracker sends to this rig
    source = {"name": "freed at 127.0.0.1:40001", "age_ms": None}
    rig.more["tracking"] = {"sources": {"1": source, "2": {**source, "age_ms": 9.0}}, "follows": None, "why": ""}
    button, word = page.get_by_test_id("track-2"), page.get_by_test_id("tracking-2")
    expect(page.get_by_test_id("tracking-1")).to_have_text("no messages")
    expect(page.get_by_test_id("track-1")).to_be_disabled()
    expect(word).to_have_text("ready")
    button.click()
    until(lambda: was_asked(rig, "track", {"source": 2}))
    expect(word).to_have_text("followed")
    expect(button).to_have_attribute("aria-pressed", "true")
    rig.more["tracking"]["why"] = "pan waits at its soft limit"
    expect(word).to_have_text("pan waits at its soft limit")
    button.click()
    until(lambda: commands(rig, "abort"))
    expect(word).to_have_text("ready")
    page.keyboard.press("a")
    page.keyboard.press("2")
    expect(word).to_have_text("pan waits at its soft limit")
    page.keyboard.press("a")
    page.keyboard.press("0")
    expect(word).to_have_text("ready")
    page.keyboard.press("a")  # when none is followed, 0 begins nothing
    page.keyboard.press("0")
    expect(page.get_by_text("track: no source is followed").first).to_be_visible()
    assert len(commands(rig, "track")) == len(commands(rig, "abort")) == 2


def test_the_screen_stays_on_where_the_page_is_secure_and_elsewhere_it_says_so(browser, server, rig):
    try:
        page = browser.open("about:blank")
        page.add_init_script("navigator.wakeLock.request = async (what) => ((window.kept = what), {released: false})")
        page.goto(server.url)
        expect(page.get_by_test_id("age")).not_to_have_text("--")
        assert page.evaluate("window.kept") == "screen"
        other = browser.open("about:blank")
        other.add_init_script(
            """delete Navigator.prototype.wakeLock;
               Object.defineProperty(window, 'isSecureContext', {get: () => false})"""
        )
        other.goto(server.url)
        expect(other.get_by_text("without TLS the screen may go to sleep")).to_be_visible()
    finally:
        browser.close()


def test_no_state_for_a_second_is_gray_and_says_so_and_the_page_comes_back_as_a_watcher(visit, rig):
    page = visit()
    take_control(page)
    hold, rig.quiet = rig.quiet, True
    try:
        expect(page.get_by_text("Connection lost")).to_be_visible()
        expect(page.locator(".readouts")).to_have_css("filter", re.compile("grayscale"))
        expect(page.get_by_role("button", name="Jog pan up")).to_be_disabled()
    finally:
        rig.quiet = hold
    expect(page.get_by_test_id("take-control")).to_be_enabled()
    expect(page.get_by_text("Connection lost")).to_be_hidden()


def test_a_rig_that_is_silent_behind_a_living_server_is_gray_too(visit, rig):
    page = visit()
    expect(page.get_by_test_id("age")).not_to_have_text("--")
    rig.age_ms = 2300.0
    expect(page.get_by_text("The rig does not answer")).to_be_visible()
    rig.age_ms = 4.0
    expect(page.get_by_text("The rig does not answer")).to_be_hidden()
