"""DFMoco over a serial line: a pseudo-terminal, at whose other end Dragonframe is."""

from __future__ import annotations

import asyncio
import os
import tty

import pytest
from fake_door import FakeDoor

from teleop.config.exchange import ENTRIES
from teleop.config.exchange.dfmoco import DfmocoSection, serial_line
from teleop.core.axes import Axis, Limits
from teleop.core.errors import DeviceError
from teleop.exchange.dfmoco import server
from teleop.exchange.served import Rig, Served

LIMITS = {axis: Limits(-180.0, 180.0, 60.0, 240.0, 2400.0) for axis in (Axis.PAN, Axis.TILT, Axis.ROLL)}


def served(door: FakeDoor) -> Served:
    return Served(door, Rig("fake", LIMITS, LIMITS), None, print)  # pyright: ignore[reportArgumentType]


async def read_line(descriptor: int) -> bytes:
    data = b""
    while not data.endswith(b"\r\n"):
        try:
            data += os.read(descriptor, 1)
        except BlockingIOError:
            await asyncio.sleep(0.005)
    return data


def test_it_is_answered_over_a_serial_line_and_its_end_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "EVERY", 60.0)
    far, near = os.openpty()
    tty.setraw(near)
    os.set_blocking(far, False)

    async def run() -> None:
        door = FakeDoor()
        (section,) = ENTRIES.validate_python([{"type": "dfmoco", "listen": f"serial:{os.ttyname(near)}@57600"}])
        assert isinstance(section, DfmocoSection)
        task = asyncio.create_task(server.serve(section, served(door)))
        await asyncio.sleep(0)  # it opens the line, which drops what came before
        os.write(far, b"hi\r\nmm 1 5000\r\n")
        assert await read_line(far) == b"hi 2 4 2.0.0\r\n"
        assert await read_line(far) == b"mm 1 5000\r\n"
        assert door.commands[-1][0] == {"do": "goto", "axes": {"pan": 5.0}, "speeds": {"pan": 5.0}}
        os.close(near)
        os.close(far)
        with pytest.raises(DeviceError, match="/dev/"):
            await task
        assert door.closed_sessions

    asyncio.run(asyncio.wait_for(run(), 10))


def test_a_line_that_is_not_there_is_an_error() -> None:
    (section,) = ENTRIES.validate_python([{"type": "dfmoco", "listen": "serial:/dev/no-such-line"}])
    assert isinstance(section, DfmocoSection)
    with pytest.raises(DeviceError, match="/dev/no-such-line"):
        asyncio.run(server.serve(section, served(FakeDoor())))


@pytest.mark.parametrize(
    "listen", ["10001", "tcp:10001", "udp:127.0.0.1:1", "serial:", "serial:/dev/x@fast", "serial:@9600"]
)
def test_what_is_no_place_to_listen_is_refused(listen: str) -> None:
    with pytest.raises(ValueError, match="must"):
        ENTRIES.validate_python([{"type": "dfmoco", "listen": listen}])


def test_the_baud_rate_of_the_firmware_is_the_default() -> None:
    assert serial_line("serial:/dev/ttyUSB0") == ("/dev/ttyUSB0", 57600)
    assert serial_line("tcp:127.0.0.1:10001") is None
