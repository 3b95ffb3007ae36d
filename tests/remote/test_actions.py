"""What clients can have a rig do, by the answers, the state and the wire of the simulated gimbal."""

from __future__ import annotations

from typing import Any

import pytest
from remote_asks import done, ended, planned_or_not, played, until
from remote_bench import BOB, RemoteBench

from teleop.dji.gimbal import messages as gimbal
from teleop.remote.desk import MOST

# --- ways


def test_a_goto_arrives_in_its_time_and_says_when(held: RemoteBench) -> None:
    begin = held.now
    assert done(held, "goto", axes={"pan": 20.0, "tilt": -5.0}, seconds=2.0)["ok"]
    assert held.now - begin == pytest.approx(2.0, abs=0.1)
    pan = held.state["axes"]["pan"]
    assert (pan["commanded"], pan["measured"]) == (pytest.approx(20), pytest.approx(20, abs=0.1))
    assert held.tap.of(gimbal.Position)[-1][1].yaw == pytest.approx(20)


@pytest.mark.parametrize(
    ("do", "fields", "reason"),
    [
        ("goto", {"axes": {"pan": 181.0}}, "pan: 181 is outside the soft limits (-180..180)"),
        ("goto", {"axes": {"roll": 1.0}}, "roll is not an axis of this rig"),
        ("focus", {"to": 0.5}, "focus is not an axis of this rig"),
        ("preset_recall", {"number": 3}, "there is no preset 3 yet"),
        ("delete_key", {"number": 1}, "there is no key 1"),
        ("play", {"move": "keys"}, "set at least two keys first"),
        ("pause", {}, "no move is playing"),
        ("abort", {}, "nothing moves that could be aborted"),
        ("range", {"number": 9}, "there are 3 speed ranges"),
        ("message", {"name": "gimbal positoin"}, "gimbal positoin"),
        ("message", {"name": "gimbal position", "fields": {"yaw": 10}}, "would disturb the commands of the run"),
        ("follow", {"mode": "me"}, "gimbal follow me"),
    ],
)
def test_what_the_rig_cannot_do_is_refused_with_the_reason(
    held: RemoteBench, do: str, fields: dict[str, Any], reason: str
) -> None:
    answer = held.ask(do, **fields)
    assert answer["kind"] == "refused"
    assert reason in answer["error"]


def test_jogs_add_up_and_end_at_the_soft_limit(held: RemoteBench) -> None:
    for _ in range(3):
        assert "ok" in held.ask("jog", axis="pan", by=1.0)
    held.run(1)
    assert held.at() == pytest.approx(3)
    assert done(held, "jog", axis="tilt", by=-90.0, within=2.0)["ok"]
    assert held.state["axes"]["tilt"]["commanded"] == pytest.approx(-50)
    assert "soft limit" in held.ask("jog", axis="tilt", by=-1.0)["error"]


@pytest.mark.parametrize(
    ("do", "fields"),
    [
        ("goto", {"axes": {"pan": 60.0, "tilt": 1.0}, "seconds": 0.5}),
        ("preset_recall", {"number": 1, "seconds": 0.5}),
        ("recenter", {"seconds": 0.01}),
    ],
)
def test_a_way_in_less_time_than_the_limits_need_is_refused_with_the_shortest(
    held: RemoteBench, do: str, fields: dict[str, Any]
) -> None:
    done(held, "goto", axes={"pan": 60.0})
    held.ask("preset_store", number=1)
    done(held, "goto", axes={"pan": 0.0 if do != "recenter" else 60.0})
    answer = held.ask(do, **fields)
    assert answer["kind"] == "refused"
    assert "the limits of this rig need 1.35 s" in answer["error"]
    begin = held.now
    assert done(held, do, **{**fields, "seconds": 1.35})["ok"]
    assert held.now - begin == pytest.approx(1.35, abs=0.1)


def test_a_way_that_may_be_stretched_takes_as_long_as_the_limits_need(held: RemoteBench) -> None:
    done(held, "goto", axes={"pan": 60.0})
    held.ask("preset_store", number=1)
    done(held, "goto", axes={"pan": 0.0})
    begin = held.now
    assert done(held, "preset_recall", number=1, seconds=0.5, stretch=True)["ok"]
    assert held.now - begin == pytest.approx(1.35, abs=0.1)


