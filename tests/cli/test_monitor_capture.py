"""`teleop monitor -o`: all traffic of a link in a file that others read, whole whenever it ends."""

from __future__ import annotations

import itertools
import signal
import uuid
from collections.abc import Iterator
from pathlib import Path

import can
import pytest
from command import running
from far_drone import far_drone
from network import own_network
from waiting import DEADLINE, wait_until

from teleop.captures.captured import FROM_DEVICE, Captured
from teleop.captures.reader import read
from teleop.cli import run
from teleop.cli.capture_options import CaptureOptions, capturing
from teleop.cli.monitored_link import Tap
from teleop.dji.frame import Frame, FrameReader
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import Session
from teleop.links import open_link
from teleop.links.can import GIMBAL_ID, HOST_ID, CanLink

NUMBER = b"0M6CH7R0A1B2C3"


class Bus:
    """A bus with a host, a gimbal with a serial number, a stranger, and a capture of it."""

    def __init__(self, file: Path, *, serial: bool = False, overwrite: bool = False) -> None:
        url = f"virtual:{uuid.uuid4()}"
        self.now = 100.0
        tapped = Tap(url, "gimbal", R_SDK, {HOST_ID: "to gimbal", GIMBAL_ID: "from gimbal"})
        self.file = file
        self._capture = capturing(CaptureOptions(file, overwrite, serial), tapped, lambda: self.now)
        self.listener, self.recording = self._capture.__enter__()
        self._host, self._gimbal = open_link(url, now=lambda: 0.0), open_link(url, host=False, now=lambda: 0.0)
        self._stranger = can.Bus(url.partition(":")[2], interface="virtual", ignore_config=True)

    def traffic(self) -> None:
        session = Session()
        self._host.send(session.command(gimbal.Version()))
        reply = gimbal.VersionReply(0, 1, "02.02.00.07", extra=NUMBER)
        self._gimbal.send(Frame(reply.data(), 0x20, 0).encode())
        self._stranger.send(can.Message(arbitration_id=0x530, is_extended_id=False, data=b"duml"))
        self._stranger.send(can.Message(arbitration_id=0x18FF1234, is_extended_id=True, data=b"x"))
        self._stranger.send(can.Message(arbitration_id=0x40, is_error_frame=True, data=bytes(8), dlc=8))
        self.listener.receive()
        assert self.recording
        self.recording.look()

    def close(self) -> list[Captured]:
        self._capture.__exit__(None, None, None)
        for each in (self._host, self._gimbal, self.listener):
            each.close()
        self._stranger.shutdown()
        return [frame for _, frame in read(self.file)]


def frames(captured: list[Captured], can_id: int) -> list[Frame]:
    found = FrameReader(in_pieces=True).feed(b"".join(each.data for each in captured if each.id == can_id), 0.0)
    return [each for each in found if isinstance(each, Frame)]


