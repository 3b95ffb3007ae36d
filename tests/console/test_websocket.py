"""The page's WebSocket: hello, states and changes, commands, sticks, and what is too much."""

from __future__ import annotations

import json
import time

import pytest
from console_bench import LOCKED, WATCHING, ConsoleBench
from starlette.websockets import WebSocketDisconnect

from teleop.console.merge_patch import changes
from teleop.console.websocket import MOST_COMMANDS, MOST_IGNORED


@pytest.fixture
def bench():
    with ConsoleBench() as bench:
        yield bench


def applied(old, patch):
    """`old` with a patch: what a client does."""
    result = dict(old)
    for key, value in patch.items():
        if value is None:
            result.pop(key, None)
        elif isinstance(value, dict):
            before = result.get(key)
            result[key] = applied(before if isinstance(before, dict) else {}, value)
        else:
            result[key] = value
    return result


def until(socket, *kinds):
    """The next message of one of these kinds."""
    while True:
        message = socket.receive_json()
        if message["type"] in kinds:
            return message


def end(socket):
    """The code with which the connection ends."""
    try:
        while True:
            socket.receive_json()
    except WebSocketDisconnect as gone:
        return gone.code


def test_it_begins_with_hello_and_the_whole_state(bench):
    with bench.page(query="?name=phone%0a") as socket:
        hello, state = socket.receive_json(), socket.receive_json()
    assert (hello["type"], hello["role"], hello["name"], hello["rig"]) == ("hello", "operate", "phone", "fake")
    assert state["type"] == "state"
    assert state["state"]["axes"]["pan"]["measured"] == 0


def test_what_changes_comes_as_a_merge_patch(bench):
    with bench.page() as socket:
        state = until(socket, "state")["state"]
        socket.send_json({"id": 1, "do": "take_control"})
        while state.get("holder") is None:
            message = until(socket, "delta")
            assert set(message["changes"]) < set(state)
            state = applied(state, message["changes"])
    assert state["holder"] == bench.door.commands[0][2]


def test_a_command_is_answered_and_then_done(bench):
    with bench.page() as socket:
        socket.send_json({"id": 1, "do": "take_control"})
        assert until(socket, "answer")["ok"] is True
        until(socket, "done")
        socket.send_json({"id": "go", "do": "goto", "axes": {"pan": 10}})
        assert until(socket, "answer") == {"type": "answer", "id": "go", "ok": True}
        assert until(socket, "done") == {"type": "done", "id": "go", "ok": True}
    assert bench.door.positions["pan"] == 10


def test_a_fault_of_the_program_is_an_answer_and_the_page_goes_on(bench, monkeypatch):
    async def broken(*_: object) -> None:
        raise RuntimeError("secret")

    monkeypatch.setattr(bench.door, "command", broken)
    with bench.page() as socket:
        socket.send_json({"id": 5, "do": "goto", "axes": {"pan": 10}})
        failed = {"type": "answer", "id": 5, "error": "the console failed: RuntimeError", "kind": "lost"}
        assert until(socket, "answer") == failed
        socket.send_json({"do": "ping", "id": 6})
        assert until(socket, "pong")["id"] == 6


def test_control_is_not_taken_by_a_command_of_a_page(bench):
    with bench.page() as socket:
        socket.send_json({"id": 1, "do": "goto", "axes": {"pan": 10}})
        assert until(socket, "answer")["kind"] == "busy"


def test_a_stick_goes_to_the_door_without_an_answer(bench):
    with bench.page() as socket:
        for seq in range(3):
            socket.send_json({"do": "stick", "seq": seq, "time": 1.0, "axes": {"pan": 0.5}})
        socket.send_json({"do": "ping", "id": 8})
        assert until(socket, "pong", "answer") == {"type": "pong", "id": 8}
    assert [message["seq"] for message, _ in bench.door.sticks] == [0, 1, 2]
    assert len(bench.door.seen_sessions) >= 4


def test_the_door_hears_when_a_page_is_gone(bench):
    with bench.page() as socket:
        session = socket.receive_json()["session"]
    assert bench.door.closed_sessions == [session]


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("{", "invalid"),
        ("[]", "invalid"),
        ("3", "invalid"),
        ('{"id": 1}', "invalid"),
        ('{"id": [1], "do": "goto"}', "invalid"),
        ('{"id": 1, "do": "dance"}', "invalid"),
        ('{"do": "stick"}', "invalid"),
        ("[" * 60_000, "invalid"),
    ],
)
def test_what_is_malformed_is_answered_with_the_reason(bench, text, kind):
    with bench.page() as socket:
        socket.send_text(text)
        answer = until(socket, "answer")
        assert answer["kind"] == kind
        assert answer["error"]
        socket.send_json({"do": "ping", "id": 1})
        assert until(socket, "pong")["id"] == 1
    assert bench.door.positions == dict.fromkeys(bench.door.positions, 0.0)