def test_what_follows_upon_a_request_that_still_runs_has_control_too(free: RemoteBench) -> None:
    """As HTTP does it: each command takes control for itself alone."""
    free.ask("set_key", brief=True)
    way = free.say("goto", axes={"pan": 20.0}, seconds=1.0, brief=True)
    free.tick()
    free.ask("set_key", brief=True)
    number = played(free, move="there", preroll=0.0, brief=True)
    assert "error" in free.ends[way] or free.ends[way]["ok"]
    free.run(1)
    ended(free, "pause", brief=True)
    assert free.state["holder"] == "Anna"
    ended(free, "resume", brief=True)
    until(free, lambda: number in free.ends)
    assert free.ends[number]["ok"]
    free.tick(3)
    assert free.state["holder"] is None
    ways: dict[str, dict[str, Any]] = {
        "jog": {"axis": "pan", "by": 5.0},
        "goto": {"axes": {"pan": 9.0}},
        "recenter": {},
    }
    for do, fields in ways.items():
        assert "ok" in free.ask(do, **fields, brief=True), do
        free.run(0.1)
    until(free, lambda: free.state["holder"] is None)
    assert free.rests


def test_a_move_whose_control_another_one_has_by_the_time_it_is_planned_is_refused_with_the_holder(
    free: RemoteBench,
) -> None:
    works = free.hands._works
    deliver, works.deliver = works.deliver, lambda: None
    number = free.say("play", move="there", brief=True)
    free.tick()
    free.hands.desk.control.holder = None  # as after 60 s
    assert "ok" in free.ask("take_control", BOB)
    works.deliver = deliver
    answer = planned_or_not(free, number)
    assert (answer["kind"], answer["holder"]) == ("busy", "Bob")


def test_an_operator_at_the_rig_ends_a_way(held: RemoteBench) -> None:
    number = held.say("goto", axes={"pan": 100.0}, seconds=10.0)
    held.run(1)
    held.pad.hold(pan=-0.5)
    held.run(0.5)
    assert held.ends[number]["error"] == "an operator moved pan"
    held.pad.hold(pan=0.0)
    held.run(1)
    assert held.rests


def test_a_new_way_replaces_the_one_under_way(held: RemoteBench) -> None:
    first = held.say("goto", axes={"pan": 100.0}, seconds=10.0)
    held.run(1)
    assert done(held, "goto", axes={"pan": 0.0}, seconds=2.0)["ok"]
    assert held.ends[first]["error"] == "replaced by goto"


def test_presets_and_keys_are_stored_where_the_axes_are(held: RemoteBench) -> None:
    done(held, "goto", axes={"pan": 12.0}, seconds=1.0)
    assert "ok" in held.ask("preset_store", number=4, name="wide")
    assert "ok" in held.ask("set_key")
    assert held.state["presets"] == {"4": {"pan": 12.0, "tilt": 0.0, "name": "wide"}}
    assert held.state["keys"] == [{"pan": 12.0, "tilt": 0.0}]
    assert done(held, "recenter", seconds=1.0)["ok"]
    assert held.at() == pytest.approx(0)
    assert done(held, "preset_recall", number=4, seconds=1.0)["ok"]
    assert held.at() == pytest.approx(12)
    assert "ok" in held.ask("preset_delete", number=4)
    assert "ok" in held.ask("clear_keys")
    assert (held.state["presets"], held.state["keys"]) == ({}, [])


# --- keys of the terminal


def test_manual_control_is_turned_on_and_off_by_what_is_wanted_and_not_by_the_other_way_round(
    held: RemoteBench,
) -> None:
    assert held.state["manual"]
    for on in (False, False, True, True):
        assert "ok" in held.ask("manual", on=on)
        held.tick()
        assert held.state["manual"] is on
    assert [line for line in held.lines if line.startswith("manual control on")] == ["manual control on"]


