"""Gateways that stop, die, flood, and clients that hang or are delayed: real processes, the loop in real time.

How soon an axis rests is judged against when the newest message that counts was sent. The loop's own lateness, which
the machine is to blame for, is taken off.
"""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from chaos_bench import ChaosBench, chaos_bench
from waiting import wait_until

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
        bench.until_full_speed()
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
        bench.client("hang")
        bench.until_full_speed()
        bench.until_rest()
        assert_at_rest_in_time(bench)


def test_a_network_that_gives_out_in_bursts(tmp_path: Path) -> None:
    with chaos_bench(tmp_path, fifo=True) as bench:
        bench.client("stretch")
        bench.until_full_speed()
        count = len(bench.ticks)
        wait_until(lambda: len(bench.ticks) > count + 130)
        assert bench.overruns() <= 0
        assert not bench.loop.faults


def test_a_flood_of_what_is_no_command_does_not_keep_a_hand_or_a_stop_from_the_loop(tmp_path: Path) -> None:
    with chaos_bench(tmp_path, fifo=True) as bench:
        bench.client("flood", 3000)
        bench.until_full_speed()
        wait_until(lambda: bench.door.counts.malformed > 500)
        watcher = bench.client("stops", 1)
        assert watcher.stdout is not None
        assert float(watcher.stdout.readline()) > 0
        bench.until_rest()
        wait_until(lambda: bench.door.counts.malformed >= 3000)
        assert_at_rest_in_time(bench)