@pytest.mark.parametrize("ending", [".log", ".mcap"])
def test_all_of_the_bus_is_in_the_file_in_its_order(
    tmp_path: Path, ending: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / f"bus{ending}"
    bus = Bus(file)
    bus.traffic()
    captured = bus.close()
    assert [each.id for each in captured] == [HOST_ID] * 3 + [GIMBAL_ID] * 6 + [0x530, 0x18FF1234, 0x40]
    assert [each.extended for each in captured][-3:] == [False, True, False]
    assert captured[-1].error
    assert [frame.data for frame in frames(captured, HOST_ID)] == [gimbal.Version().data()]
    assert all(before.time <= after.time for before, after in itertools.pairwise(captured))
    assert captured[0].time > 1.6e9
    assert capsys.readouterr().err == f"{file}: 12 frames, 1 serial number blanked (--serial keeps them)\n"


@pytest.mark.parametrize("serial", [False, True])
def test_serial_numbers_are_blanked_unless_asked(tmp_path: Path, serial: bool) -> None:
    bus = Bus(tmp_path / "bus.log", serial=serial)
    bus.traffic()
    [reply] = frames(bus.close(), GIMBAL_ID)
    assert reply.data.endswith(NUMBER if serial else bytes(len(NUMBER)))
    assert reply.data.startswith(gimbal.VersionReply(0, 1, "02.02.00.07").data())


def test_a_listener_hears_the_same_whether_it_records_or_not(tmp_path: Path) -> None:
    bus = Bus(tmp_path / "bus.log")
    bus.traffic()
    assert bus.listener.foreign == {0x530: 1, 0x18FF1234: 1}
    bus.close()


def test_a_link_can_be_tapped_in_both_directions() -> None:
    url = f"virtual:{uuid.uuid4()}"
    host, far = open_link(url, now=lambda: 0.0), open_link(url, host=False, now=lambda: 0.0)
    heard: list[tuple[int, bytes]] = []
    assert isinstance(host, CanLink)
    host.tap = lambda frame: heard.append((frame.id, frame.data))
    host.send(b"0123456789")
    far.send(b"abc")
    assert host.receive() == b"abc"
    assert heard == [(HOST_ID, b"01234567"), (HOST_ID, b"89"), (GIMBAL_ID, b"abc")]
    host.close()
    far.close()


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["-o", "there.log"], "-o there.log: already exists; give --overwrite to replace it"),
        (["-o", "x.asc"], "-o x.asc: its ending must be .log, .candump (candump) or .mcap"),
        (["-o", "no/x.log"], "no/x.log: cannot be written: No such file or directory"),
        (["--serial"], "--overwrite and --serial are about a capture: add -o FILE"),
    ],
)
def test_refused_before_anything_is_opened(
    arguments: list[str],
    error: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("there.log").write_text("mine")
    assert run(["monitor", "--link", "gimbal=virtual:nowhere", "--seconds", "0.01", *arguments]) != 0
    assert capsys.readouterr().err == f"teleop: {error}\n"
    assert Path("there.log").read_text() == "mine"


def test_a_link_that_cannot_be_opened_leaves_the_old_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "old.mcap"
    file.write_text("mine")
    serial = ["--rig", "m100", "--link", f"drone=serial:{tmp_path}/none@230400", "--overwrite"]
    assert run(["monitor", "-o", str(file), *serial]) == 1
    assert file.read_text() == "mine"


def test_a_drone_is_recorded_as_mcap_and_never_as_candump(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "drone.mcap"
    with far_drone() as (_, url):
        monitor = ["monitor", "drone", "--rig", "m100", "--link", f"drone={url}", "--seconds", "0.3"]
        assert run([*monitor, "-o", str(tmp_path / "drone.log")]) == 2
        assert capsys.readouterr().err == (
            f"teleop: -o {tmp_path}/drone.log: candump has CAN frames only; a serial line is recorded as .mcap\n"
        )
        assert run([*monitor, "-o", str(file)]) == 0
    captured = list(read(file))
    assert {(source.kind, source.device, frame.id) for source, frame in captured} == {("serial", "drone", FROM_DEVICE)}
    found = FrameReader().feed(b"".join(frame.data for _, frame in captured), 0.0)
    assert any(isinstance(each, Frame) and each.data[:2] == b"\x02\x00" for each in found)


@pytest.fixture
def network() -> Iterator[str]:
    with own_network("link set lo up multicast on", "route add 224.0.0.0/4 dev lo"):
        yield "239.74.163.2"


@pytest.mark.parametrize("by", [signal.SIGTERM, signal.SIGKILL])
def test_a_process_that_is_ended_leaves_whole_lines(network: str, tmp_path: Path, by: signal.Signals) -> None:
    file = tmp_path / "bus.log"
    with (
        running("monitor", "--link", f"gimbal=udp_multicast:{network}", "-o", str(file)) as monitor,
        can.Bus(network, interface="udp_multicast", ignore_config=True, fd=False) as stranger,
    ):
        wait_until(file.exists, "a capture")
        sent = 0

        def is_recorded() -> bool:
            nonlocal sent
            for _ in range(20):
                stranger.send(can.Message(arbitration_id=0x530, is_extended_id=False, data=sent.to_bytes(4)))
                sent += 1
            return file.stat().st_size > 2000

        wait_until(is_recorded, "frames in it")
        monitor.send_signal(by)
        monitor.communicate(timeout=DEADLINE)
        assert monitor.returncode == (130 if by == signal.SIGTERM else -by)
    text = file.read_bytes()
    assert text.endswith(b"\n")
    with can.CanutilsLogReader(file) as reader:
        numbers = [int.from_bytes(message.data) for message in reader]
    assert numbers == sorted(set(numbers))  # multicast may lose some under load
