"""A move that is held until a moment is named: it begins there, between two ticks, or not at all."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import pytest
from remote_bench import ANNA, BOB, RemoteBench, remote_bench
from waiting import wait_until

MOVE = "keyframes: [{at: 0, pan: 0}, {at: 2, pan: 20}]\n"


@pytest.fixture
def bench(tmp_path: Path):
    with remote_bench(tmp_path) as made:
        yield made


def held(bench: RemoteBench, text: str = MOVE, **options: Any) -> dict:
    """The answer to a move that was sent as text."""
    folder = bench.hands.door.address.sent(1)
    folder.mkdir(parents=True)
    (folder / "move.yaml").write_text(text)
    bench.ask("take_control")
    number = bench.say("play", move="move", sent=1, held=True, attended=False, **options)

    def answered() -> bool:
        bench.tick()
        return not bench.answers.get(number, {"planning": True}).get("planning")

    wait_until(answered, "the plan")
    return bench.answers[number]


def test_it_begins_at_the_moment_itself_and_not_at_a_tick(bench: RemoteBench):
    answer = held(bench)
    assert (answer["ok"], answer["duration"], answer["ease"]) == (True, 2.0, 0.0)
    bench.run(0.5)
    assert not bench.state["move"]  # nothing begins by itself
    at = round(bench.now, 2) + 1.0037
    assert bench.ask("start", at=at)["ok"]
    bench.run(0.9)
    assert bench.state["move"]["phase"] == "armed"
    assert bench.rests
    while bench.state["move"]["phase"] != "playing":
        bench.tick()
    for _ in range(50):
        bench.tick()
        assert bench.state["time"] - bench.state["move"]["at"] == pytest.approx(at, abs=0.0006)  # `at` has 3 digits
    bench.run(3)
    assert not bench.state["move"]
    assert bench.at() == pytest.approx(20, abs=1e-3)


def test_a_tick_is_at_the_start_so_that_all_rigs_send_their_first_commands_together(bench: RemoteBench):
    held(bench)
    at = round(bench.now, 2) + 1.0037
    assert bench.ask("start", at=at)["ok"]
    times = []
    while not bench.state["move"] or bench.state["move"]["phase"] != "playing":
        bench.tick()
        times.append(bench.state["time"])
    assert times[-1] == pytest.approx(at, abs=1e-6)
    assert {round(later - time, 6) for time, later in itertools.pairwise(times)} == {0.01}


def test_it_goes_to_its_first_key_in_time_or_refuses(bench: RemoteBench):
    answer = held(bench, "keyframes: [{at: 0, pan: 60}, {at: 2, pan: 80}]\n")
    assert answer["ease"] > 1
    refused = bench.ask("start", at=bench.now + answer["ease"])
    assert "to its start" in refused["error"]
    assert bench.rests
    assert bench.ask("start", at=bench.now + answer["ease"] + 0.5)["ok"]
    bench.run(answer["ease"] + 0.3)
    assert (bench.at(), bench.state["move"]["phase"]) == (pytest.approx(60, abs=1e-3), "armed")


def test_a_stop_before_the_start_calls_it_off(bench: RemoteBench):
    held(bench)
    assert bench.ask("start", at=bench.now + 1)["ok"]
    bench.run(0.3)
    bench.ask("stop", BOB)
    bench.run(0.2)
    bench.ask("clear")
    bench.ask("resume")
    bench.run(3)
    assert bench.state["move"]["phase"] == "armed"  # it does not begin late by itself
    assert bench.rests


@pytest.mark.parametrize("lost", ["stop", "release_control", "abort"])
def test_what_is_held_is_dropped_with_control_and_by_a_stop(bench: RemoteBench, lost: str):
    held(bench)
    bench.ask(lost, ANNA)
    bench.run(1.5)
    bench.ask("clear", ANNA)
    bench.ask("take_control", ANNA)
    bench.run(0.1)
    assert "error" in bench.ask("start", ANNA, at=bench.now + 2)


def test_another_ones_held_move_is_not_started(bench: RemoteBench):
    held(bench)
    assert bench.ask("start", BOB, at=bench.now + 2)["kind"] == "busy"
    for at in (-1.0, 1e13, "now", None):
        assert bench.ask("start", at=at)["kind"] == "invalid"
    assert "may be" in bench.ask("start", at=bench.now + 4000)["error"]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("include: [{at: 0, move: ./other.yaml}]\nkeyframes: [{at: 0, pan: 0}]\n", "which is not sent"),
        ("include: [{at: 0, move: /etc/passwd}]\n", "which is not sent"),
        ("source: {file: /etc/passwd}\n", "which is not sent"),
        ("keyframes: !include other.yaml\n", "move.yaml:1:12: keyframes has a tag"),
        ("keyframes: [\n", "move.yaml:"),
        ("keyframes: [{at: 0, pan: 0}, {at: 0.1, pan: 90}]\n", "pan needs"),
    ],
)
def test_a_sent_move_that_cannot_be_planned_is_refused_with_its_place(bench: RemoteBench, text: str, why: str):
    answer = held(bench, text)
    assert why in answer["error"], answer
    assert str(bench.hands.door.address.folder) not in answer["error"]