def test_what_a_rig_has_not_is_refused_and_not_only_noted(held: RemoteBench) -> None:
    for do, fields, reason in (
        ("drone", {"command": "arm"}, "this rig has no drone"),
        ("drone", {"command": "fly"}, "unknown command drone fly; commands: engage, disengage, arm"),
        ("mark_target", {"text": "door,4.2"}, "start the rig with --targets FILE"),
        ("focus_mark_store", {"name": "A"}, "this rig has no focus"),
        ("focus_mark_recall", {"name": "A"}, "there is no focus mark A yet"),
        ("focus_mark_delete", {"name": "A"}, "there is no focus mark A"),
    ):
        answer = held.ask(do, **fields)
        assert reason in answer["error"]
        assert answer["kind"] == "refused"


# --- devices


def test_a_record_is_done_once_the_camera_says_so(held: RemoteBench) -> None:
    assert done(held, "record")["ok"]
    held.run(1)
    assert held.state["recording"]
    assert held.state["recording_s"] == pytest.approx(1, abs=0.1)
    assert done(held, "stop_recording")["ok"]
    assert not held.state["recording"]
    assert done(held, "shutter")["ok"]


def test_a_follow_mode_and_any_message_are_done_once_the_gimbal_confirms(held: RemoteBench) -> None:
    assert done(held, "follow", mode="lock")["ok"]
    assert held.state["follow"] == "lock"
    assert done(held, "message", name="gimbal version")["ok"]
    held.say("goto", axes={"pan": 50.0}, seconds=5.0)
    held.run(0.5)
    assert held.ask("follow", mode="pan")["error"] == "an axis is moving"


def test_a_speed_range_is_chosen_by_its_number(held: RemoteBench) -> None:
    assert "ok" in held.ask("range", number=1)
    held.tick()
    assert held.state["range"] == 1
    held.hold(1.0, pan=1.0)
    assert held.speed() == pytest.approx(6)


# --- moves


def test_a_move_of_the_folder_plays_to_its_end(stage: RemoteBench) -> None:
    number = played(stage, move="there", preroll=0.0)
    assert stage.state["move"]["title"] == "There and back"
    stage.run(2)
    assert stage.at() == pytest.approx(20, abs=1)
    stage.run(2.5)
    assert stage.ends[number]["ok"]
    assert stage.state["move"] is None


def test_each_pass_that_is_over_is_shown_with_its_errors_by_axis_the_last_one_too(stage: RemoteBench) -> None:
    assert not stage.state["errors"]
    number = played(stage, move="there", preroll=0.0, passes=2)
    assert stage.state["errors"] == {"title": "There and back", "passes": []}
    until(stage, lambda: len(stage.state["errors"]["passes"]) == 1)
    assert (stage.state["move"] or {})["pass"] == 2
    until(stage, lambda: number in stage.ends)
    passes = stage.state["errors"]["passes"]
    assert [each["pass"] for each in passes] == [1, 2]
    for each in passes:
        assert set(each["axes"]) == {"pan", "tilt"}
        assert all(0 < axis["rms"] <= axis["peak"] < 0.5 for axis in each["axes"].values())
    assert stage.state["battery"] is None


def test_a_move_that_is_neither_here_nor_shipped_is_refused(stage: RemoteBench) -> None:
    number = stage.say("play", move="nowhere")
    planned_or_not(stage, number)
    assert stage.answers[number]["kind"] == "refused"
    assert "there is no move 'nowhere'" in stage.answers[number]["error"]


def test_the_keys_from_the_hand_play(stage: RemoteBench) -> None:
    for pan in (0.0, 10.0, 5.0):
        done(stage, "goto", axes={"pan": pan}, seconds=1.0)
        stage.ask("set_key")
    number = played(stage, move="keys", preroll=0.0)
    stage.run(10)
    assert stage.ends[number]["ok"]
    assert stage.at() == pytest.approx(5)


