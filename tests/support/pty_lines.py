"""Serial hardware without hardware: pseudo-terminals with a thread behind them.

`NullModem` is a crossed cable between two ports. `SlcanBus` is a CAN bus with an slcan adapter at each port: it answers
each command as the Lawicel adapters do (CR for done, BEL for not understood) and passes frames on while it is open.
"""

import os
import re
import select
import threading
import tty

_COMMAND = re.compile(rb"[SsOCLYV][0-9A-Fa-f]*|")
_FRAME = re.compile(rb"(?:t([0-9A-F]{3})([0-8])|T([0-9A-F]{8})([0-8])|r([0-9A-F]{3})([0-8]))((?:[0-9A-F]{2})*)")


class PtyPair:
    """Two serial ports, `ports[0]` and `ports[1]`; `handle` decides what becomes of what is written to one of them."""

    def __init__(self) -> None:
        self._masters: list[int] = []
        self._slaves: list[int] = []
        self.ports: list[str] = []
        for _ in range(2):
            master, slave = os.openpty()
            tty.setraw(slave)  # before anybody opens it: an echo would come back as received
            self._masters.append(master)
            self._slaves.append(slave)
            self.ports.append(os.ttyname(slave))
        self._wake_read, self._wake_write = os.pipe()
        self._frozen = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def handle(self, side: int, data: bytes) -> None:
        raise NotImplementedError

    def write(self, side: int, data: bytes) -> None:
        """Hands bytes to whoever has the port of this side open."""
        while data:
            data = data[os.write(self._masters[side], data) :]

    def freeze(self) -> None:
        """The firmware hangs: what is written from now on is read by nobody."""
        os.write(self._wake_write, b"freeze")
        self._frozen.wait()

    def close(self) -> None:
        """Both adapters are unplugged: their ports hang up."""
        if self._masters:
            os.write(self._wake_write, b"stop")
            self._thread.join()
            for descriptor in (*self._masters, *self._slaves, self._wake_read, self._wake_write):
                os.close(descriptor)
            self._masters = []

    def _run(self) -> None:
        watched = list(self._masters)
        while True:
            ready, _, _ = select.select([self._wake_read, *watched], [], [])
            if self._wake_read in ready:
                if os.read(self._wake_read, 16) != b"freeze":
                    return
                watched.clear()
                self._frozen.set()
                continue
            for master in ready:
                self.handle(self._masters.index(master), os.read(master, 4096))


class NullModem(PtyPair):
    def handle(self, side: int, data: bytes) -> None:
        self.write(1 - side, data)


class SlcanBus(PtyPair):
    def __init__(self) -> None:
        self._lines = [bytearray(), bytearray()]
        self.commands: list[bytes] = []
        super().__init__()

    def handle(self, side: int, data: bytes) -> None:
        self._lines[side] += data
        while (end := self._lines[side].find(b"\r")) >= 0:
            line = bytes(self._lines[side][:end])
            del self._lines[side][: end + 1]
            self._obey(side, line)

    def _obey(self, side: int, line: bytes) -> None:
        if (match := _FRAME.fullmatch(line)) and len(match[7]) == (0 if match[5] else 2 * int(match[2] or match[4])):
            self.write(1 - side, line + b"\r")
            self.write(side, b"z\r")
        elif _COMMAND.fullmatch(line):
            self.commands.append(line)
            self.write(side, b"\r")
        else:
            self.write(side, b"\a")
