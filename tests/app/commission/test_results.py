"""The files of a commissioning: page, report and capture; what is left out of them; and when nothing is left behind."""

from __future__ import annotations

import uuid
from dataclasses import replace
from pathlib import Path

import pytest
from made_findings import FOUND, UPDATED

from teleop.app.commission.results import LARGEST, Results, change_lines, default_folder, read_report
from teleop.captures.captured import FROM_DEVICE, TO_DEVICE
from teleop.captures.reader import read
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.dji.drone import messages as drone
from teleop.dji.drone.session import OnboardSession
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.links import open_link, parse
from teleop.links.can import GIMBAL_ID, HOST_ID
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.link import SimLink


def test_a_simulated_gimbal_leaves_page_report_and_capture(tmp_path: Path) -> None:
    clock = VirtualClock(10.0)
    with Results(tmp_path / "out", parse("sim:"), "gimbal", clock.now) as results:
        link = results.tap(SimLink(SimulatedGimbal(), clock.now))
        link.send(Session().request(gimbal.Version(), clock.now())[0])
        assert link.receive()
        files = results.write(FOUND)
    assert [file.name for file in files] == ["report.html", "report.json", "capture.log"]
    assert read_report(files[1]) == replace(FOUND, serials={})
    captured = [(source.interface, frame.id) for source, frame in read(files[2])]
    assert captured == [("sim", HOST_ID)] * 3 + [("sim", GIMBAL_ID)] * 4
    assert all("0M6CH7R0A1B2C3" not in file.read_text() for file in files)


def test_serial_numbers_are_kept_when_asked_for(tmp_path: Path) -> None:
    with Results(tmp_path / "out", parse("sim:"), "gimbal", VirtualClock().now, serials=True) as results:
        files = results.write(FOUND)
    assert all("0M6CH7R0A1B2C3" in file.read_text() for file in files[:2])
    assert results.summary.endswith("with serial numbers")


def test_a_real_bus_is_tapped_where_it_is(tmp_path: Path) -> None:
    url = f"virtual:{uuid.uuid4()}"
    clock = VirtualClock()
    near, far = open_link(url, now=clock.now), open_link(url, host=False, now=clock.now)
    with Results(tmp_path / "out", parse(url), "gimbal", clock.now) as results:
        assert results.tap(near) is near
        near.send(b"01234567ab")
        far.send(b"xyz")
        assert near.receive() == b"xyz"
        results.write(FOUND)
    assert [(frame.id, frame.data) for _, frame in read(results.capture)] == [
        (HOST_ID, b"01234567"),
        (HOST_ID, b"ab"),
        (GIMBAL_ID, b"xyz"),
    ]
    near.close()
    far.close()


def test_a_drone_is_captured_as_a_serial_line_without_its_id_and_the_app(tmp_path: Path) -> None:
    clock = VirtualClock(1.0)
    with Results(tmp_path / "out", parse("sim:"), "drone", clock.now) as results:
        link, session = results.tap(SimLink(SimulatedDrone(now=0.0), clock.now)), OnboardSession()
        for message in (drone.Version(), drone.Activate(1030093)):
            link.send(session.request(message, clock.now())[0])
        link.receive()
        results.write(replace(FOUND, device="drone"))
    assert results.capture.name == "capture.mcap"
    captured = [frame for _, frame in read(results.capture)]
    assert {frame.id for frame in captured} == {TO_DEVICE, FROM_DEVICE}
    data = b"".join(frame.data for frame in captured)
    assert b"041D492163" not in data
    assert (1030093).to_bytes(4, "little") not in data
    assert b"SDK-v1.0 BETA M100" in data


def test_without_a_report_nothing_is_left_behind(tmp_path: Path) -> None:
    with Results(tmp_path / "out", parse("sim:"), "gimbal", VirtualClock().now):
        pass
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_there_is_kept(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="already exists; choose another folder"):
        Results(tmp_path, parse("sim:"), "gimbal", VirtualClock().now)


def test_an_earlier_report_of_another_device_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="the earlier report is of a drone, not of a gimbal"):
        Results(tmp_path / "x", parse("sim:"), "gimbal", VirtualClock().now, before=replace(FOUND, device="drone"))
    assert not (tmp_path / "x").exists()


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"format": "teleop findings 1"}', '{"format": "x"}', "\0"])
def test_a_file_that_is_no_report_is_refused_in_a_line(tmp_path: Path, text: str) -> None:
    file = tmp_path / "report.json"
    file.write_text(text)
    with pytest.raises(UsageError) as refused:
        read_report(file)
    assert str(refused.value).startswith(f"{file}: not a report of teleop commission: ")
    with pytest.raises(UsageError, match="cannot be read: No such file"):
        read_report(tmp_path / "none.json")
    file.write_bytes(b"\xff")
    with pytest.raises(UsageError, match="cannot be read: 'utf-8' codec"):
        read_report(file)
    file.write_text(" " * (LARGEST + 1))
    with pytest.raises(UsageError, match="is larger than 4 MB"):
        read_report(file)


def test_changes_as_lines() -> None:
    assert change_lines(FOUND, UPDATED) == [
        "firmware: 03.01.00.10 -> 04.00.00.00",
        "Sign of pan in speed commands (0E 01): -1 -> 1",
        "A focus motor answers <0E 12>: not seen -> yes",
        "Limit of the gimbal: pitch max: 145 deg -> not seen",
    ]
    assert change_lines(FOUND, FOUND) == ["nothing changed"]


def test_a_folder_is_named_by_rig_and_time() -> None:
    assert str(default_folder("DJI RS 3 Pro")).startswith("commission-dji-rs-3-pro-20")
