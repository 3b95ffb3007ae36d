"""A third party on the bus sees what host and gimbal say, counts the rest, and says nothing itself."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import uuid
from collections.abc import Iterator

import can
import pytest
from command import TELEOP, running, teleop
from network import own_network
from waiting import DEADLINE, wait_until

from teleop.cli import run
from teleop.cli.codec.format_message import in_units, line
from teleop.cli.monitor import Tap, Watch
from teleop.dji.frame import Frame, pieces
from teleop.dji.gimbal import focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import Session
from teleop.dji.json_record import restore
from teleop.dji.message import Message, Result, ReturnCode
from teleop.links import ClosableLink, LinkUrlError, open_link, open_listener
from teleop.links.can import GIMBAL_ID, HOST_ID

MULTICAST = "239.74.163.2"


class Bus:
    """A CAN bus with a host, a gimbal, a stranger, and somebody who watches."""

    def __init__(self, capsys: pytest.CaptureFixture[str], as_json: bool) -> None:
        self.channel = str(uuid.uuid4())
        url = f"virtual:{self.channel}"
        self.host: ClosableLink = open_link(url, now=lambda: 0.0)
        self.gimbal: ClosableLink = open_link(url, host=False, now=lambda: 0.0)
        self.listener = open_listener(url, now=lambda: 0.0)
        directions = {HOST_ID: "to gimbal", GIMBAL_ID: "from gimbal"}
        self.watch = Watch(self.listener, Tap(url, "gimbal", R_SDK, directions), as_json)
        self.session, self.far = Session(), Session()
        self._stranger = can.Bus(self.channel, interface="virtual", ignore_config=True)
        self._capsys = capsys

    def exchange(self, request: Message, reply: Message, bare: bool = False) -> None:
        frame, _ = self.session.request(request, 0.0)
        self.host.send(frame)
        [received] = self.far.receive(self.gimbal.receive(), 0.0)
        self.gimbal.send(self.far.reply(received.frame, reply, bare))

    def stray(self, can_id: int, data: bytes = b"duml", extended: bool = False) -> None:
        self._stranger.send(can.Message(arbitration_id=can_id, is_extended_id=extended, data=data))

    def lines(self, time: float = 1.0) -> list[str]:
        """What has been told by `time`."""
        self.watch.look(time)
        return self._capsys.readouterr().out.splitlines()

    def close(self) -> None:
        for each in (self.host, self.gimbal, self.listener):
            each.close()
        self._stranger.shutdown()


@pytest.fixture(params=[False, True], ids=["text", "json"])
def bus(request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str]) -> Iterator[Bus]:
    bus = Bus(capsys, request.param)
    yield bus
    bus.close()


text = pytest.mark.parametrize("bus", [False], indirect=True)
as_json = pytest.mark.parametrize("bus", [True], indirect=True)


@text
def test_both_directions_in_units_in_the_order_of_the_bus(bus: Bus) -> None:
    bus.exchange(gimbal.Position(10, 0, -5.5), Result())
    bus.exchange(gimbal.Angles(), gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 12.3, 0.0, -5.5))
    bus.gimbal.send(bus.far.command(gimbal.Calibration(gimbal.CalibrationState.RUNNING, 40)))
    assert bus.lines(1.0) == [
        "    1.000 -> gimbal.position, yaw 10 deg, roll 0 deg, pitch -5.5 deg, absolute true, yaw_ignored false, "
        "roll_ignored false, pitch_ignored false, time_for_action 2 s",
        "    1.000 <- gimbal.position reply, return_code ok",
        "    1.000 -> gimbal.angles, kind attitude",
        "    1.000 <- gimbal.angles reply, return_code ok, kind attitude, yaw 12.3 deg, roll 0 deg, pitch -5.5 deg",
        "    1.000 <- gimbal.calibration, state running, progress 40 %, error 0",
    ]
    assert bus.lines(2.0) == []


@as_json
def test_json_is_the_line_of_decode_with_time_and_direction(bus: Bus) -> None:
    bus.exchange(focus.Get(), focus.GetReply(0, 0, focus.EndpointState.CALIBRATED, 7), bare=True)
    asked, answered = map(json.loads, bus.lines(1.25))
    assert list(asked) == ["time", "direction", "message", "reply", "cmd_type", "sequence", "fields"]
    assert (asked["time"], asked["direction"]) == (1.25, "to gimbal")
    assert (answered["direction"], answered["message"], answered["bare"]) == ("from gimbal", "focus.get", True)
    for record in (asked, answered):
        del record["time"], record["direction"]
    assert restore(R_SDK, asked) == Session().command(focus.Get())


@text
def test_damage_is_told_and_what_is_behind_it_survives(bus: Bus) -> None:
    whole = bus.session.command(gimbal.Limits())
    bus.host.send(whole[:9])
    assert bus.lines(1.0) == []
    bus.host.send(whole)
    assert bus.lines(1.05) == [
        f"    1.050 -> damage: header CRC-16 is wrong: {whole[:9].hex()}",
        "    1.050 -> gimbal.limits, operation execute",
    ]
    bus.gimbal.send(whole[:9])
    assert bus.lines(2.0) == []
    assert bus.lines(2.2) == [f"    2.200 <- damage: incomplete frame: {whole[:9].hex()}"]


@text
def test_other_ids_are_counted_and_not_shown(bus: Bus) -> None:
    for can_id, times in ((0x530, 3), (0x426, 2), (0x100, 1), (0x101, 1), (0x102, 1), (0x103, 1), (0x104, 1)):
        for _ in range(times):
            bus.stray(can_id)
    bus.exchange(gimbal.Limits(), Result(ReturnCode.FAILED))
    bus.stray(0x222, extended=True)
    assert len(bus.lines()) == 2
    assert bus.watch.summary() == (
        "1 frames to the gimbal, 1 from it, 0 damaged, 11 of other ids "
        "(0x530 3, 0x426 2, 0x100 1, 0x101 1, 0x102 1, 3 more ids)"
    )


@text
def test_it_transmits_nothing(bus: Bus) -> None:
    with can.Bus(bus.channel, interface="virtual", ignore_config=True) as third:
        bus.exchange(gimbal.Limits(), Result())
        bus.stray(0x530)
        assert len(bus.lines()) == 2
        bus.listener.close()
        on_the_bus = [message.arbitration_id for message in iter(lambda: third.recv(timeout=0), None)]
    assert on_the_bus == [HOST_ID] * 3 + [GIMBAL_ID] * 3 + [0x530]


@pytest.mark.parametrize(
    ("record", "fields"),
    [
        ({"message": "x", "reply": False, "fields": {"yaw": 1.0}}, {"yaw": "1"}),
        ({"message": "gimbal.angles", "reply": True, "fields": {"yaw": 0.1 + 0.2}}, {"yaw": "0.3 deg"}),
        ({"message": "gimbal.parameters", "reply": False, "fields": {"ids": ["motor", 20]}}, {"ids": "motor,20"}),
        ({"message": "gimbal.parameters", "reply": False, "fields": {"ids": []}}, {"ids": "none"}),
        (
            {
                "message": "gimbal.set_parameters",
                "reply": False,
                "fields": {"parameters": [{"id": 20, "value": "0500"}]},
            },
            {"parameters": "20:0500"},
        ),
    ],
)
def test_fields_as_people_read_them(record: dict, fields: dict[str, str]) -> None:
    assert in_units(record) == fields


def test_a_frame_that_nobody_describes_is_shown_in_hexadecimal() -> None:
    record = {
        "time": 0.0,
        "direction": "from gimbal",
        "message": "gimbal.0x77",
        "reply": False,
        "fields": {"value": "00"},
    }
    assert line(record) == "    0.000 <- gimbal.0x77, value 00"


@pytest.mark.parametrize(
    ("link", "said"),
    [
        ([], "there is nothing to monitor on sim: (simulated): --link gimbal=socketcan:can0 names one"),
        (["drone"], "Simulated rig has no link 'drone'; it has "),
        (["--seconds", "0"], 'teleop: Invalid value "0.0" for --seconds. Must be > 0.'),
    ],
)
def test_where_there_is_no_bus_there_is_nothing_to_monitor(
    link: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["monitor", *link]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith(said)
    assert printed.err.count("\n") == 1


def test_what_is_simulated_cannot_be_listened_on() -> None:
    with pytest.raises(LinkUrlError, match="is simulated in each process: there is nothing to listen on"):
        open_listener("sim:", now=lambda: 0.0)


def test_it_ends_after_its_seconds(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["monitor", "--link", f"gimbal=virtual:{uuid.uuid4()}", "--seconds", "0.01"]) == 0
    assert capsys.readouterr().err.splitlines()[1] == ("0 frames to the gimbal, 0 from it, 0 damaged, 0 of other ids")


@pytest.fixture(scope="module")
def network() -> Iterator[str]:
    with own_network("link set lo up", "route add 239.0.0.0/8 dev lo"):
        yield f"gimbal=udp_multicast:{MULTICAST}"


def test_two_other_processes_are_overheard_until_ctrl_c(network: str) -> None:
    with running("sim", "--link", network) as far, running("monitor", "--link", network, "--json") as watching:
        assert far.stdout is not None
        assert watching.stderr is not None
        far.stdout.readline()
        assert "listening on udp_multicast:239.74.163.2" in watching.stderr.readline()
        assert teleop("send", "limits", "--link", network).returncode == 0
        assert watching.stdout is not None
        asked, answered = (json.loads(watching.stdout.readline()) for _ in range(2))
        assert [asked["direction"], answered["direction"]] == ["to gimbal", "from gimbal"]
        assert answered["fields"]["pitch_max"] == 145
        watching.send_signal(signal.SIGINT)
        _, said = watching.communicate(timeout=DEADLINE)
        assert watching.returncode == 130
        assert said.startswith("1 frames to the gimbal, 1 from it, 0 damaged, 0 of other ids")


def test_a_terminal_has_a_status_line(network: str) -> None:
    terminal, its_end = os.openpty()
    command = [TELEOP, "monitor", "--link", network]
    watching = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=its_end)
    seen = bytearray()

    def shows(text: bytes) -> bool:
        if select.select([terminal], [], [], 0.1)[0]:
            seen.extend(os.read(terminal, 4096))
        return text in seen

    try:
        wait_until(lambda: shows(b"0 of other ids"), "a status line")
        with can.Bus(MULTICAST, interface="udp_multicast", ignore_config=True, fd=False) as stranger:
            stranger.send(can.Message(arbitration_id=0x530, is_extended_id=False, data=b"duml"))
        wait_until(lambda: shows(b"1 of other ids (0x530 1)"), "a status line with the stranger")
        watching.terminate()
        assert watching.wait(timeout=DEADLINE) == 130
    finally:
        watching.kill()
        watching.wait()
        os.close(terminal)
        os.close(its_end)


@text
def test_what_other_clients_do_is_shown_and_is_no_damage(bus: Bus) -> None:
    """Last CAN frames filled up, empty ones, a number that never changes, pushes with the reply bit, foreign ids."""
    for piece in pieces(Frame(bytes.fromhex("0e02 01"), 0x03, 7).encode()):
        bus.stray(HOST_ID, piece.ljust(8, b"\xaa"))
        bus.stray(HOST_ID, b"")
        bus.stray(0x530)
    for piece in pieces(Frame(bytes.fromhex("0e06"), 0x03, 7).encode()):
        bus.stray(HOST_ID, piece.ljust(8, b"\0"))
        bus.stray(0x426)
    for data in ("0e02 00 01 0a00 0000 0000", "0e08 01 0a00 1400 1e00", "0e08 01 0a"):
        bus.gimbal.send(Frame(bytes.fromhex(data), 0x20, 7).encode())
    assert bus.lines(1.0) == [
        "    1.000 -> gimbal.angles, kind attitude",
        "    1.000 -> gimbal.stiffness, operation absent",
        "    1.000 <- gimbal.angles reply, return_code ok, kind attitude, yaw 1 deg, roll 0 deg, pitch 0 deg",
        "    1.000 <- gimbal.short_push reply, angles_valid true, limits_valid false, stiffness_valid false, yaw 1 deg,"
        " roll 2 deg, pitch 3 deg",
        "    1.000 <- gimbal.push reply, value 010a",
    ]
    summary = bus.watch.summary()
    assert "2 frames to the gimbal, 3 from it, 0 damaged, 6 of other ids (" in summary
    assert "0x530 3" in summary
    assert "0x426 3" in summary
    assert "2 padded" in summary
