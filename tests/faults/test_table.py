"""The table of faults: each is made for real in the middle of a move, and what came of it is measured on the wire.

Whatever the fault, the axes come to rest within their limits and without a lurch, speed control is given back and the
reason is said. Where the link itself is gone nobody can give anything back: there the gimbal stops by itself.
"""

from __future__ import annotations

import errno
import math
import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import can
import pytest
from faulty_bus import driver_fault
from gimbal_fault_bench import SLACK, SPEEDS, GimbalFaultBench, RealClock, SteppingClock, gimbal_fault_bench

from teleop.app.realtime import realtime
from teleop.cli.running import EXIT_CODES
from teleop.core.run_state import Result, RunState
from teleop.core.setpoints import VelocityTarget
from teleop.devices.gimbal.pi_correction import MAX_ERROR, MAX_INTEGRAL
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session

MODES = ("position", "speed", "stick")
BY_RATE = ("speed", "stick")
_BUS_OFF = 0x40  # class of an error frame: Linux's can/error.h
_SPEED_ON = {axis: VelocityTarget(speed) for axis, speed in SPEEDS.items()}


@dataclass(frozen=True)
class Row:
    """A fault, what is said of it, and what may be asked of the wire: `lives` is whether commands still arrive."""

    name: str
    breaks: Callable[[GimbalFaultBench, float], None]
    said: str
    code: int = 1
    lives: bool = True
    within: float = 2.0  # s until it is over
    lunge: float = 0.0  # deg/s by which the correction may add to the speed of a gimbal that is not where it should be
    regains: float = SLACK  # deg/s that it may gain once it has slowed down
    modes: tuple[str, ...] = MODES


def unplugged(bench: GimbalFaultBench, _now: float) -> None:
    bench.deaf = True
    bench.bus.send_fault = driver_fault("Failed to transmit", errno.ENXIO)
    bench.bus.receive_faults.append(OSError(errno.ENODEV, "No such device"))


def bus_off(bench: GimbalFaultBench, _now: float) -> None:
    bench.bus.off = bench.mute = True
    bench.bus.own_errors.append(can.Message(arbitration_id=_BUS_OFF, is_error_frame=True, is_extended_id=False))


def bus_full(bench: GimbalFaultBench, _now: float) -> None:
    bench.bus.room = 0


def full_for(seconds: float) -> Callable[[GimbalFaultBench, float], None]:
    """Longer than the link's patience, shorter than the time for which giving back is tried."""

    def breaks(bench: GimbalFaultBench, now: float) -> None:
        pass_time = bench.clock.hook

        def until(later: float) -> None:
            bench.bus.room = 0 if later < now + seconds else 1 << 30
            pass_time(later)

        bench.clock.hook = until

    return breaks


def stalled(bench: GimbalFaultBench, seconds: float) -> None:
    assert isinstance(bench.clock, SteppingClock)
    bench.clock.stall(seconds)


def stalled_with_a_coarse_clock(bench: GimbalFaultBench, now: float) -> None:
    """All readings from then on have one time, whatever the place: a device may date them so."""
    stalled(bench, 0.3)
    reporter = bench.loop._reporters[0]
    report = reporter.report
    reporter.report = lambda later: {  # type: ignore[method-assign]  # a defect is put in
        axis: reading._replace(time=min(reading.time, now + 0.35)) for axis, reading in report(later).items()
    }


def stalled_and_deaf(bench: GimbalFaultBench, _now: float) -> None:
    """It hears, but its readings stay those of before the stall."""
    stalled(bench, 0.3)
    reporter = bench.loop._reporters[0]
    before = reporter.report(bench.clock.now())
    reporter.report = lambda _now: before  # type: ignore[method-assign]


def cable_out(bench: GimbalFaultBench, _now: float) -> None:
    bench.deaf = bench.mute = True


def mute(bench: GimbalFaultBench, _now: float) -> None:
    bench.mute = True


def angles_lost(bench: GimbalFaultBench, _now: float) -> None:
    bench.gimbal.tells_angles = False


def raises_always(error: BaseException) -> Callable[..., Any]:
    def fails(*_arguments: object) -> Any:
        raise error

    return fails


def in_source(error: BaseException) -> Callable[[GimbalFaultBench, float], None]:
    """In every read from now on, not in one only."""

    def breaks(bench: GimbalFaultBench, _now: float) -> None:
        bench.mover.read = raises_always(error)  # type: ignore[method-assign]  # a defect is put in
        raise error

    return breaks


def in_planner(bench: GimbalFaultBench, _now: float) -> None:
    bench.loop._planner.step = raises_always(ZeroDivisionError("a defect"))  # type: ignore[method-assign]


def planner_goes_mad(bench: GimbalFaultBench, _now: float) -> None:
    planner = bench.loop._planner
    step = planner.step
    planner.step = lambda demand, steps=1: {
        axis: s._replace(position=float("nan")) for axis, s in step(demand, steps).items()
    }  # type: ignore[method-assign]


