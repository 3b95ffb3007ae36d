"""HTTP for buttons and scripts: the state, commands, STOP, and what is refused."""

from __future__ import annotations

import asyncio
import json

import pytest
from console_bench import LOCKED, OPERATE, WATCHING, ConsoleBench
from console_fuzz import FuzzedConsole, FuzzRequest

from teleop.console import sessions


@pytest.fixture
def bench():
    with ConsoleBench() as bench:
        yield bench


@pytest.fixture
def locked():
    with ConsoleBench(LOCKED) as bench:
        yield bench


def test_the_state_has_what_the_issue_names(bench):
    state = bench.get("/api/state").json()
    assert state["axes"]["pan"]["measured"] == state["axes"]["pan"]["commanded"] == 0
    assert {"holder", "stopped", "recording", "move", "age_ms"} <= set(state)


def test_a_state_that_is_not_there_yet_is_an_answer(bench, monkeypatch):
    monkeypatch.setattr(bench.door, "state", dict)
    assert bench.get("/api/state").status_code == 503


def test_a_command_is_answered_once_it_is_accepted_and_takes_control_for_itself(bench):
    answer = bench.command("goto", axes={"pan": 10}, seconds=2)
    assert (answer.status_code, answer.json()) == (200, {"ok": True})
    ((command, _, name),) = bench.door.commands
    assert command == {"do": "goto", "axes": {"pan": 10}, "seconds": 2}
    assert name == "HTTP 127.0.0.1"


def test_with_wait_it_is_answered_once_it_is_done(bench):
    bench.door.action_seconds = 0.2
    assert bench.command("goto", axes={"pan": 10}, wait=True).json() == {"ok": True}
    assert all(task.done() for task in bench.door._ends.values())


def test_a_client_that_hangs_up_while_it_waits_is_not_seen_any_more(tmp_path, monkeypatch):
    monkeypatch.setattr(sessions, "SEEN", 0.01)
    body = json.dumps({"do": "goto", "axes": {"pan": 10}, "wait": True}).encode()
    headers = [(b"host", b"127.0.0.1:8470"), (b"authorization", OPERATE["authorization"].encode())]

    async def scenario():
        console = FuzzedConsole(tmp_path)
        console.door.action_seconds = 60
        status = await asyncio.wait_for(console.ask(FuzzRequest("POST", "/api/command", headers, [body], "")), 10)
        return status, len(console.door.seen_sessions)

    assert asyncio.run(scenario()) == (408, 1)


def test_without_wait_it_is_not_waited_for(bench):
    bench.door.action_seconds = 60
    assert bench.command("goto", axes={"pan": 10}).json() == {"ok": True}


def test_another_holder_is_409_with_the_name(bench):
    bench.door.holder, bench.door.holder_session = "phone", "other"
    answer = bench.command("goto", axes={"pan": 10})
    assert answer.status_code == 409
    assert answer.json()["holder"] == "phone"
    assert bench.door.positions["pan"] == 0


@pytest.mark.parametrize(
    ("fields", "status"),
    [
        ({"do": "goto", "axes": {"pan": 999}}, 422),
        ({"do": "goto", "axes": {"nose": 1}}, 400),
        ({"do": "dance"}, 400),
        ({"do": 3}, 400),
        ({"do": ["alive"]}, 400),
        ({"do": "alive", "seen": {"other": 0}}, 400),
        ({"do": "closed"}, 400),
        ({}, 400),
        ({"do": "goto", "axes": {"pan": 1}, "wait": "yes"}, 400),
        ({"do": "stick", "seq": 1}, 400),
    ],
)
def test_what_cannot_be_done_is_4xx_with_the_reason(bench, fields, status):
    answer = bench.post("/api/command", json=fields)
    assert answer.status_code == status
    assert answer.json()["error"]


def test_a_rig_that_does_not_answer_is_503(bench):
    bench.door.answers["goto"] = {"error": "the rig does not answer", "kind": "lost"}
    assert bench.command("goto", axes={"pan": 1}).status_code == 503


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"[]",
        b"{",
        b'"goto"',
        b"\xff\xfe",
        b'{"do": NaN}',
        b'{"do": 1e999}',
        b'{"do": "\\ud800"}',
        b"[" * 50_000,
        b'{"a":' * 100 + b"1" + b"}" * 100,
    ],
)
def test_a_body_that_is_no_sound_json_is_400(bench, body):
    answer = bench.post("/api/command", content=body)
    assert answer.status_code == 400
    assert answer.json()["error"]
    assert bench.door.commands == []


def test_a_body_of_10_mb_is_413_with_and_without_its_length(bench):
    def parts():
        for _ in range(160):
            yield b"x" * 65_536

    for content in (b"x" * 10_000_000, parts()):
        assert bench.post("/api/command", content=content).status_code == 413


def test_a_stick_goes_to_the_door(bench):
    assert bench.command("stick", seq=1, time=0.0, axes={"pan": 0.5}).status_code == 200
    ((message, _),) = bench.door.sticks
    assert message["axes"] == {"pan": 0.5}


@pytest.mark.parametrize("headers", [OPERATE, WATCHING])
def test_every_role_can_stop(locked, headers):
    answer = locked.post("/api/stop", headers=headers)
    assert (answer.status_code, answer.json()) == (200, {"ok": True, "stopped": True})


def test_a_stop_is_repeated_until_the_rig_confirms_it(bench):
    bench.door.deaf_to_stop = 3
    assert bench.post("/api/stop").json() == {"ok": True, "stopped": True}
    assert [command["do"] for command, _, _ in bench.door.commands] == ["stop"] * 4


def test_a_stop_needs_no_sound_body(bench):
    assert bench.post("/api/stop", content=b"{" * 1000).status_code == 200


def test_a_flood_of_requests_is_refused_and_a_stop_is_not(bench):
    statuses = [bench.get("/api/state").status_code for _ in range(500)]
    assert statuses.count(429) > 50
    assert bench.post("/api/stop").status_code == 200


@pytest.mark.parametrize(
    "command",
    [
        {"do": "goto", "axes": {"pan": 1}},
        {"do": "commission", "device": "gimbal"},
        {"do": "commission_key", "page": 1, "key": "enter"},
    ],
)
def test_a_watcher_gives_no_command(locked, command):
    answer = locked.post("/api/command", json=command, headers=WATCHING)
    assert answer.status_code == 403
    assert locked.door.commands == []


@pytest.mark.parametrize("path", ["/nope", "/api/nope", "/api/", "/..%2f..%2fetc/passwd", "/static/app.js"])
def test_unknown_paths_are_404_in_json(bench, path):
    answer = bench.get(path)
    assert answer.status_code == 404
    assert answer.json() == {"error": "no such path"}


def test_another_method_is_405_in_json(bench):
    answer = bench.delete("/api/state")
    assert answer.status_code == 405
    assert answer.json()["error"]
    assert "GET" in answer.headers["allow"]


def test_a_fault_of_the_program_is_an_answer_without_its_details(bench, monkeypatch):
    def broken():
        raise RuntimeError("secret")

    bench._transport.raise_server_exceptions = False
    monkeypatch.setattr(bench.door, "state", broken)
    answer = bench.get("/api/state")
    assert answer.status_code == 500
    assert answer.json() == {"error": "the console failed: RuntimeError"}


def test_a_client_that_asks_is_seen_by_the_door(bench):
    bench.command("goto", axes={"pan": 1})
    bench.get("/api/state")
    assert len(set(bench.door.seen_sessions)) == 1
    assert len(bench.door.seen_sessions) == 2
