"""`teleop sim`: what the simulated devices refuse is printed with the reason, and their settings are options."""

from __future__ import annotations

import json
import os
import signal
import struct
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from subprocess import Popen

import pytest
from command import running, teleop
from cryptography.hazmat.primitives.ciphers import Cipher, algorithms, modes
from onboard_client import ACTIVATE, KEY, OBTAIN, encrypted
from raw_frames import raw_frame
from waiting import wait_until

from teleop.cli.screens.refusal_lines import AGAIN, RefusalLines
from teleop.cli.sim_options import DroneSim, GimbalSim
from teleop.core.errors import UsageError
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.gimbal.foreign_traffic import ForeignTraffic

MOVE = b"\x01\x03" + struct.pack("<Bffff", 0x4B, 0, 0, 0, 0)


class Watched:
    """A drone, and the lines about it."""

    def __init__(self, as_json: bool = False) -> None:
        self.drone = SimulatedDrone()
        self.lines: list[str] = []
        self._refusals = RefusalLines(self.lines.append, as_json)

    def send(self, data: bytes, now: float, times: int = 1) -> None:
        for number in range(times):
            self.drone.receive(raw_frame(data, 0, number), now)
        self._refusals.look("drone", self.drone, now)

    def end(self) -> None:
        self._refusals.summary("drone", self.drone)


def test_each_kind_of_refusal_is_printed_at_once_then_counted_and_summed_up_at_the_end() -> None:
    watched = Watched()
    for step in range(300):
        watched.send(MOVE, 1.0 + step * 0.05)
    watched.send(b"\x05\x00" + bytes(64), 16.0, times=3)
    watched.end()
    counted = int(AGAIN / 0.05)
    assert watched.lines == [
        "drone refused drone.move: not activated",
        f"drone refused drone.move: not activated ({counted} times more)",
        "drone refused drone.virtual_rc: wrong length: 64 bytes, not 1 (3 times)",
        "drone: 303 messages, 303 refused",
        "  drone.move: not activated, 300 x",
        "  drone.virtual_rc: wrong length, 3 x",
    ]


def test_for_programs_each_line_is_an_object() -> None:
    watched = Watched(as_json=True)
    watched.send(b"\x07\x09\x01", 0.0)
    watched.end()
    assert [json.loads(line) for line in watched.lines] == [
        {"device": "drone", "refused": "0x0709", "reason": "unknown command", "detail": "", "count": 1},
        {
            "device": "drone",
            "messages": 1,
            "refused": 1,
            "kinds": [{"command": "0x0709", "reason": "unknown command", "count": 1}],
        },
    ]


def test_a_device_that_refused_nothing_says_so() -> None:
    lines: list[str] = []
    RefusalLines(lines.append, as_json=False).summary("gimbal", SimulatedGimbal())
    assert lines == ["gimbal: 0 messages, none refused"]


@contextmanager
def simulated_drone(*options: str) -> Iterator[tuple[Popen[str], int]]:
    """The process, and its serial line."""
    with running("sim", "--drone", *options) as far:
        assert far.stdout
        ready = far.stdout.readline()
        assert "simulated drone on serial:" in ready
        line = os.open(ready.partition("serial:")[2].partition("@")[0], os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        try:
            yield far, line
        finally:
            os.close(line)


def answers(line: int, count: int) -> list[bytes]:
    """So many acknowledgements of session 2, once they are there; broadcasts are passed over."""
    heard = bytearray()

    def acknowledgements() -> list[bytes]:
        with suppress(BlockingIOError):
            heard.extend(os.read(line, 65536))
        found, at = [], 0
        while (at := heard.find(b"\xaa", at)) >= 0 and len(heard) >= at + 3:
            size = heard[at + 1] | (heard[at + 2] & 3) << 8
            frame = bytes(heard[at : at + size])
            if size >= 12 and len(frame) == size and frame[3] == 0x22:
                found.append(frame[12:-4])
                at += size
            else:
                at += 1
        return found

    wait_until(lambda: len(acknowledgements()) >= count)
    return acknowledgements()


def test_a_client_s_author_sees_why_it_is_not_obeyed(tmp_path: Path) -> None:
    with simulated_drone("--json", "--immediate-control") as (far, line):
        assert far.stdout
        os.write(line, raw_frame(ACTIVATE, 2, 1) + raw_frame(MOVE, 0, 2) + raw_frame(OBTAIN, 2, 3))
        assert answers(line, 2) == [b"\x00\x00", b"\x02\x00"]
        refusal = json.loads(far.stdout.readline())
        assert (refusal["refused"], refusal["reason"]) == ("drone.move", "no control")
        far.send_signal(signal.SIGINT)
        assert far.wait(30) == 130
        assert json.loads(far.stdout.readline())["kinds"] == [
            {"command": "drone.move", "reason": "no control", "count": 1}
        ]


def test_with_a_key_file_what_follows_the_activation_is_encrypted(tmp_path: Path) -> None:
    (tmp_path / "key").write_text(KEY.hex())
    with simulated_drone("--key-file", str(tmp_path / "key")) as (_, line):
        os.write(line, raw_frame(ACTIVATE, 2, 1))
        assert answers(line, 1) == [b"\x00\x00"]
        os.write(line, encrypted(OBTAIN, 2, 2))
        [answer] = answers(line, 1)
        aes = Cipher(algorithms.AES256(KEY), modes.ECB()).decryptor()
        assert aes.update(answer)[:2] == b"\x03\x00"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (("--drone", "--key-file", "nowhere"), "nowhere: No such file or directory"),
        (("--drone", "--answer-delay", "-1"), "--answer-delay must be 0..60 s, not -1"),
        (("--link", "gimbal=udp_multicast:239.74.163.77", "--push-rate", "0"), "--push-rate must be above 0"),
        (("--link", "gimbal=udp_multicast:239.74.163.77", "--speed-signs", "pan=-1"), "write yaw, roll or pitch"),
    ],
)
def test_settings_that_cannot_be_are_refused_in_a_line(arguments: tuple[str, ...], line: str) -> None:
    done = teleop("sim", *arguments)
    assert done.returncode == 2
    assert line in done.stderr
    assert done.stderr.count("\n") == 1


def test_the_options_become_settings(tmp_path: Path) -> None:
    (tmp_path / "key").write_text("00112233445566778899aabbccddeeff0123456789abcdeffedcba9876543210\n")
    made = DroneSim(key_file=tmp_path / "key", answer_delay=0.2, silent_until_activated=True, movement_timeout=0.1)
    drone = made.made(5.0)
    assert not drone.settings.broadcasts_before_activation
    assert (drone.settings.answer_delay, drone.settings.movement_timeout, drone.settings.asks_twice) == (0.2, 0.1, True)
    drone.receive(raw_frame(ACTIVATE, 2, 1), 5.0)
    drone.advance(5.2)
    assert drone.advance(6.0)[4] >> 5 == 1, "encrypted"
    with pytest.raises(UsageError):
        GimbalSim(speed_signs="yaw=2").made()


def test_the_traffic_of_other_ids_is_400_frames_a_second() -> None:
    traffic = ForeignTraffic(10.0)
    frames = [each for step in range(1000) for each in traffic.due(10.0 + step * 0.002)]
    assert len(frames) == pytest.approx(800, abs=2)
    assert {can_id for can_id, _ in frames} == {0x530, 0x531, 0x426}
    assert all(len(data) == 8 for _, data in frames)
    assert len(traffic.due(100.0)) <= 40, "a stalled computer sends no flood afterwards"
