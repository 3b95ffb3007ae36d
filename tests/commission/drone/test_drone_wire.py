"""What a drone's commissioning can send: three questions, and virtual RC with neutral sticks. Nothing else, ever."""

from __future__ import annotations

import ast
import itertools
from pathlib import Path

import pytest
from drone_commission_bench import DroneCommissionBench
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import teleop.commission.drone
from teleop.commission.drone.session_steps import WORD
from teleop.commission.page import GO, Stage
from teleop.core.errors import LinkError
from teleop.dji.drone.virtual_rc import NEUTRAL, VirtualRc
from teleop.dji.frame import Frame
from teleop.sim.drone.controls import Switch

ENABLE, DISABLE = VirtualRc(on=True).data(), VirtualRc(on=False).data()
ASKS = b"\x00\x00", b"\x00\x01", b"\x00\x10"
KEYS = st.sampled_from([GO, "space", "s", "r", "q", "y", "n", "u", *WORD, "backspace", "left"])


def check(sent: list[tuple[float, Frame]]) -> None:
    """Only what is allowed, byte for byte; enables 2 s apart, each ended; sticks only in between."""
    enabled = -10.0
    is_on = False
    for time, frame in sent:
        data = frame.data
        assert data[:2] in ASKS or data in (ENABLE, DISABLE, NEUTRAL.data()), data.hex()
        if data == ENABLE:
            assert time - enabled > 2.0
            assert not is_on
            enabled, is_on = time, True
        elif data == NEUTRAL.data():
            assert is_on
        elif data == DISABLE:
            is_on = False
    assert not is_on


def test_a_whole_commissioning_sends_nothing_else_and_sticks_at_20_hz() -> None:
    bench = DroneCommissionBench()
    bench.run()
    check(bench.sent)
    assert sum(frame.data == ENABLE for _, frame in bench.sent) == 2
    times = [time for time, frame in bench.sent if frame.data == NEUTRAL.data()]
    gaps = [after - before for before, after in itertools.pairwise(times)]
    assert min(gaps) > 0.03
    assert sorted(gaps)[len(gaps) // 2] == pytest.approx(0.05, abs=0.011)


def test_nothing_is_sent_before_the_propellers_are_typed_to_be_off() -> None:
    bench = DroneCommissionBench()
    bench.operator.words = "yes"
    bench.run()
    assert bench.runner.reason.startswith("a drone is commissioned only after")
    assert bench.sent == []


def test_skipping_the_propellers_skips_everything() -> None:
    bench = DroneCommissionBench()
    bench.operator.skips = lambda page: page.key == "propellers"
    found = bench.run()
    assert bench.sent == []
    assert all(fact.found is None for fact in found.facts)


@given(st.lists(st.tuples(KEYS, st.integers(1, 80)), max_size=60), st.sampled_from(list(Switch)))
@settings(max_examples=6, deadline=None, phases=[Phase.explicit, Phase.generate])
def test_whatever_keys_come_nothing_else_is_sent_and_no_motor_runs(keys: list[tuple[str, int]], switch: Switch) -> None:
    bench = DroneCommissionBench(switch=switch)
    for key in (GO, *WORD, GO):  # else nearly every run ends at the first page
        for _ in range(15):
            bench.turn()
        bench.turn(key)
    for key, ticks in keys:
        for _ in range(ticks):
            bench.turn(*bench.operator.keys(bench.runner.page, bench.clock.now()))
        bench.turn(key)
    bench.runner.interrupt("SIGTERM received")
    for _ in range(100):
        bench.turn()
    check(bench.sent)
    assert bench.runner.stage is Stage.OVER
    assert not bench.motors
    assert not bench.drone.autopilot.virtual_on


@pytest.mark.parametrize(
    ("key", "by"),
    [
        *((("virtual-rc", by)) for by in ("space", "signal", "lost", "at-once", "airborne")),
        *((("virtual-rc-timeout", by)) for by in ("space", "lost")),
    ],
)
def test_however_it_ends_virtual_rc_is_given_back(key: str, by: str) -> None:
    bench = DroneCommissionBench()
    bench.operator.skips = lambda page: page.key in ("signs", "fields", "frequencies")
    ended: list[float] = []

    def end(bench: DroneCommissionBench) -> None:
        if ended or bench.runner.page.key != key or not bench.drone.autopilot.virtual_on:
            return
        ended.append(bench.clock.now())
        match by:
            case "space":
                bench.turn("space")
            case "signal":
                bench.runner.interrupt("SIGINT received")
            case "at-once":
                bench.bench.release_at_once()
            case "airborne":
                bench.drone.autopilot.flight.airborne = True
            case "lost":

                def gone() -> bytes:
                    raise LinkError("the port is gone")

                bench.bench.connection._link.receive = gone  # type: ignore[method-assign]

    bench.watch = end
    bench.run()
    assert ended
    assert not bench.drone.autopilot.virtual_on
    check(bench.sent)


def test_the_module_imports_no_way_to_move_arm_or_take_off() -> None:
    folder = Path(teleop.commission.drone.__file__).parent
    names: set[str] = set()
    for file in folder.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                names |= {f"{node.module}.{alias.name}" for alias in node.names}
            elif isinstance(node, ast.Attribute):
                names.add(node.attr)
    forbidden = {"Arm", "Task", "Move", "Control", "Sticks", "movement", "ARMING", "CORNERS", "tell"}
    assert not {name for name in names if name.rpartition(".")[2] in forbidden}
