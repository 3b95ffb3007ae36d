"""Refusals of a simulator: each kind at once, then how often from time to time, at the end all."""

from __future__ import annotations

import json

import pytest

from teleop.cli.screens.refusal_lines import AGAIN, RefusalLines
from teleop.sim.gimbal.device import SimulatedGimbal


class Bench:
    """`refuse` sends the gimbal a frame with a command that it does not know."""

    def __init__(self, as_json: bool = False) -> None:
        self.gimbal, self.lines = SimulatedGimbal(), []
        self.report = RefusalLines(self.lines.append, as_json)

    def refuse(self, now: float, times: int = 1) -> None:
        from teleop.dji.frame import Frame

        for number in range(times):
            self.gimbal.receive(Frame(b"\x0e\x7f", 0x03, number).encode(), now)

    def look(self, now: float) -> list[str]:
        self.lines.clear()
        self.report.look("gimbal", self.gimbal, now)
        return list(self.lines)


def test_a_kind_is_told_at_once_and_then_only_from_time_to_time():
    bench = Bench()
    bench.refuse(0.0)
    (line,) = bench.look(0.0)
    assert line.startswith("gimbal refused ")
    assert "times" not in line
    bench.refuse(1.0, times=3)
    assert bench.look(1.0) == []
    (line,) = bench.look(AGAIN)
    assert line.endswith("(3 times more)")
    assert bench.look(3 * AGAIN) == []


def test_several_at_once_are_one_line():
    bench = Bench()
    bench.refuse(0.0, times=4)
    (line,) = bench.look(0.0)
    assert line.endswith("(4 times)")


def test_programs_get_an_object_with_the_count_so_far():
    bench = Bench(as_json=True)
    bench.refuse(0.0, times=2)
    (line,) = bench.look(0.0)
    assert (json.loads(line)["device"], json.loads(line)["count"]) == ("gimbal", 2)
    bench.lines.clear()
    bench.report.summary("gimbal", bench.gimbal)
    (line,) = bench.lines
    assert json.loads(line)["refused"] == 2
    assert json.loads(line)["kinds"][0]["count"] == 2


@pytest.mark.parametrize("times", [0, 3])
def test_the_summary_has_all(times: int):
    bench = Bench()
    bench.refuse(0.0, times)
    bench.report.summary("gimbal", bench.gimbal)
    assert bench.lines[0].endswith(f"{times or 'none'} refused")
    assert len(bench.lines) == 1 + bool(times)
