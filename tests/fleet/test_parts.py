"""The parts of a fleet without a network: messages, clocks, what arrives too fast, the memory, what is missing."""

from __future__ import annotations

import asyncio
import json
import re
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.cli.fleet.play import start_time
from teleop.core.errors import UsageError
from teleop.exchange.zenoh.intake import Intake
from teleop.studio import clocks, memory, wire
from teleop.studio.access import access_control
from teleop.studio.common_start import FleetError, SentMove, play
from teleop.studio.fleet import Fleet
from teleop.studio.link import Link


@settings(max_examples=100, deadline=None)
@given(
    st.binary(max_size=300)
    | st.recursive(st.none() | st.text(), lambda of: st.lists(of)).map(lambda v: json.dumps(v).encode())
)
def test_any_bytes_are_a_map_or_refused(data: bytes):
    with suppress(ValueError):
        assert isinstance(wire.decoded(data), dict)


@pytest.mark.parametrize(
    "data", [b'{"a":' * 50 + b"1" + b"}" * 50, b'{"a":NaN}', b'{"a":1e999}', b"[]", b"x" * 5000, b"[" * 4000]
)
def test_what_is_too_deep_too_large_or_no_number_is_refused(data: bytes):
    with pytest.raises(ValueError):
        wire.decoded(data)


def test_an_offset_is_known_to_half_of_the_round_trip_and_the_best_one_counts():
    here = time.monotonic()
    answer = {"time": here + 100.004, "clock": time.time() + 5, "clock_error": None}
    found = clocks.measured(answer, here, here + 0.008)
    assert (found.loop, found.doubt) == (pytest.approx(100.0), pytest.approx(0.004))
    worse = found._replace(doubt=0.006, at=here + 1)
    assert clocks.better(found, worse) is found
    much_later = worse._replace(at=here + 100)  # by then a drift of 100 ppm has made the old one worse
    assert clocks.better(found, much_later) is much_later
    for bad in ({}, {"time": "x", "clock": 1}):
        with pytest.raises(ValueError):
            clocks.measured(bad, here, here)


@pytest.mark.parametrize("answer", [{"ok": True}, {"time": 10**400, "clock": 1}])
def test_the_clock_of_a_rig_that_tells_no_time_stays_unknown(answer: dict, monkeypatch: pytest.MonkeyPatch):
    fleet = Fleet([], memory=False)
    fleet.heard_alive(Link("tcp/127.0.0.1:1", None, fleet), "cam-a", True)
    monkeypatch.setattr(fleet, "ask", lambda *_: answer)
    assert fleet.measure_clock("cam-a") is None


def test_clocks_that_ntp_keeps_are_equal_to_within_its_errors(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(clocks, "clock_error", lambda: 0.0005)
    here, date = time.monotonic(), time.time()
    answer = {"time": here + 50.02, "clock": date + 0.02, "clock_error": 0.0003}
    found = clocks.measured(answer, here, here + 0.040)  # a slow way tells nothing better
    assert (found.date, found.doubt) == (0.0, pytest.approx(0.0008))
    assert found.loop == pytest.approx(50.0, abs=1e-3)


def test_a_flood_is_dropped_and_counted():
    async def flooded() -> tuple[int, int]:
        taken: list[int] = []
        intake = Intake(asyncio.get_running_loop(), taken.append, most=10, rate=1.0)
        for number in range(1000):
            intake.offer(number)
        await asyncio.sleep(0)
        return len(taken), intake.dropped

    assert asyncio.run(flooded()) == (10, 990)


def test_a_rig_is_remembered_for_a_day(tmp_path: Path):
    file = tmp_path / "fleet" / "rigs.json"
    now = time.time()
    memory.remember(file, {"cam-a": now, "old": now - 90_000})
    assert list(memory.recalled(file)) == ["cam-a"]
    file.write_text("[]")
    assert memory.recalled(file) == {}


@pytest.mark.parametrize(("text", "seconds"), [("now", 0), ("now+5s", 5), ("now+2.5s", 2.5), ("now+1m", 60)])
def test_a_start_is_so_far_from_now(text: str, seconds: float):
    assert start_time(text)() == seconds


@pytest.mark.parametrize("text", ["", "5", "now-1s", "25:00", "tomorrow", "now+5h"])
def test_no_start_is_refused(text: str):
    with pytest.raises(UsageError, match="--at"):
        start_time(text)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("include: [{at: 0, move: ./other.yaml}]\nkeyframes: [{at: 0, pan: 0}]\n", "includes the file ./other.yaml"),
        ("include: [{at: 0, move: /etc/passwd}]\n", "includes the file /etc/passwd"),
        ("source: {file: rows.csv}\n", "its rows are in rows.csv"),
        ("keyframes: [\n", "move.yaml:2:1: not YAML"),
        ("keyframes: !include other.yaml\n", "move.yaml:1:12: keyframes has a tag"),
    ],
)
def test_a_move_that_needs_a_file_that_is_not_sent_is_refused_before_it_is_sent(tmp_path: Path, text: str, why: str):
    file = tmp_path / "move.yaml"
    file.write_text(text)
    with pytest.raises(UsageError, match=re.escape(why)):
        SentMove.read(str(file))
    file.write_text("include: [{at: 0, move: nudge}]\nkeyframes: [{at: 0, pan: 0}]\n")  # shipped: every rig has it
    assert SentMove.read(str(file)).title == "move"


