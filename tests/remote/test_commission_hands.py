"""A commissioning by browsers: who may press, what a key answers, STOP, and what happens when the hand is gone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from commission_bench import CommissionBench
from commission_door import ANNA, BOB, CommissionDoor, commission_door, fuzzed
from commission_variants import Variant
from drone_commission_bench import DroneCommissionBench

from teleop.commission.page import GO, Stage

STEPS = {"ready", "position-pan", "stop", "soft-limits-pan", "profile"}


@pytest.fixture
def door(tmp_path: Path) -> Iterator[CommissionDoor]:
    with commission_door(CommissionBench(tmp_path / "out.yaml")) as door:
        yield door


@pytest.fixture
def moving(door: CommissionDoor) -> CommissionDoor:
    """Pan moves, let go by Anna."""
    door.to_the_first_move()
    assert door.press(GO)["ok"]
    door.run(0.5)
    assert door.gimbal.rates[0] != 0
    return door


def rests(door: CommissionDoor) -> bool:
    before = tuple(door.gimbal.angles)
    door.run(0.3)
    return before == tuple(door.gimbal.angles)


def test_the_same_profile_comes_of_a_browser_as_of_a_terminal(tmp_path: Path) -> None:
    folders = [tmp_path / "terminal", tmp_path / "browser"]
    for folder in folders:
        folder.mkdir()
    variant = Variant((-1, 1, -1), (1, -1, 1))
    by_terminal, by_browser = (variant.bench(folder) for folder in folders)
    for bench in (by_terminal, by_browser):  # all steps are too much for one test: tests/benchmarks has them
        bench.operator.skips = lambda page: page.key not in STEPS
    by_terminal.run()
    with commission_door(by_browser) as door:
        door.operated()
        assert [step["result"] for step in door.page["outline"]].count("now") == 0
        assert door.page["stage"] == "over"
    texts = [(folder / "out.yaml").read_text() for folder in folders]
    assert texts[0] == texts[1]
    text = texts[1]
    assert "commission: signs.pan -1" in text


def test_a_drone_is_commissioned_by_a_browser() -> None:
    bench = DroneCommissionBench()
    with commission_door(bench) as door:
        door.operated()
        assert door.page["stage"] == "over"
    assert bench.runner.findings.value("virtual_rc.on") is True
    assert not bench.motors


def test_nobody_without_control_presses_a_key(door: CommissionDoor) -> None:
    door.until(Stage.PROMPT)
    assert door.press(GO)["error"] == "take control first"
    door.ask("take_control", BOB)
    assert door.press(GO)["kind"] == "busy"
    assert door.page["stage"] == "prompt"


def test_a_key_for_a_page_that_is_over_is_refused(door: CommissionDoor) -> None:
    door.to_the_first_move()
    number = door.page["page"]
    twice = [door.say("commission_key", page=number, key=GO) for _ in range(2)]
    door.turn()
    assert door.answers[twice[0]]["ok"]
    assert door.answers[twice[1]]["kind"] == "stale"
    door.ask("stop")
    door.until(Stage.SHOWN)
    assert door.ask("commission_key", page=number, key="r")["kind"] == "stale"
    assert door.press("x")["error"] == "x: no key of this page"


def test_a_stop_of_somebody_who_watches_stops_what_moves_and_no_key_in_flight_goes_on(moving: CommissionDoor) -> None:
    assert moving.ask("stop", BOB)["ok"]
    assert (moving.state["stopped"], moving.state["stopped_by"]) == (True, "Bob")
    page = moving.until(Stage.SHOWN)
    assert page["trouble"] == "STOPPED by Bob"
    assert rests(moving)
    in_flight = page["page"]
    moving.ask("stop", BOB)
    assert moving.ask("commission_key", page=in_flight, key="r")["kind"] == "stale"
    assert moving.press("r")["ok"]
    assert not moving.state["stopped"]


@pytest.mark.parametrize(
    ("lost", "trouble"),
    [
        (lambda door: door.seen.pop(ANNA), "the page that pressed Enter is gone"),  # and its connection stays
        (lambda door: door.say("closed"), "the page that pressed Enter is gone"),
        (lambda door: setattr(door, "quiet", True), "the page that pressed Enter is gone"),
        (lambda door: door.hands.desk.all_gone(door.now), "the page that pressed Enter is gone"),
        (lambda door: door.say("release_control"), "control was given up"),
    ],
)
def test_a_step_is_stopped_once_the_hand_that_let_it_go_is_gone(moving: CommissionDoor, lost, trouble: str) -> None:
    moving.turn()
    lost(moving)
    begin = moving.now
    page = moving.until(Stage.SHOWN)
    assert trouble in page["trouble"]
    assert moving.now - begin < 1.0 + 0.3 + 1.0  # its silence, the gateway's word, and coming to rest
    assert rests(moving)


def test_a_step_is_stopped_before_control_passes_to_another_one(moving: CommissionDoor) -> None:
    moving.seen[BOB] = 0.0
    moving.ask("take_control", BOB, ask=True)
    end = moving.now + 6
    while moving.state["holder"] == "Anna" and moving.now < end:
        if moving.page["stage"] in ("prompt", "shown"):  # she goes on meanwhile
            moving.press(GO)
        moving.turn()
    assert moving.state["holder"] == "Bob"
    assert rests(moving)


def test_the_terminal_outranks_every_page(door: CommissionDoor) -> None:
    door.to_the_first_move()
    number = door.page["page"]
    said = door.say("commission_key", page=number, key="s")
    door.turn(GO)
    assert door.answers[said]["kind"] == "stale"
    assert door.page["stage"] == "running"
    door.seen.clear()  # the terminal is there: Anna's page is no dead man of its step
    door.run(1.5)
    assert door.runner.stage in (Stage.RUNNING, Stage.ASKING)


def test_more_than_5_deg_per_s_is_agreed_to_and_not_only_entered(door: CommissionDoor) -> None:
    door.to_the_first_move()
    while not door.page["consent"]:
        assert door.press("s")["ok"]
    assert door.press(GO)["error"].startswith("agree to it first: ")
    assert door.page["stage"] == "prompt"
    assert door.press(GO, agrees=True)["ok"]


def test_a_word_is_typed_whole_by_the_one_in_control() -> None:
    with commission_door(DroneCommissionBench()) as door:
        door.ask("take_control")
        door.until(Stage.PROMPT)
        door.press(GO)
        assert "type the word" in door.press(GO)["error"]
        assert door.press("p")["error"] == "type the word that the page asks for"
        door.turn("p", "r")  # on the terminal, and not to the end
        assert door.page["typed"] == "pr"
        assert door.press(GO, text="props-on")["ok"]
        assert door.page["stage"] == "asking"
        door.run(0.1)
        assert door.press(GO, text="Props off")["ok"]
        assert door.until(Stage.SHOWN)["facts"][0]["found"] == "yes"


def test_nothing_else_is_obeyed_while_a_rig_is_commissioned(door: CommissionDoor) -> None:
    door.ask("take_control")
    asked: list[tuple[str, dict[str, Any]]] = [
        ("goto", {"axes": {"pan": 1.0}}),
        ("record", {}),
        ("play", {"move": "x"}),
    ]
    for do, fields in asked:
        assert "while the rig is commissioned" in door.ask(do, ANNA, **fields)["error"]


def test_control_that_was_taken_for_one_key_is_free_once_its_step_rests(door: CommissionDoor) -> None:
    door.until(Stage.PROMPT)
    door.seen["http-1"] = 0.0
    said = door.say("commission_key", "http-1", page=door.page["page"], key=GO, brief=True)
    door.run(0.1)
    assert door.answers[said]["ok"]
    assert door.ends[said]["ok"]
    assert door.state["holder"] is None


def test_whatever_a_stranger_sends_presses_no_key(door: CommissionDoor) -> None:
    door.to_the_first_move()
    assert fuzzed(door, 1000) > 100
    assert rests(door)