def planner_never_rests(bench: GimbalFaultBench, now: float) -> None:
    planner = bench.loop._planner
    step = planner.step
    planner.step = lambda demand, steps=1: step(_SPEED_ON, steps)  # type: ignore[method-assign]
    bench.loop.interrupt("SIGINT received")


def in_watcher(bench: GimbalFaultBench, _now: float) -> None:
    bench.watcher.observe = raises_always(MemoryError("no room"))  # type: ignore[method-assign]


def in_sink(bench: GimbalFaultBench, _now: float) -> None:
    sink = bench.loop._sinks[0]
    write = sink.write
    countdown = iter(range(3))

    def fails(tick) -> None:
        if next(countdown, None) is not None:
            raise ValueError("a defect")
        write(tick)

    sink.write = fails  # type: ignore[method-assign]


def in_reporter(bench: GimbalFaultBench, _now: float) -> None:
    bench.loop._reporters[0].report = raises_always(KeyError("a defect"))  # type: ignore[method-assign]


SILENT = "gimbal on faulty:.* does not answer: is it on, is the cable in[?]"
ROWS = [
    Row("CAN adapter unplugged", unplugged, "the adapter", lives=False),
    Row("bus off", bus_off, "the bus is off", lives=False),
    Row("bus full", bus_full, "nothing has left for 250 ms, the bus is full or off", lives=False),
    Row("bus full for a moment", full_for(0.6), "nothing has left for 250 ms", lives=False),
    Row("bus full, and back while it stops", full_for(0.35), "nothing has left for 250 ms", lives=False),
    Row("gimbal silent, cable out", cable_out, SILENT, lives=False),
    Row("gimbal silent, but it hears", mute, SILENT),
    Row("gimbal rebooted", lambda s, now: s.gimbal.reboot(now, 3.0), SILENT, lives=False),
    Row(
        "gimbal rebooted in no time",
        lambda s, now: s.gimbal.reboot(now, 0.2),
        "pan does not follow: commanded",
        lunge=MAX_ERROR * 3 + MAX_INTEGRAL,
        regains=math.inf,  # it obeys again, and nobody has noticed yet
        modes=BY_RATE,
    ),
    Row(
        "angles no longer told",
        angles_lost,
        "pan: no position has been reported for 2.5 s",
        within=4.0,
        modes=("position", "speed"),
    ),
    Row("angles no longer told, and nothing else is", angles_lost, SILENT, modes=("stick",)),
    Row(
        "pan held by hand",
        lambda s, now: s.gimbal.hold(now, yaw=True),
        "pan does not follow: commanded .*, measured .*: is it blocked, or held by hand[?]",
    ),
    Row("300 ms stall of the process", lambda s, _: stalled(s, 0.3), "the computer stalled for 0.29 s", within=2.3),
    Row(
        "450 ms stall of the process",
        lambda s, _: stalled(s, 0.45),
        "the computer stalled for 0.44 s",
        within=2.3,
        regains=10.0,  # it is found at its old speed, and forgets that while it is being found
    ),
    Row("600 ms stall of the process", lambda s, _: stalled(s, 0.6), "the computer stalled for 0.59 s", within=2.3),
    Row("suspended for an hour", lambda s, _: stalled(s, 3600.0), "the computer stalled for 3599.99 s", within=3602.0),
    Row(
        "300 ms stall, and all readings of one moment",
        stalled_with_a_coarse_clock,
        "the computer stalled for 0.29 s",
        regains=10.0,  # what is last read of it may be a tenth of a degree off where it came to rest
    ),
    Row("300 ms stall, and no reading after it", stalled_and_deaf, "the computer stalled for 0.29 s"),
    Row("a signal", lambda s, _: s.loop.interrupt("SIGTERM received"), "SIGTERM received", code=130),
    Row("exception in a source", in_source(ZeroDivisionError("a defect")), "ZeroDivisionError: a defect"),
    Row("a source wants to exit", in_source(SystemExit(3)), "SystemExit: 3"),
    Row("a generator's end in a source", in_source(GeneratorExit()), "GeneratorExit"),
    Row("no memory in a source", in_source(MemoryError()), "MemoryError"),
    Row("Ctrl-C in the middle of a source", in_source(KeyboardInterrupt()), "Ctrl-C", code=130),
    Row("exception in the planner", in_planner, "ZeroDivisionError: a defect"),
    Row("planner without numbers", planner_goes_mad, "the planner has pan at nan"),
    Row("planner that never comes to rest", planner_never_rests, "SIGINT received", code=130, within=6.0),
    Row("exception in a sink", in_sink, "ValueError: a defect"),
    Row("exception in a watcher", in_watcher, "MemoryError: no room"),
    Row("exception in a reporter", in_reporter, "KeyError: 'a defect'"),
]


