"""A run's report: an exit code for each end, on stdout for people or as one JSON object."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator

import pytest

from teleop.app.run import RunReport
from teleop.cli.running import print_report, stopped
from teleop.core.axes import Axis, Reading, State
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.monitors.tracking_error import TrackingErrorMonitor

COUNTS = {"gimbal": {"frames_out": 90, "frames_in": 80, "replies": 70, "lost_replies": 2, "damage": 0}}


class Extra:
    def facts(self) -> Iterator[tuple[str, object]]:
        yield "passes", 3

    def print(self) -> None:
        sys.stdout.write("three passes\n")


def report(result: Result, *reasons: str, ticks: int = 100) -> RunReport:
    tracking = TrackingErrorMonitor(lambda: 0.0)
    for number in range(ticks):
        now = number / 100
        tracking.observe(Tick(now, {Axis.PAN: State(now)}, {}, (), {Axis.PAN: Reading(now + 0.25, now)}))
    return RunReport(result, reasons, tracking, COUNTS)


@pytest.mark.parametrize(("result", "code"), [(Result.DONE, 0), (Result.FAILED, 1), (Result.INTERRUPTED, 130)])
@pytest.mark.parametrize("as_json", [True, False])
def test_each_end_has_its_exit_code(result: Result, code: int, as_json: bool, capsys: pytest.CaptureFixture[str]):
    assert print_report(report(result), as_json) == code
    assert stopped(result, ["a reason"], as_json) == code


def test_people_get_reasons_on_stderr_and_only_the_counts_that_are_trouble(capsys: pytest.CaptureFixture[str]):
    print_report(report(Result.FAILED, "the bus is off"), False, [Extra()])
    printed = capsys.readouterr()
    assert printed.err == "teleop: stopped: the bus is off\n"
    assert "gimbal: 2 lost replies\n" in printed.out
    assert printed.out.index("pan") < printed.out.index("three passes") < printed.out.index("gimbal")


def test_a_run_without_readings_has_no_table(capsys: pytest.CaptureFixture[str]):
    print_report(report(Result.FAILED, ticks=0), False)
    assert capsys.readouterr().out == "gimbal: 2 lost replies\n"


def test_programs_get_one_object_and_nothing_else(capsys: pytest.CaptureFixture[str]):
    print_report(report(Result.INTERRUPTED, "Ctrl-C"), True, [Extra()])
    printed = capsys.readouterr()
    facts = json.loads(printed.out)
    assert printed.err == ""
    assert (facts["result"], facts["reasons"], facts["links"], facts["passes"]) == (
        "interrupted",
        ["Ctrl-C"],
        COUNTS,
        3,
    )
    assert facts["axes"]["pan"]["rms"] == pytest.approx(0.25)
    assert "take" not in facts
    assert "drone" not in facts
