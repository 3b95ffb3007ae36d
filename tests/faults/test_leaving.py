"""The third Ctrl-C or SIGTERM leaves at once, after one attempt to release everything; measured on the wire."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from subprocess import DEVNULL, PIPE

import pytest
from drone_fault_bench import FLIGHT, READY, VIRTUAL_RC, drone_fault_bench
from far_gimbal import FarGimbal, far_gimbal
from gimbal_fault_bench import GimbalFaultBench, gimbal_fault_bench
from network import own_network
from waiting import wait_until

from teleop.cli.signals import AT_MOST, PRESSES, signals_to
from teleop.core.control_loop import AT_ONCE
from teleop.core.errors import LeaveAtOnce
from teleop.core.run_state import RunState
from teleop.core.setpoints import VelocityTarget
from teleop.devices.drone.engagement import LAST_NEUTRALS
from teleop.dji.drone.virtual_rc import NEUTRAL, Sticks
from teleop.dji.gimbal import messages as gimbal
from teleop.sim.drone.controls import Pilot

BREAKS = 8.0  # s after the start
MODES = ("position", "speed", "stick")
URL = "udp_multicast:239.74.163.3"
PROFILES = Path(__file__).parents[2] / "profiles"


def never_rests(bench: GimbalFaultBench) -> None:
    """A planner that goes on as before, and a loop that believes it for ever."""
    planner = bench.loop._planner
    step = planner.step
    moving = {axis: VelocityTarget(5.0) for axis in bench.loop._limits}
    planner.step = lambda demand, steps=1: step(moving, steps)  # type: ignore[method-assign]
    bench.loop._stop_end = bench.loop._stop_limit = 1e9


def hangs(bench: GimbalFaultBench) -> None:
    """A watcher's call that does not come back by itself."""

    def write(_tick: object) -> None:
        while True:
            bench.clock.sleep_until(bench.clock.now() + 0.1)

    bench.watcher.observe = write  # type: ignore[method-assign]


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("fault", [never_rests, hangs])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_third_signal_releases_and_leaves_at_once(
    number: signal.Signals, fault, mode: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with gimbal_fault_bench(mode, tmp_path, monkeypatch) as bench:
        pressed: list[float] = []
        passes = bench.clock.hook

        def press(now: float) -> None:
            passes(now)
            if now >= bench.broken_at + len(pressed) + 1 and len(pressed) < PRESSES:
                pressed.append(now)
                signal.raise_signal(number)

        bench.clock.hook = press

        def run() -> None:
            with signals_to(lambda reason: bench.loop.interrupt(reason), lambda: bench.loop.release_at_once()):
                bench.move(lambda _now: fault(bench))

        with pytest.raises(LeaveAtOnce, match=number.name):
            run()
        assert len(pressed) == PRESSES
        left = bench.clock.now()
        assert left - pressed[-1] <= AT_ONCE + 0.02
        bench.clock.sleep_until(left + 1)
        bench.assert_given_back()
        bench.assert_at_rest()
        assert bench.loop.supervisor.state is not RunState.OVER, "it was not waited for"
        if mode == "speed":
            last = [each for _, each in bench.of(gimbal.Speed)][-4:]
            assert [each.take_over for each in last] == [True, True, True, False]


def test_two_signals_only_ask(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with (
        gimbal_fault_bench("speed", tmp_path, monkeypatch) as bench,
        signals_to(lambda reason: bench.loop.interrupt(reason)),
    ):
        bench.move(lambda _now: (signal.raise_signal(signal.SIGINT), signal.raise_signal(signal.SIGTERM)))
        bench.assert_no_lurch()
        bench.assert_no_jump()
        bench.assert_given_back()
        assert bench.ended.reasons == ["SIGTERM received"]


@pytest.mark.parametrize("held", [VIRTUAL_RC, FLIGHT], ids=["virtual RC", "movement"])
@pytest.mark.parametrize("hung", [True, False])
def test_the_third_signal_leaves_a_drone_neutral_and_released(hung: bool, held: str, tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, held) as bench:
        bench.airborne()
        bench.engage_at(READY)
        bench.hold_at(READY + 1, stick_pitch=0.5)
        for press in range(PRESSES):
            bench.at(BREAKS + press * 0.02, lambda: signal.raise_signal(signal.SIGINT))
        if hung:
            bench.at(BREAKS - 0.001, lambda: setattr(bench.operator, "write", hangs_with(bench.clock.sleep_until)))

        def run() -> None:
            with signals_to(lambda reason: bench.loop.interrupt(reason), lambda: bench.loop.release_at_once()):
                bench.run()

        with pytest.raises(LeaveAtOnce):
            run()
        left = bench.clock.now() - bench.begin
        assert left <= BREAKS + PRESSES * 0.02 + AT_ONCE + 0.05
        bench.clock.sleep_until(bench.clock.now() + 2)
        bench.check()
        assert bench.pilot(left + 2) is Pilot.RC
        if held == VIRTUAL_RC:
            assert [message for _, message in bench.of(Sticks)][-LAST_NEUTRALS:] == [NEUTRAL] * LAST_NEUTRALS
            assert len(bench.disables) == 1


def hangs_with(sleep_until):
    """A call that lets time pass and does not come back by itself."""

    def call(tick) -> None:
        for step in range(10_000):
            sleep_until(tick.time + step / 100)

    return call


# A gimbal that never comes to rest, a sink that hangs in Python, one that hangs where no handler can run, and a
# release that hangs: each as a defect of a real process, which is then sent three signals.
DEFECTS = {
    "never at rest": """
import teleop.core.control_loop
def stop(self, now, steps):
    demand = {axis: VelocityTarget(36.0) for axis in self._limits}
    self._motion = self._planner.step(demand, steps)
    self._emit(now, demand, ())
teleop.core.control_loop.ControlLoop._stop = stop
teleop.core.control_loop.ControlLoop._limit_stopping = lambda self, now: None
""",
    "a sink hangs": """
def write(self, tick):
    if self._ticks > 150:
        threading.Event().wait()
    self._ticks += 1
    self._write(tick)
SpeedSink._ticks, SpeedSink._write, SpeedSink.write = 0, SpeedSink.write, write
""",
    "a sink hangs where no handler runs": """
def write(self, tick):
    if self._ticks > 150:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})  # others take them, its handler none
        ctypes.CDLL(None).sleep(3600)
    self._ticks += 1
    self._write(tick)
SpeedSink._ticks, SpeedSink._write, SpeedSink.write = 0, SpeedSink.write, write
""",
    "another sink's release hangs": """
from teleop.devices.gimbal.commands import CommandSink
CommandSink.release = lambda self, now: threading.Event().wait()
""",
}
PROGRAM = """
import ctypes, signal, sys, threading
from teleop.core.setpoints import VelocityTarget
from teleop.devices.gimbal.speed import SpeedSink
{defect}
from teleop.cli import main
main()
"""


@pytest.fixture(scope="module")
def bus() -> Iterator[str]:
    with own_network("link set lo up", "route add 239.0.0.0/8 dev lo"):
        yield URL


@pytest.fixture
def far(bus: str) -> Iterator[FarGimbal]:
    with far_gimbal(bus) as gimbal:
        yield gimbal


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("defect", DEFECTS)
def test_three_signals_end_a_process_that_hangs(
    defect: str, number: signal.Signals, far: FarGimbal, tmp_path: Path
) -> None:
    (tmp_path / "rig.yaml").write_text((PROFILES / "sim.yaml").read_text().replace("mode: position", "mode: speed"))
    (tmp_path / "sticks.csv").write_text("time,pan\n0,0.3\n40,0\n")
    arguments = ["live", "--sticks", "sticks.csv", "--rig", "./rig.yaml", "--link", f"gimbal={URL}"]
    command = [sys.executable, "-c", PROGRAM.format(defect=DEFECTS[defect]), *arguments]
    with subprocess.Popen(command, stderr=PIPE, stdin=DEVNULL, text=True, cwd=tmp_path) as process:
        try:
            wait_until(lambda: sum(rate > 30 for _, rate in far.turned) > 50, "cruising", patience=30)
            if "a sink hangs" in defect:
                wait_until(lambda: time.monotonic() - far.heard_of(gimbal.Speed)[-1][0] > 0.4, "hung", patience=30)
            for _ in range(PRESSES):
                assert process.poll() is None
                process.send_signal(number)
                time.sleep(0.3)  # as fast as a hand, and not waited for: nothing can be seen in between
            pressed = time.monotonic()
            _, said = process.communicate(timeout=30)
        finally:
            process.kill()
    assert process.returncode == 130, said
    assert "Traceback" not in said
    wait_until(lambda: not far.controlled and abs(far.rates.yaw) < 0.01, "released, and at rest")
    last = [message for _, message in far.heard_of(gimbal.Speed)][-4:]
    assert [each.yaw for each in last] == [0, 0, 0, 0]
    assert not last[-1].take_over
    assert time.monotonic() - pressed < AT_MOST + 10, "far from for ever, on a loaded machine too"


def test_a_late_ctrl_c_changes_no_exit_code_and_ends_a_wait(tmp_path: Path) -> None:
    """All is over but for a thread that never ends, as one that hangs in a disk: the code is that of the run."""
    (tmp_path / "move.yaml").write_text("keyframes: [{at: 0, pan: 0}, {at: 2, pan: 10}]\n")
    defect = "threading.Thread(target=threading.Event().wait).start()"
    command = [sys.executable, "-c", PROGRAM.format(defect=defect), "play", "move.yaml", "--fast", "--json"]
    with subprocess.Popen(command, stdout=PIPE, stderr=PIPE, stdin=DEVNULL, text=True, cwd=tmp_path) as process:
        assert process.stdout is not None
        try:
            assert "done" in process.stdout.readline()
            time.sleep(0.3)  # for the little that is left until it hangs, of which nothing can be seen
            process.send_signal(signal.SIGINT)
            process.wait(timeout=30)
        finally:
            process.kill()
        assert process.returncode == 0
