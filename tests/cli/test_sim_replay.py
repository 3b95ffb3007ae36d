"""`teleop sim --replay`: what a capture must have, what is printed of it, and what does not go with it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from made_captures import STARTED, MadeCapture

from teleop.captures.captured import FROM_DEVICE, Captured, Source
from teleop.cli import run
from teleop.cli.sim import serve
from teleop.cli.sim_dynamics import DYNAMICS_DEFAULTS
from teleop.cli.sim_options import GIMBAL_DEFAULTS
from teleop.cli.sim_replay import facts, replayed, summary
from teleop.core.clock import VirtualClock
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Received, Session
from teleop.links.memory import pair
from teleop.sim.gimbal.replayed import ReplayedGimbal

VERSION = gimbal.VersionReply(0, 1, "03.01.00.10")
LIMITS = gimbal.LimitsReply(0, 155, 55, 179, 179, 30, 30)
MULTICAST = "gimbal=udp_multicast:239.74.163.9"


def session() -> MadeCapture:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 1)
    made.answer(0.004, VERSION, 1)
    made.ask(1.0, gimbal.Limits(), 2)
    made.answer(1.004, LIMITS, 2)
    for number in range(4):
        made.push(2.0 + number * 0.5, gimbal.ShortPush(True, False, False, 1.0, 0.0, 0.0), number)
    return made


@pytest.mark.parametrize("ending", [".log", ".mcap"])
def test_both_formats_and_what_is_printed_of_them(tmp_path: Path, ending: str) -> None:
    file = session().write(tmp_path / f"bus{ending}")
    learned = replayed(file, GIMBAL_DEFAULTS, DYNAMICS_DEFAULTS)
    assert summary(file, learned) == (
        f"replaying {file}: 3.5 s, 2 requests, 2 replies, version 03.01.00.10, pushes at 2 Hz; "
        "angles are those captured"
    )
    known = json.loads(json.dumps(facts(file, learned)))
    assert (known["version"], known["limits"]["pitch_max"], known["bare_replies"]) == ("03.01.00.10", 155, False)


def test_old_replies_are_named(tmp_path: Path) -> None:
    made = MadeCapture()
    made.ask(0.0, gimbal.Version(), 1)
    made.answer(0.004, VERSION, 1, bare=VERSION.encode())
    file = made.write(tmp_path / "bus.log")
    learned = replayed(file, GIMBAL_DEFAULTS, DYNAMICS_DEFAULTS)
    assert "version 03.01.00.10, replies without set and id;" in summary(file, learned)
    assert learned.names_commands is False


def test_a_capture_of_candump_on_two_buses(tmp_path: Path) -> None:
    """Another bus, other ids, R and T at the ends, and a last line that was cut: only the gimbal's bus counts."""
    file = session().write(tmp_path / "bus.log")
    lines = [f"{line} {'T' if ' 223#' in line else 'R'}" for line in file.read_text().splitlines()]
    others = [line.replace("can0", "can1").replace(" 222#", " 223#") for line in lines]
    text = "\n".join(line for both in zip(lines, others, strict=True) for line in both)
    file.write_text(text + "\n(1732888899.000000) can0 222")
    assert facts(file, replayed(file, GIMBAL_DEFAULTS, DYNAMICS_DEFAULTS))["replies"] == 2


def test_the_host_hears_the_captured_gimbal(tmp_path: Path) -> None:
    """Through `serve`, over a link, on a clock of its own."""
    learned = replayed(session().write(tmp_path / "bus.log"), GIMBAL_DEFAULTS, DYNAMICS_DEFAULTS)
    near, far = pair()
    host, heard = Session(), list[Received]()
    device = ReplayedGimbal(learned)
    for message in (gimbal.Version(), gimbal.Limits()):
        near.send(host.request(message, 0.0)[0])
    device.receive(far.receive(), 5.0)
    for step in range(2500):
        if data := device.advance(5.0 + step * 0.002):
            far.send(data)
            heard += host.receive(near.receive(), 0.0)
    assert [received.message for received in heard if received.request] == [VERSION, LIMITS]
    assert sum(isinstance(received.message, gimbal.ShortPush) for received in heard) == 6


def test_serve_drives_a_replayed_gimbal(tmp_path: Path) -> None:
    import threading

    learned = replayed(session().write(tmp_path / "bus.log"), GIMBAL_DEFAULTS, DYNAMICS_DEFAULTS)
    near, far = pair()
    host, stop = Session(), threading.Event()

    class Clock(VirtualClock):
        def sleep_until(self, time: float) -> None:
            super().sleep_until(time)
            if time > 1.0:
                stop.set()

    near.send(host.request(gimbal.Version(), 0.0)[0])
    serve({"gimbal": far}, {"gimbal": ReplayedGimbal(learned)}, Clock(), stop)  # type: ignore[arg-type]
    assert [received.message for received in host.receive(near.receive(), 0.0)] == [VERSION]


def drone(path: Path) -> Path:
    made = MadeCapture()
    made.frames = [Captured(STARTED, FROM_DEVICE, b"\xaa")]
    return made.write(path, Source("serial", "ttyUSB0", "drone"))


def test_without_gimbal_traffic_it_is_refused_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    host_only, foreign = MadeCapture(), MadeCapture()
    host_only.ask(0.0, gimbal.Version(), 1)
    foreign.send(0.0, 0x530, b"duml")
    empty = tmp_path / "empty.log"
    empty.touch()
    files = [host_only.write(tmp_path / "host.log"), foreign.write(tmp_path / "foreign.mcap"), empty]
    for file in [*files, drone(tmp_path / "drone.mcap")]:
        assert run(["sim", "--replay", str(file), "--link", MULTICAST]) == 2
        expected = f"teleop: {file}: no gimbal traffic: no frame of a gimbal on CAN id 0x222\n"
        assert capsys.readouterr().err == expected


@pytest.mark.parametrize("option", [["--mount", "3"], ["--ignore-speed"], ["--push-rate", "5"], ["--lag", "0.2"]])
def test_what_else_a_gimbal_could_be_does_not_go_with_it(
    option: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = session().write(tmp_path / "bus.log")
    assert run(["sim", "--replay", str(file), "--link", MULTICAST, *option]) == 2
    expected = f"teleop: {option[0]}: not with --replay, which answers as the captured gimbal did\n"
    assert capsys.readouterr().err == expected
