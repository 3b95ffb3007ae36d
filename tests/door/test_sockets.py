"""The datagrams of the door: answers find their way, and by UDP nothing counts that has not the secret."""

from __future__ import annotations

import os
import socket
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from waiting import wait_until

from teleop.door.sockets import FORCED, LARGEST, SECRET, ClientSocket, CommandSocket, Datagram

ROOT = Path(__file__).parents[2]


@pytest.fixture(params=["", "udp"])
def commands(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[CommandSocket]:
    monkeypatch.setenv(FORCED, request.param)
    made = CommandSocket(str(tmp_path / "door"))
    yield made
    made.close()


def received(commands: CommandSocket) -> list[Datagram]:
    found: list[Datagram] = []
    wait_until(lambda: found.extend(commands.receive(8)) or found, "a datagram")
    return found


def test_a_command_is_answered_to_who_sent_it(commands: CommandSocket, tmp_path: Path) -> None:
    clients = [ClientSocket(str(tmp_path / name), str(tmp_path / "door")) for name in ("one", "two")]
    for number, client in enumerate(clients):
        with pytest.raises(BlockingIOError):
            client.recv(LARGEST)
        client.send(b"x" * (LARGEST - number))
        [datagram] = received(commands)
        assert len(datagram.data) == LARGEST - number
        commands.answer(b"done %d" % number, datagram.address)
    for number, client in enumerate(clients):
        answers: list[bytes] = []
        wait_until(lambda client=client, answers=answers: _took(client, answers), "the answer")
        assert answers == [b"done %d" % number]
        client.close()


def _took(client: object, answers: list[bytes]) -> bool:
    try:
        answers.append(client.recv(LARGEST))  # type: ignore[attr-defined]
    except BlockingIOError:
        return False
    return True


def test_a_client_that_reads_nothing_keeps_no_answer_from_others(commands: CommandSocket, tmp_path: Path) -> None:
    deaf, other = (ClientSocket(str(tmp_path / name), str(tmp_path / "door")) for name in ("deaf", "other"))
    deaf.send(b"the first of many")
    [datagram] = received(commands)
    for _ in range(2000):  # more than the memory of any socket takes
        commands.answer(b"x" * 200, datagram.address)
    other.send(b"stop")
    [datagram] = received(commands)
    commands.answer(b"stopped", datagram.address)
    answers: list[bytes] = []
    wait_until(lambda: _took(other, answers), "the answer")
    assert answers == [b"stopped"]
    for each in (deaf, other):
        each.close()


def test_only_this_user_can_read_where_it_is_and_who_is_gone_disturbs_nobody(
    commands: CommandSocket, tmp_path: Path
) -> None:
    assert stat.S_IMODE(os.stat(tmp_path / "door").st_mode) == 0o600
    gone, stays = (ClientSocket(str(tmp_path / name), str(tmp_path / "door")) for name in ("gone", "stays"))
    gone.send(b"last words")
    [datagram] = received(commands)
    gone.close()
    for _ in range(3):
        commands.answer(b"nobody hears it", datagram.address)
    stays.send(b"hello")
    assert [each.data for each in received(commands)] == [b"hello"]
    stays.close()
    with pytest.raises(OSError):
        ClientSocket(str(tmp_path / "x"), str(tmp_path / "nowhere"))


def test_by_udp_what_has_not_the_secret_is_dropped_and_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FORCED, "udp")
    commands = CommandSocket(str(tmp_path / "door"))
    port, secret = (tmp_path / "door").read_text().split()
    assert len(bytes.fromhex(secret)) == SECRET == 16
    stranger = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    wrong = bytes([bytes.fromhex(secret)[0] ^ 1]) + bytes.fromhex(secret)[1:]
    for data in (b"", b"\x82\xa2do\xa4stop", bytes.fromhex(secret)[:-1], wrong + b"stop", os.urandom(60)):
        stranger.sendto(data, ("127.0.0.1", int(port)))
    client = ClientSocket("", str(tmp_path / "door"))
    client.send(b"stop")
    assert [each.data for each in received(commands)] == [b"stop"]
    assert commands.foreign == 5
    stranger.sendto(b"an answer of nobody", ("127.0.0.1", client._socket.getsockname()[1]))
    with pytest.raises(BlockingIOError):
        client.recv(LARGEST)
    (tmp_path / "door").write_text("5 no secret")
    with pytest.raises(OSError, match="no address of a door"):
        ClientSocket("", str(tmp_path / "door"))
    for each in (commands, client, stranger):
        each.close()


@pytest.mark.timeout(400)
def test_the_door_works_by_udp() -> None:
    """Its tests once more, as on a system without sockets in a folder."""
    names = ("control", "dead_man", "run_hands", "gateway_child")
    files = ["tests/door/test_messages.py", *(f"tests/remote/test_{name}.py" for name in names)]
    found = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-n", "0", "-x", *files],
        cwd=ROOT,
        env={**os.environ, FORCED: "udp"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.returncode == 0, found.stdout[-2000:]
