"""DFMoco over TCP or a serial line: every line is answered in its turn, and all who are connected hear what moves."""

from __future__ import annotations

import asyncio
import itertools
import socket
from collections.abc import Callable, Sequence
from contextlib import suppress

from teleop.config.exchange.address import is_allowed
from teleop.config.exchange.dfmoco import DfmocoSection, serial_line
from teleop.core.errors import DeviceError
from teleop.exchange.client import Client
from teleop.exchange.dfmoco.controller import Controller
from teleop.exchange.dfmoco.lines import END, LineReader
from teleop.exchange.dfmoco.motors import motors_of
from teleop.exchange.served import Served
from teleop.links.serial import SerialPort

EVERY = 0.5  # s between two unasked words about what moves
MOST = 8  # connections at a time
READ = 4096  # bytes
UNTAKEN = 256  # reads of a serial line that wait for their turn
WAITING = 65536  # bytes that a peer may leave unread before it is told no more than it asks for


async def serve(section: DfmocoSection, served: Served) -> None:
    """Serve until cancelled. Raises DeviceError where the serial line cannot be opened, or is gone."""
    controller = Controller(served, motors_of(section, served.rig.moved), served.notify)
    line = serial_line(section.listen)
    if line is not None:
        await _serve_serial(controller, served, *line)
        return
    peers = Connections(controller, served, section.allow)
    server = await asyncio.start_server(peers.connected, sock=_copy(served.listener), limit=READ)
    try:
        while True:
            await asyncio.sleep(EVERY)
            peers.tell(controller.due())
    finally:
        server.close()
        peers.close()


def _copy(listener: socket.socket | None) -> socket.socket:
    """The server closes its own."""
    assert listener is not None, "a TCP entry has a listener"
    return listener.dup()


class Connections:
    """Those who are connected over TCP."""

    def __init__(self, controller: Controller, served: Served, allow: list[str]) -> None:
        self._controller, self._served, self._allow = controller, served, allow
        self._writers: set[asyncio.StreamWriter] = set()
        self._numbers = itertools.count(1)

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        host = writer.get_extra_info("peername")[0]
        if len(self._writers) >= MOST:
            writer.close()
            return
        self._writers.add(writer)
        writer.get_extra_info("socket").setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        client = Client(self._served.door, f"DFMoco {host}", self._served.notify, is_allowed(host, self._allow))
        lines = LineReader()
        try:
            with suppress(ConnectionError, TimeoutError):
                while data := await reader.read(READ):
                    for line in lines.feed(data):
                        writer.write(_sent(await self._controller.do(client, line)))
                        await writer.drain()
        finally:
            self._writers.discard(writer)
            writer.close()
            await self._controller.gone(client)

    def tell(self, answers: Sequence[str]) -> None:
        for writer in self._writers:
            if answers and writer.transport.get_write_buffer_size() < WAITING:
                writer.write(_sent(answers))

    def close(self) -> None:
        for writer in self._writers:
            writer.close()


def _sent(answers: Sequence[str]) -> bytes:
    return "".join(f"{answer}{END}" for answer in answers).encode()


class SerialLine:
    """A serial line in the event loop. `lost` is done when the line is."""

    def __init__(self, port: SerialPort, descriptor: int, take: Callable[[bytes], object]) -> None:
        self._port, self._descriptor, self._take = port, descriptor, take
        self._loop = asyncio.get_running_loop()
        self._unsent = b""
        self.lost: asyncio.Future[None] = self._loop.create_future()
        self._loop.add_reader(descriptor, self._read)

    def write(self, data: bytes) -> None:
        """What the line does not take is sent later; what is far too much is dropped."""
        if data and len(self._unsent) < WAITING:
            self._unsent += data
            self._flush()

    def close(self) -> None:
        self._loop.remove_reader(self._descriptor)
        self._port.close()

    def _flush(self) -> None:
        if self.lost.done():
            return
        try:
            self._unsent = self._unsent[self._port.write(self._unsent) :]
        except OSError as error:
            self._lose(error)
            return
        if self._unsent:
            self._loop.call_later(0.01, self._flush)

    def _read(self) -> None:
        try:
            data = self._port.read()
        except OSError as error:
            self._lose(error)
            return
        if data:
            self._take(data)

    def _lose(self, error: OSError) -> None:
        self._loop.remove_reader(self._descriptor)
        if not self.lost.done():
            self.lost.set_exception(error)


async def _serve_serial(controller: Controller, served: Served, device: str, baud: int) -> None:
    arrived: asyncio.Queue[bytes] = asyncio.Queue(UNTAKEN)

    def take(data: bytes) -> None:
        with suppress(asyncio.QueueFull):  # a peer that does not wait for answers
            arrived.put_nowait(data)

    try:
        port = SerialPort(device, baud)
    except (OSError, ValueError) as error:
        raise DeviceError(f"{device}: {error}") from None
    line = SerialLine(port, port.fileno(), take)
    client = Client(served.door, f"DFMoco {device}", served.notify)
    loop = asyncio.get_running_loop()
    tasks = [
        loop.create_task(_answer(controller, client, line, arrived)),
        loop.create_task(_tell(controller, line)),
    ]
    try:
        await line.lost
    except OSError as error:
        raise DeviceError(f"{device}: {error.strerror or error}") from None
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        line.close()
        await controller.gone(client)


async def _answer(controller: Controller, client: Client, line: SerialLine, arrived: asyncio.Queue[bytes]) -> None:
    lines = LineReader()
    while True:
        for command in lines.feed(await arrived.get()):
            line.write(_sent(await controller.do(client, command)))


async def _tell(controller: Controller, line: SerialLine) -> None:
    while True:
        await asyncio.sleep(EVERY)
        line.write(_sent(controller.due()))