def test_the_transport_pauses_on_the_path_seeks_and_goes_on(stage: RemoteBench) -> None:
    number = played(stage, move="there", preroll=0.0)
    stage.run(1)
    assert stage.ask("seek", at=0.5)["error"] == "pause the move first"
    ended(stage, "pause")
    assert stage.rests
    assert stage.state["move"]["phase"] == "paused"
    ended(stage, "seek", at=2.0)
    assert stage.at() == pytest.approx(20)
    ended(stage, "next_key")
    assert stage.state["move"]["at"] == pytest.approx(4.0)
    ended(stage, "previous_key")
    assert stage.state["move"]["at"] == pytest.approx(2.0)
    ended(stage, "to_start")
    assert stage.state["move"]["at"] == pytest.approx(0.0)
    ended(stage, "speed", share=0.5)
    ended(stage, "resume")
    stage.run(2)
    assert stage.state["move"]["speed"] == 0.5
    stage.run(7)
    assert stage.ends[number]["ok"]


def test_a_stop_holds_a_move_and_a_resume_rejoins_it(stage: RemoteBench) -> None:
    number = played(stage, move="there", preroll=0.0)
    stage.run(1)
    stage.say("stop", BOB)
    stage.run(1)
    assert stage.rests
    assert stage.state["move"]["phase"] == "paused"
    assert stage.ask("resume")["error"] == "STOP is not cleared"
    stage.ask("clear")
    stage.run(0.5)
    assert stage.rests
    stage.ask("resume")
    stage.run(6)
    assert stage.ends[number]["ok"]


def test_an_abort_ends_it(stage: RemoteBench) -> None:
    number = played(stage, move="there", preroll=0.0)
    stage.run(1)
    assert "ok" in stage.ask("abort")
    stage.run(1)
    assert stage.rests
    assert stage.ends[number]["error"] == "aborted by Anna"


@pytest.mark.parametrize("gone", ["page silent", "closed", "gateway silent"])
def test_an_attended_move_pauses_two_seconds_after_its_console_is_gone(stage: RemoteBench, gone: str) -> None:
    played(stage, move="there", preroll=0.0, passes=9)
    stage.run(0.5)
    match gone:
        case "page silent":
            stage.seen = {}
        case "closed":
            stage.say("closed")
        case _:
            stage.quiet = True
    stage.run(1.5)
    assert gone == "closed" or stage.state["move"]["phase"] == "playing"
    paused(stage)
    assert stage.rests
    assert any("its console is gone" in line for line in stage.lines)


def test_a_move_that_is_not_attended_goes_on(stage: RemoteBench) -> None:
    number = played(stage, move="there", preroll=0.0, attended=False)
    stage.quiet = True
    stage.run(4.5)
    assert stage.ends[number]["ok"]


def test_a_handover_holds_a_move_where_it_is(stage: RemoteBench) -> None:
    played(stage, move="there", preroll=0.0, passes=9)
    stage.say("take_control", BOB, ask=True)
    stage.run(6.5)
    assert stage.state["holder"] == "Bob"
    assert stage.rests
    assert stage.state["move"]["phase"] == "paused"
    assert "ok" in stage.ask("resume", BOB)
    stage.run(1)
    assert not stage.rests


# --- what comes from outside


def test_a_flood_of_what_is_no_command_is_counted_answered_and_disturbs_nothing(held: RemoteBench) -> None:
    way = held.say("goto", axes={"pan": 20.0}, seconds=2.0)
    for _ in range(200):
        for _ in range(8):
            held.send(b"\xc1 no msgpack")
        held.tick()
    held.run(1)
    assert held.ends[way]["ok"]
    assert held.hands.desk.counts.malformed == 1600
    assert held.hands.desk.counts.faults == 0


def test_a_tick_takes_a_bounded_number_of_datagrams(held: RemoteBench) -> None:
    class Endless:
        lost = 0

        def receive(self, most: int) -> Any:
            assert most == MOST
            return iter(())

    held.hands.desk._socket = Endless()  # type: ignore[assignment]
    held.tick()


def test_a_fault_in_a_command_ends_no_run(held: RemoteBench, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> None:
        raise RuntimeError("broken")

    monkeypatch.setattr(held.hands.desk.actions, "do", fails)
    assert "RuntimeError: broken" in held.ask("set_key")["error"]
    held.run(0.1)
    assert held.state["run"] == "running"


def paused(bench: RemoteBench) -> None:
    until(bench, lambda: bench.state["move"]["phase"] == "paused" and bench.rests)