@pytest.mark.parametrize(
    ("row", "mode"), [pytest.param(row, mode, id=f"{row.name}, {mode}") for row in ROWS for mode in row.modes]
)
def test_a_fault_ends_at_rest_and_given_back_with_its_reason(
    row: Row, mode: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with gimbal_fault_bench(mode, tmp_path, monkeypatch) as stage:
        stage.move(lambda now: row.breaks(stage, now))
        stage.assert_moving_when_broken()
        stage.assert_at_rest()
        assert stage.over - stage.broken_at < row.within
        assert re.search(row.said, stage.ended.reasons[0])
        assert EXIT_CODES[stage.ended.result] == row.code
        stage.assert_no_lurch(row.lunge, row.regains)
        stage.assert_no_jump()
        if row.lives:
            stage.assert_given_back()


def test_a_gimbal_that_is_no_longer_reached_stops_by_itself_within_half_a_second(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for mode, holds in (("position", 0.1), ("speed", 0.5), ("stick", 0.5)):
        with gimbal_fault_bench(mode, tmp_path, monkeypatch) as stage:
            stage.move(lambda now: unplugged(stage, now))
            last = max(time for time, _ in stage.wire)
            still = min(time for time, yaw, pitch in stage.rates if time > last and abs(yaw) < 0.5 and abs(pitch) < 0.5)
            assert still - last < holds + 0.3, "the motor's own lag of 50 ms, and no more"


@pytest.mark.parametrize("step", [-3.0, 3600.0])
def test_a_jump_of_the_wall_clock_is_not_felt(step: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In real time, because only there is a clock that might be the wrong one."""
    wall, sent = time.time, []
    with gimbal_fault_bench("speed", tmp_path, monkeypatch, RealClock()) as stage:
        send = stage.bus.send

        def noted(message: can.Message, timeout: float | None = None) -> None:
            sent.append(time.perf_counter())
            send(message, timeout)

        stage.bus.send = noted  # type: ignore[method-assign]
        with realtime(True, print):  # or what runs beside it makes gaps too
            stage.move(lambda _now: monkeypatch.setattr(time, "time", lambda: wall() + step), seconds=2.0)
        assert time.time() - wall() == pytest.approx(step, abs=0.1)
        assert (stage.ended.result, stage.ended.reasons) == (Result.DONE, [])
        assert max(later - earlier for earlier, later in pairwise(sent)) < 0.5, "commands go on, as they must"
        stage.assert_at_rest()
        stage.assert_given_back()


def test_an_axis_that_was_held_does_not_set_out_once_it_is_let_go(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for mode in MODES:
        with gimbal_fault_bench(mode, tmp_path, monkeypatch) as stage:
            stage.move(lambda now: stage.gimbal.hold(now, yaw=True))
            stood = stage.gimbal.angles.yaw
            [*_, (_, last)] = (
                stage.of(gimbal.Position)
                if mode == "position"
                else stage.of(gimbal.Speed if mode == "speed" else gimbal.Joystick)
            )
            if isinstance(last, gimbal.Position):
                assert not last.yaw_ignored
                assert last.pitch_ignored
                assert last.yaw == pytest.approx(stood, abs=0.1)
            else:
                assert last.yaw == 0


@pytest.mark.parametrize("lost", [1, 2])
def test_control_is_given_back_again_when_that_very_frame_is_lost(
    lost: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with gimbal_fault_bench("speed", tmp_path, monkeypatch) as stage:
        receive, left = stage.gimbal.receive, [lost]

        def lossy(data: bytes, now: float) -> None:
            if left[0] and any(
                isinstance(each.message, gimbal.Speed) and not each.message.take_over
                for each in Session().receive(data, now)
            ):
                left[0] -= 1
                return
            receive(data, now)

        stage.gimbal.receive = lossy  # type: ignore[method-assign]
        stage.move(lambda _now: stage.loop.interrupt("SIGINT received"))
        assert left == [0]
        assert not stage.gimbal.controlled


@pytest.mark.parametrize("at", [0.0, 0.03, 0.1, 0.16, 0.2, 0.3])
def test_ctrl_c_again_and_again_while_it_is_given_back(
    at: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As Python raises it where nobody handles the signal, out of whatever is being called."""
    with gimbal_fault_bench("speed", tmp_path, monkeypatch) as stage:
        pressed: list[float] = []
        send = stage.bus.send

        def interrupted(message, timeout=None) -> None:
            now = stage.clock.now()
            send(message, timeout)
            if (
                stage.loop.supervisor.state is RunState.RELEASING
                and (not pressed or now - pressed[0] >= at)
                and len(pressed) < 3
            ):
                pressed.append(now)
                raise KeyboardInterrupt

        stage.bus.send = interrupted  # type: ignore[method-assign]
        stage.move(lambda _now: stage.loop.interrupt("SIGINT received"))
        assert pressed
        assert stage.ended.result is Result.INTERRUPTED
        assert not stage.gimbal.controlled
        assert not stage.of(gimbal.Speed)[-1][1].take_over
