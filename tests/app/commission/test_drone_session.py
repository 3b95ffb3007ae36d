"""A drone's commissioning from its profile to its results, on the virtual clock."""

from __future__ import annotations

from pathlib import Path

import pytest
from drone_commission_bench import DroneOperator

from teleop.app.commission.drone_session import DroneCommissioning
from teleop.app.commission.results import Results
from teleop.captures.reader import read
from teleop.config.profile import load_profile
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError


def test_page_report_and_capture_of_a_drone_have_no_serial_number(tmp_path: Path) -> None:
    clock = VirtualClock(100.0)
    results: list[Results] = []

    def tapped(address):
        results.append(Results(tmp_path / "out", address, "drone", clock.now))
        return results[0].tap

    with DroneCommissioning(load_profile("sim-drone"), clock, tapped=tapped) as made:
        assert made.link.simulated
        operator = DroneOperator(made.link.simulated)
        operator.skips = lambda page: page.key in ("signs", "fields")
        while not made.runner.over:
            assert clock.now() < 300.0
            made.runner.turn(clock.now(), operator.keys(made.runner.page, clock.now()))
            clock.sleep_until(clock.now() + 0.01)
    with results[0]:
        files = results[0].write(made.findings)
    assert made.findings.serials == {"drone": "041D492163"}
    assert (made.findings.model, made.findings.firmware) == ("Matrice 100", "SDK-v1.0 BETA M100-03.01.01.00")
    assert [file.name for file in files] == ["report.html", "report.json", "capture.mcap"]
    assert all(b"041D492163" not in file.read_bytes() for file in files)
    assert b"041D492163".hex().encode() not in files[2].read_bytes()
    assert {source.device for source, _ in read(files[2])} == {"drone"}


def test_a_rig_without_a_drone_is_refused() -> None:
    with pytest.raises(UsageError, match="has no drone"):
        DroneCommissioning(load_profile("sim"), VirtualClock())
