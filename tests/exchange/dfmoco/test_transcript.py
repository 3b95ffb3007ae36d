"""The maker's firmware, as it was recorded, beside a real run of ours with a simulated gimbal on its wire."""

from __future__ import annotations

import re
import socket
import time
from ast import literal_eval
from collections.abc import Iterator
from pathlib import Path

import pytest
from page_bench import until
from real_console import RealConsole
from real_exchange import free_port, real_exchange

TRANSCRIPT = Path(__file__).parents[2] / "data" / "exchange" / "dfmoco.txt"
SAID = re.compile(r"> '(?P<sent>[^']*)' +< (?P<answers>\[.*\])")
LAST = {"mm 1 600": "mp 1 600", "bf 1000 500 1 0 100 200": "mp 1 0", "go": "mp 1 200", "zm 2": "mp 2 0"}
"""The last position that the firmware sends after a command."""
ALSO = {"sm": 2}  # answers that come at once, where it is not one


class Dragonframe:
    """A connection; `lines` are all that came."""

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port))
        self._socket.settimeout(0.02)
        self._rest = b""
        self.lines: list[str] = []

    def close(self) -> None:
        self._socket.close()

    def send(self, line: str, end: str = "\r\n") -> int:
        """How many lines there were before."""
        self._hear()
        self._socket.sendall((line + end).encode())
        return len(self.lines)

    def _hear(self) -> None:
        try:
            self._rest += self._socket.recv(65536)
        except TimeoutError:
            return
        *whole, self._rest = self._rest.split(b"\r\n")
        self.lines += [line.decode() for line in whole]

    def ask(self, line: str) -> list[str]:
        """Its direct answer: unasked positions that come before it are left out."""
        start = self.send(line)
        motor = line.split()[1] if " " in line else ""

        def found() -> list[str] | None:
            self._hear()
            return [each for each in self.lines[start:] if each.startswith((line[:2], f"mp {motor} ", "parse"))][:1]

        return until(found)

    def rests(self) -> None:
        until(lambda: self.ask("ms") == ["ms 0000"])

    def newest(self, motor: int) -> str:
        self._hear()
        return next((line for line in reversed(self.lines) if line.startswith(f"mp {motor} ")), "")


def await_newest(dragonframe: Dragonframe, line: str) -> None:
    until(lambda: dragonframe.newest(int(line[3])) == line)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[RealConsole, int]]:
    port = free_port()
    with real_exchange(
        tmp_path_factory.mktemp("dfmoco"), f"{{type: dfmoco, listen: 'tcp:127.0.0.1:{port}'}}"
    ) as console:
        yield console, port


@pytest.fixture
def dragonframe(rig: tuple[RealConsole, int]) -> Iterator[Dragonframe]:
    client = Dragonframe(rig[1])
    yield client
    client.close()


def test_every_command_of_the_transcript_is_answered_as_the_firmware_did(dragonframe: Dragonframe) -> None:
    said = [match.groupdict() for match in SAID.finditer(TRANSCRIPT.read_text())]
    assert len(said) > 20
    for each in said:
        recorded = [text for _, text in literal_eval(each["answers"])]
        direct = recorded[: ALSO.get(each["sent"][:2], 1)]
        if each["sent"].startswith("sm"):
            start = dragonframe.send(each["sent"])
            until(lambda: direct[0] in dragonframe.lines[start:-1] or dragonframe._hear())  # noqa: B023
            assert re.fullmatch(r"mp 3 \d+", dragonframe.lines[dragonframe.lines.index(direct[0], start) + 1])
        elif direct:
            assert dragonframe.ask(each["sent"]) == direct, each
        else:
            dragonframe.send(each["sent"])
        if each["sent"][:2] == "jm":
            time.sleep(0.3)  # as in the transcript: it is stopped on its way
        else:
            dragonframe.rests()
        if last := LAST.get(each["sent"]):
            await_newest(dragonframe, last)


def test_positions_come_unasked_while_it_moves_and_once_at_rest(dragonframe: Dragonframe) -> None:
    dragonframe.ask("pr 2 5000")
    start = dragonframe.send("mm 2 10000")
    await_newest(dragonframe, "mp 2 10000")
    places = [int(line.split()[2]) for line in dragonframe.lines[start:] if line.startswith("mp 2")]
    assert places == sorted(places)
    assert 3 <= len(places) <= 7  # 2 s at 5 deg/s, every 0.5 s
    dragonframe.ask("mm 2 0")
    dragonframe.rests()


def test_what_is_outside_the_soft_limits_stays(dragonframe: Dragonframe, rig: tuple[RealConsole, int]) -> None:
    assert dragonframe.ask("mm 3 31000") == ["mp 3 " + dragonframe.ask("mp 3")[0].split()[2]]
    assert dragonframe.ask("mm 4 -10") == ["mp 4 0"]  # of focus
    assert dragonframe.ask("bf 1000 500 3 29000 29900 33000") == ["bf -1"]
    assert rig[0].axis("roll")["speed"] == 0
    assert dragonframe.ask("go") == ["parse error"]
    assert any("soft" in each["text"] for each in rig[0].state["messages"])


def test_a_jog_stops_by_itself_and_with_its_connection(rig: tuple[RealConsole, int], dragonframe: Dragonframe) -> None:
    console, port = rig
    dragonframe.ask("np 1 0")
    other = Dragonframe(port)
    other.ask("jm 1 90000")
    other.close()
    until(lambda: console.state["holder"] is None and console.rests)
    dragonframe.rests()
    at = int(dragonframe.ask("mp 1")[0].split()[2])
    assert 0 <= at < 1500
    dragonframe.ask("jm 1 90000")
    until(lambda: dragonframe.ask("ms") == ["ms 1000"])
    dragonframe.rests()
    assert at < int(dragonframe.ask("mp 1")[0].split()[2]) < at + 8000
    dragonframe.ask("mm 1 0")
    dragonframe.rests()


def test_two_are_connected_and_a_stop_is_everybodys(rig: tuple[RealConsole, int], dragonframe: Dragonframe) -> None:
    other = Dragonframe(rig[1])
    assert dragonframe.ask("mm 1 40000") == ["mm 1 40000"]
    assert other.ask("mm 2 5000")[0].startswith("mp 2 ")  # another has control
    assert other.ask("sa") == ["sa"]
    other.rests()
    assert int(other.ask("mp 1")[0].split()[2]) < 40000
    assert not rig[0].state["stopped"]  # it can go on
    dragonframe.ask("mm 1 0")
    dragonframe.rests()
    other.close()


def test_noise_and_a_line_without_end_do_no_harm(dragonframe: Dragonframe) -> None:
    dragonframe._socket.settimeout(5)
    dragonframe._socket.sendall(b"mm 1 " + b"9" * 1_000_000 + b"\r\nxx\r\n\x00\xff\xfe\r\nhi\n")
    dragonframe._socket.settimeout(0.02)
    answers = lambda: [line for line in dragonframe.lines if not line.startswith("mp ")][-2:]  # noqa: E731
    assert until(lambda: answers()[-1:] == ["hi 2 4 2.0.0"] or dragonframe._hear())
    assert answers() == ["parse error", "hi 2 4 2.0.0"]
    assert dragonframe.ask("ms") == ["ms 0000"]
