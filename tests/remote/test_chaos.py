"""Gateways that stop, die, flood, and clients that hang or are delayed: real processes, the loop in real time.

How soon an axis rests is judged against when the newest message that counts was sent. The loop's own lateness, which
the machine is to blame for, is taken off.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from chaos_bench import ChaosBench, chaos_bench
from waiting import wait_until

from teleop.core.timing import PERIOD
from teleop.dji.gimbal import messages as gimbal


def assert_at_rest_in_time(bench: ChaosBench) -> None:
    assert bench.overruns() <= 0
    assert bench.door.counts.faults == 0
    assert not bench.loop.faults
    yaws = [message.yaw for _, message in bench.wire.of(gimbal.Position)]
    assert yaws[-1] == yaws[-2]  # on the wire too


@pytest.mark.parametrize("what", [signal.SIGSTOP, signal.SIGKILL])
def test_a_gateway_that_stops_or_dies_while_a_hand_holds_a_stick(tmp_path: Path, what: signal.Signals) -> None:
    with chaos_bench(tmp_path, fifo=True) as bench:
        client = bench.client("hold")
        bench.until_full_speed(client)
        os.kill(client.pid, what)
        bench.until_rest()
        assert_at_rest_in_time(bench)
        if what is signal.SIGSTOP:  # after a second, what it had to say and what it says anew moves nothing
            wait_until(lambda: "take control again" in bench.door.stick.waits_for)
            os.kill(client.pid, signal.SIGCONT)
            count = len(bench.ticks)
            wait_until(lambda: len(bench.ticks) > count + 40)
            assert not any(speed for _, speed in bench.ticks[count:])


def test_a_page_whose_script_hangs_while_its_connection_lives(tmp_path: Path) -> None:
    with chaos_bench(tmp_path, fifo=True) as bench:
        client = bench.client("hang")
        bench.until_full_speed(client)
        bench.until_rest()
        assert_at_rest_in_time(bench)


def test_a_network_that_gives_out_in_bursts(tmp_path: Path) -> None:
    with chaos_bench(tmp_path, fifo=True) as bench:
        client = bench.client("stretch")
        bench.until_full_speed(client)
        count = len(bench.ticks)
        wait_until(lambda: len(bench.ticks) > count + 130)
        assert bench.overruns() <= 0
        assert not bench.loop.faults


def test_a_flood_of_what_is_no_command_does_not_keep_a_hand_or_a_stop_from_the_loop(tmp_path: Path) -> None:
    with chaos_bench(tmp_path, fifo=True) as bench:
        client = bench.client("flood", 3000)
        bench.until_full_speed(client)
        wait_until(lambda: bench.door.counts.malformed > 500)
        watcher = bench.client("stops", 1)
        assert watcher.stdout is not None
        assert float(watcher.stdout.readline()) > 0
        bench.until_rest()
        wait_until(lambda: bench.door.counts.malformed >= 3000)
        assert_at_rest_in_time(bench)


SHOOT = """
title: Turn
keyframes: [{at: 0, pan: 0}, {at: 7, pan: 7}]
timelapse: {frames: 8, interval: 0.7s, mode: shoot-move-shoot, exposure: 0.1s, settle: 0.05s}
"""
MOVE = """
title: Across
keyframes: [{at: 0, pan: 0}, {at: 2s, pan: 20}, {at: 4s, pan: 0}]
"""


def trouble(bench: ChaosBench, starter: subprocess.Popen[str], reached: Callable[[int], bool]) -> None:
    """Its page hangs already; then its gateway is stopped, another one floods, and it is killed."""
    wait_until(lambda: reached(1))
    os.kill(starter.pid, signal.SIGSTOP)
    bench.client("floods", 2000)
    wait_until(lambda: reached(4))
    os.kill(starter.pid, signal.SIGKILL)
    wait_until(lambda: not bench.plays)
    wait_until(lambda: bench.door.counts.malformed >= 2000)
    assert bench.door.counts.faults == 0
    assert not bench.loop.faults


def test_no_frame_of_a_shoot_is_lost_by_the_trouble_of_the_gateway_that_began_it(tmp_path: Path) -> None:
    (tmp_path / "turn.yaml").write_text(SHOOT)
    with chaos_bench(tmp_path, fifo=True) as bench:
        starter = bench.client("gives", json.dumps({"do": "shoot", "move": "turn"}))
        shoot = bench.shoot
        assert shoot is not None
        trouble(bench, starter, lambda count: len(bench.shots) > count)
        assert len(bench.shots) == 8
        assert (shoot.progress.shot, shoot.progress.missed, shoot.progress.lost) == (8, 0, [])
        for number, at in enumerate(bench.shots):
            assert abs(at - bench.shots[0] - 0.7 * number) < 1.5 * PERIOD + 2 * bench.late, number


def test_a_move_that_is_not_attended_goes_on_as_planned_through_the_trouble_of_its_gateway(
    tmp_path: Path,
) -> None:
    (tmp_path / "across.yaml").write_text(MOVE)
    with chaos_bench(tmp_path, fifo=True) as bench:
        command = {"do": "play", "move": "across", "preroll": 0, "attended": False}
        starter = bench.client("gives", json.dumps(command))
        begin = bench.ticks[-1][0]
        trouble(bench, starter, lambda part: bench.ticks[-1][0] > begin + 0.4 * part)
        yaws = bench.wire.of(gimbal.Position)
        assert max(message.yaw for _, message in yaws) == pytest.approx(20, abs=0.3)  # it aims ahead, in tenths
        moved = [at for at, speed in bench.ticks if speed]
        assert moved[-1] - moved[0] == pytest.approx(4, abs=0.1 + 2 * bench.late)