def test_a_rig_that_is_not_there_is_named_and_no_rig_plays():
    with Fleet([], memory=False) as fleet:
        fleet.heard_alive(Link("tcp/127.0.0.1:1", None, fleet), "cam-a", False)
        with pytest.raises(FleetError) as refused:
            play(fleet, dict.fromkeys(["cam-a", "cam-x"], SentMove("m", "")), lambda: 1.0)
    assert refused.value.problems == {"cam-a": "is not there", "cam-x": "there is no rig cam-x; seen: cam-a"}


def test_a_move_that_a_stop_has_paused_is_given_up_for_the_new_one(monkeypatch: pytest.MonkeyPatch):
    fleet = Fleet([], memory=False)
    state = {"move": {"title": "wide", "phase": "paused"}}
    fleet.heard_state(Link("tcp/127.0.0.1:1", None, fleet), "cam-a", state, time.monotonic() + 60)
    asked: list[str] = []

    def ask(_name: str, what: str, message: dict, _timeout: float = 0.0) -> dict:
        asked.append(message.get("do", what))
        return {"ok": True} if message.get("do") else {"error": "enough", "kind": "refused"}

    monkeypatch.setattr(fleet, "ask", ask)
    with pytest.raises(FleetError, match="enough"):
        play(fleet, {"cam-a": SentMove("m", "")}, lambda: 1.0)
    assert [each for each in asked if each != "command/clock"] == ["take_control", "abort", "command/load", "leave"]


def test_a_move_that_plays_goes_on_where_a_new_one_is_refused(monkeypatch: pytest.MonkeyPatch):
    fleet = Fleet([], memory=False)
    for name in ("cam-a", "cam-b"):
        fleet.heard_state(Link("tcp/127.0.0.1:1", None, fleet), name, {}, time.monotonic() + 60)
    asked: list[tuple[str, str]] = []

    def ask(name: str, what: str, message: dict, _timeout: float = 0.0) -> dict:
        asked.append((name, message.get("do", what)))
        return {"error": "plays", "kind": "refused"} if (name, what) == ("cam-b", "command/load") else {"ok": True}

    monkeypatch.setattr(fleet, "ask", ask)
    with pytest.raises(FleetError, match="plays"):
        play(fleet, dict.fromkeys(["cam-a", "cam-b"], SentMove("m", "")), lambda: 1.0)
    assert [name for name, do in asked if do == "abort"] == ["cam-a"]


def test_whoever_is_not_in_the_access_list_can_do_nothing():
    found = access_control({"anna": "operate"})
    assert (found["enabled"], found["default_permission"]) == (True, "deny")
    assert [each["cert_common_names"] for each in found["subjects"]] == [["anna"]]
    assert access_control({})["policies"] == []


def test_without_the_package_the_extra_is_named(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "zenoh", None)
    with pytest.raises(UsageError, match=r"pip install 'rs-teleop\[fleet\]'"):
        Fleet([])
