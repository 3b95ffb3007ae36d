"""Transport, Shoot and Takes on the page: what each shows of the rig, and what each of their buttons asks for."""

from __future__ import annotations

import math
import re

import pytest
from made_takes import write_take
from page_bench import PATIENCE, take_control, until
from playwright.sync_api import expect

from teleop.core.axes import Axis, State

SHOOT = """\
title: Slow turn
fps: 24
keyframes:
  - {at: 0, pan: 0}
  - {at: 5, pan: 10}
timelapse: {frames: 6, interval: {from: 4s, to: 8s}, mode: shoot-move-shoot, exposure: 0.2s, settle: 0.1s}
"""
SHOWN = {
    "title": "Slow turn", "frames_done": 83, "frames": 240, "eta": 1_790_003_000.0, "missed": 1, "paused": False,
    "phase": "waiting", "why": "", "clip_s": 10.0,
}  # fmt: skip
MOVE = {
    "title": "reveal", "phase": "preroll", "at": -2.4, "duration": 8.0, "speed": 1.0, "max_speed": 1.25,
    "key": None, "keys": 5, "pass": 1, "passes": 2,
}  # fmt: skip


def asked(rig, name, **fields):
    return until(lambda: [each for each in rig.commands if each["do"] == name and fields.items() <= each.items()])


def there_and_back(time):
    """20 degrees and back in 4 s."""
    turn = math.pi * time / 2
    return State(10 * (1 - math.cos(turn)), 5 * math.pi * math.sin(turn), 2.5 * math.pi**2 * math.cos(turn))


@pytest.fixture
def takes(visit, server):
    path = server.takes / "swing.mcap"
    if not path.exists():
        write_take(path, {Axis.PAN: there_and_back}, 4.0, measured={Axis.PAN: lambda t: there_and_back(t)[0] + 0.25})
    page = visit(at="#takes")
    # The worker of the console starts for it, which takes long on a busy computer.
    expect(page.get_by_role("row", name="swing")).to_contain_text("0.25° pan", timeout=4 * PATIENCE)
    return page


def test_a_take_has_its_length_result_and_peak_error_and_its_report_and_file_open(takes):
    row = takes.get_by_role("row", name="swing")
    expect(row).to_contain_text("00:04.00")
    expect(row).to_contain_text("done")
    with takes.expect_popup() as opened:
        row.get_by_role("link", name="Report").click()
    expect(opened.value.locator("body")).to_contain_text("swing")
    with takes.expect_download() as file:
        row.get_by_role("link", name="Download").click()
    assert file.value.suggested_filename == "swing.mcap"


def test_keys_are_made_of_a_take_and_it_is_replayed(takes, rig, server):
    row = takes.get_by_role("row", name="swing")
    expect(row.get_by_role("button", name="Replay")).to_be_disabled()  # who has no control replays nothing
    row.get_by_role("button", name="Make keys").click()
    expect(takes.get_by_label("Name of the new move")).to_have_value("swing-keys")
    expect(takes.get_by_test_id("key-pan-1")).to_have_count(1)
    take_control(takes)
    takes.get_by_test_id("tab-takes").click()
    row.get_by_role("button", name="Replay").click()
    assert asked(rig, "play", move="swing-replay")
    assert "keyframes" in (server.moves / "swing-replay.yaml").read_text()


def test_a_shoot_is_started_gone_on_with_paused_between_frames_and_ended(visit, rig, server):
    (server.moves / "turn.yaml").write_text(SHOOT)
    left = {"error": 'turn: 2 of 6 frames are shot: continue with {"resume": true}', "kind": "refused"}
    rig._shoot = lambda command, *_: None if command.get("resume") else left
    page = visit(at="#shoot")
    take_control(page)
    page.get_by_label("Timelapse").select_option("turn")
    page.get_by_test_id("shoot-start").click()
    expect(page.get_by_text("2 of 6 frames are shot")).to_be_visible()
    page.get_by_test_id("shoot-resume").click()
    assert asked(rig, "shoot", move="turn", resume=True)
    rig.more.update(shoot=dict(SHOWN), battery=78)
    main = page.get_by_role("main")
    for text in ("83 of 240", "00:10", "78 %"):
        expect(main).to_contain_text(text)
    expect(main).to_contain_text(re.compile(r"Ends at\s*\d\d:\d\d:\d\d"))
    expect(main).to_contain_text("Missed slots1")
    expect(page.locator(".intervals .curve")).to_be_visible()
    page.get_by_test_id("shoot-pause").click()
    assert asked(rig, "pause")
    rig.more["shoot"]["paused"] = True
    expect(page.get_by_text("paused: no frame is shot")).to_be_visible()
    page.get_by_test_id("shoot-pause").click()
    assert asked(rig, "resume")
    page.get_by_role("button", name="End the shoot").click()
    assert asked(rig, "abort")


def test_the_transport_counts_down_and_has_each_button_within_what_the_plan_allows(visit, rig):
    page = visit(at="#move")
    take_control(page)
    rig.more["move"] = dict(MOVE)
    transport = page.locator(".transport")
    expect(transport).to_contain_text("starts in 3 s")
    rig.more["move"].update(phase="playing", at=1.5, key=2)
    expect(transport).to_contain_text("playing, key 2 of 5, pass 1 of 2")
    assert page.get_by_label("Speed").locator("option").all_inner_texts() == ["25 %", "50 %", "75 %", "100 %"]
    page.get_by_label("Speed").select_option("0.5")
    assert asked(rig, "speed", share=0.5)
    expect(page.get_by_role("button", name="Next key")).to_be_disabled()
    page.get_by_test_id("pause").click()
    assert asked(rig, "pause")
    rig.more["move"]["phase"] = "paused"
    for name, command in (("Next key", "next_key"), ("Previous key", "previous_key"), ("To the start", "to_start")):
        page.get_by_role("button", name=name).click()
        assert asked(rig, command)
    page.get_by_test_id("pause").click()
    assert asked(rig, "resume")
    rig.more["errors"] = {"title": "reveal", "passes": [{"pass": 1, "axes": {"pan": {"rms": 0.012, "peak": 0.034}}}]}
    expect(page.get_by_test_id("pass-errors")).to_contain_text("0.012, 0.034")
    page.get_by_role("button", name="End the move").click()
    assert asked(rig, "abort")


def test_what_is_chosen_beside_play_goes_with_it(visit, rig):
    page = visit(at="#live")
    take_control(page)
    page.get_by_label("Plays").select_option("reveal")
    page.get_by_label("Preroll").fill("5")
    page.get_by_label("Preroll").press("Enter")
    page.get_by_label("Passes").fill("3")
    page.get_by_label("Passes").press("Enter")
    page.get_by_role("button", name="Loop").click()
    page.get_by_test_id("play").click()
    assert asked(rig, "play", move="reveal", preroll=5, passes=3, loop=True)