@pytest.mark.parametrize(("message", "code"), [("x" * 10_000_000, 1009), (b"{}", 1003)])
def test_what_is_too_large_or_no_text_ends_the_connection(bench, message, code):
    with bench.page() as socket:
        (socket.send_text if isinstance(message, str) else socket.send_bytes)(message)
        assert end(socket) == code


def test_a_watcher_only_stops(bench):
    with ConsoleBench(LOCKED) as locked, locked.page(WATCHING) as socket:
        assert socket.receive_json()["role"] == "watch"
        key = {"do": "commission_key", "page": 1, "key": "enter"}
        for command in ({"do": "take_control"}, {"do": "goto", "axes": {"pan": 1}}, key):
            socket.send_json({"id": 1, **command})
            assert until(socket, "answer")["kind"] == "forbidden"
        socket.send_json({"do": "stick", "seq": 1, "axes": {"pan": 1.0}})
        assert until(socket, "answer")["kind"] == "forbidden"
        assert locked.door.commands == locked.door.sticks == []
        socket.send_json({"id": 2, "do": "stop"})
        assert until(socket, "answer") == {"type": "answer", "id": 2, "ok": True, "stopped": True}
    assert locked.door.stopped


def test_above_the_rate_only_stop_is_obeyed_and_then_the_connection_ends(bench):
    with bench.page() as socket:
        for seq in range(1000):
            socket.send_json({"do": "stick", "seq": seq, "axes": {"pan": 0.0}})
        socket.send_json({"id": 1, "do": "stop"})
        assert until(socket, "answer")["stopped"] is True
        assert len(bench.door.sticks) < 900
        for _ in range(MOST_IGNORED + 500):
            socket.send_text('{"do": "ping"}')
        assert end(socket) == 1008


def test_commands_and_plans_under_way_are_bounded_and_a_stop_is_not(bench):
    bench.door.action_seconds = 60
    with bench.page() as socket:
        for number in range(MOST_COMMANDS + 5):
            socket.send_json({"id": number, "do": "take_control"})
        socket.send_json({"id": "plan", "do": "plan", "move": "nudge"})
        socket.send_json({"id": "stop", "do": "stop"})
        answers = {}
        while "stop" not in answers:
            message = until(socket, "answer")
            answers[message["id"]] = message
    refused = [number for number, answer in answers.items() if answer.get("error") == "too many commands at once"]
    assert refused == [*range(MOST_COMMANDS, MOST_COMMANDS + 5), "plan"]
    assert answers["stop"]["stopped"] is True


def test_states_come_at_most_30_times_a_second(bench):
    with bench.page() as socket:
        until(socket, "state")
        began, count = time.monotonic(), 0
        while count < 15:
            bench.door.tick += 1
            until(socket, "delta")
            count += 1
        assert time.monotonic() - began > 14 / 30 * 0.9


def test_one_page_too_many_is_refused(bench, monkeypatch):
    monkeypatch.setattr("teleop.console.app.MOST_CLIENTS", 1)
    with bench.page() as first:
        first.receive_json()
        with pytest.raises(WebSocketDisconnect), bench.page():
            pass
    with bench.page() as again:
        assert again.receive_json()["type"] == "hello"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ({}, {"a": 1}),
        ({"a": 1}, {"a": 1}),
        ({"a": {"b": 1, "c": 2}}, {"a": {"b": 1, "c": 3}}),
        ({"a": {"b": 1}}, {"a": None}),
        ({"a": None}, {"a": {"b": 1}}),
        ({"a": [1, 2]}, {"a": [1]}),
        ({"a": {"b": 1}}, {"a": [1]}),
    ],
)
def test_a_patch_makes_the_new_state_of_the_old(old, new):
    def without_nulls(value):
        return {k: without_nulls(v) for k, v in value.items() if v is not None} if isinstance(value, dict) else value

    assert without_nulls(applied(old, json.loads(json.dumps(changes(old, new))))) == without_nulls(new)
