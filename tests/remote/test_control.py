"""Who has control, by the answers that clients get and the state that everybody sees."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from remote_bench import ANNA, BOB, RemoteBench

from teleop.remote.control import ASK_TIME, HANDOVER, IDLE, Control, Denied, Person

PEOPLE = [Person(name, name.title()) for name in ("anna", "bob", "carol")]


def test_nobody_moves_anything_without_control(bench: RemoteBench) -> None:
    answer = bench.ask("goto", axes={"pan": 10.0})
    assert (answer["error"], answer["kind"]) == ("take control first", "refused")
    bench.run(0.5)
    assert bench.at() == 0


def test_another_one_is_refused_with_the_holders_name(held: RemoteBench) -> None:
    for do, fields in (("take_control", {}), ("goto", {"axes": {"pan": 1.0}}), ("clear", {}), ("set_key", {})):
        answer = held.ask(do, BOB, **fields)
        assert (answer["kind"], answer["holder"]) == ("busy", "Anna"), do
        assert "Anna has control" in answer["error"]


def test_asking_passes_control_after_five_seconds_and_the_axes_rest_first(held: RemoteBench) -> None:
    number = held.say("take_control", BOB, ask=True)
    held.hold(ASK_TIME - 0.5, pan=0.1)
    assert held.answers[number]["ok"]
    assert number not in held.ends
    assert (held.state["asking"], held.state["holder"]) == ("Bob", "Anna")
    held.hold(1.5, pan=0.1)
    assert held.state["holder"] == "Bob"
    assert held.rests  # Anna's finger is still down
    assert held.ends[number]["ok"]


def test_the_holder_can_say_no(held: RemoteBench) -> None:
    number = held.say("take_control", BOB, ask=True)
    held.run(1)
    assert "ok" in held.ask("deny_control")
    held.run(ASK_TIME)
    assert held.state["holder"] == "Anna"
    assert held.ends[number]["error"] == "Anna said no"


def test_a_holder_that_does_nothing_loses_control_after_a_minute() -> None:
    lines: list[str] = []
    control = Control(lines.append)
    control.take(PEOPLE[0], 0.0)
    control.step(IDLE - 0.1, rests=True, busy=False)
    assert control.holds(ANNA)
    control.step(IDLE, rests=True, busy=False)
    assert control.holder is None
    assert lines == [
        "Anna has control",
        "Anna has done nothing for 60 s",
        "Anna has control no longer: it is free",
    ]


def test_a_holder_whose_action_goes_on_is_not_idle() -> None:
    control = Control(lambda _line: None)
    control.take(PEOPLE[0], 0.0)
    for second in range(1, 200):
        control.step(float(second), rests=False, busy=True)
    assert control.holds(ANNA)


def test_a_brief_command_takes_control_for_what_it_does_alone(bench: RemoteBench) -> None:
    number = bench.say("goto", axes={"pan": 10.0}, seconds=2.0, brief=True)
    bench.run(1)
    assert bench.answers[number]["ok"]
    assert bench.state["holder"] == "Anna"
    assert bench.ask("goto", BOB, axes={"pan": 0.0}, brief=True)["kind"] == "busy"
    bench.run(1.5)
    assert bench.ends[number]["ok"]
    assert bench.state["holder"] is None
    assert bench.at() == pytest.approx(10)
    assert "ok" in bench.ask("goto", BOB, axes={"pan": 0.0}, brief=True)


def test_a_brief_command_that_is_refused_leaves_control_free(bench: RemoteBench) -> None:
    assert bench.ask("goto", axes={"pan": 500.0}, brief=True)["kind"] == "refused"
    assert bench.state["holder"] is None


def test_a_closed_holder_has_control_for_a_second_at_most(held: RemoteBench) -> None:
    held.say("goto", axes={"pan": 170.0}, seconds=20.0)
    held.run(1)
    held.say("closed")
    held.run(HANDOVER - 0.05)
    assert held.state["holder"] == "Anna"
    held.run(0.1)
    assert held.state["holder"] is None
    assert not held.rests  # the way is bounded by itself


def test_a_stop_is_anybodys_and_everybody_sees_whose(held: RemoteBench) -> None:
    way = held.say("goto", axes={"pan": 100.0}, seconds=5.0)
    held.run(1)
    assert held.ask("stop", "watcher-7")["ok"]
    held.run(1)
    state = held.state
    assert held.rests
    assert (state["stopped"], state["stopped_by"]) == (True, "Watcher-7")
    assert state["stopped_at"] is not None
    assert held.ends[way]["error"] == "STOP by Watcher-7"
    assert held.ask("goto", axes={"pan": 0.0})["error"] == "STOP is not cleared"
    held.ask("clear")
    assert "ok" in held.ask("goto", axes={"pan": 0.0})


def test_a_stop_that_comes_again_after_it_was_cleared_is_the_same_one(held: RemoteBench) -> None:
    """The sender repeats it until the state shows it."""
    number = held.say("stop")
    held.tick()
    assert held.state["stopped"]
    held.ask("clear")
    held.tick(2)
    held.send(held.sent[number])
    held.run(0.1)
    assert not held.state["stopped"]


def test_a_gateway_that_has_ended_takes_every_connection_with_it(held: RemoteBench) -> None:
    held.hold(0.5, pan=1.0)
    held.hands.door._end()
    held.run(1)
    assert held.rests
    assert held.state["holder"] is None


Step = st.tuples(
    st.sampled_from(["take", "ask", "brief", "release", "closed", "deny", "use"]),
    st.sampled_from(PEOPLE),
    st.floats(0, 20),
    st.booleans(),
)


@settings(max_examples=50, deadline=None)
@given(st.lists(Step, max_size=25))
def test_at_most_one_has_control_whatever_anybody_does(
    steps: list[tuple[str, Person, float, bool]],
) -> None:
    control, now = Control(lambda _line: None), 0.0
    for what, person, pause, rests in steps:
        before = control.holder
        try:
            if what in ("take", "ask", "brief"):
                has = control.take(person, now, what == "ask", what == "brief")
                assert has == control.holds(person.session)
                assert not has or before in (None, person)  # never taken from another one at once
        except Denied as denied:
            refused_for = denied.holder
            assert refused_for == (before.name if before else None)
        if what == "release":
            control.release(person.session, now)
        elif what == "closed":
            control.closed(person.session, now)
        elif what == "deny" and control.holds(person.session):
            control.deny()
        elif what == "use" and control.holds(person.session):
            control.use(now)
        assert sum(control.holds(each.session) for each in PEOPLE) <= 1
        end = now + pause
        while now < end:
            now += 0.5
            was = control.holder
            control.step(now, rests, busy=False)
            if was is not None and control.holder not in (None, was):
                assert control.changes  # passed on, by asking
    control.closed(control.holder.session if control.holder else "", now)
    for _ in range(12):
        now += 0.1
        control.step(now, rests=False, busy=True)
    assert control.holder is None or not control.leaving
