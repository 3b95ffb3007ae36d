"""Hostile packets and lines at a live gateway with an entry of every type.

python tests/benchmarks/hunt_live_gateway.py [COUNT [without-midi]]

COUNT (1e5) of each of OSC, DFMoco, FreeD and OpenTrackIO, and a tenth of it for Foxglove (what is no handshake,
and frames after one), MIDI (at JACK, where there is one), LTC (blocks of sound) and Zenoh (bytes at its port). What
asks for something by the judges of `exchange_fuzz` is left out. Nothing may be raised, nothing may move, the gateway
has to be the same, and its memory is printed.
"""

from __future__ import annotations

import logging
import os
import random
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from exchange_fuzz import MOVING, asks_by_osc, dfmoco_bytes, osc_packet
from jack_server import INSTALLED, JackController, jack_server
from real_exchange import free_port, real_exchange
from tracking_fuzz import freed_message, opentrackio_packet
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

HERE = "127.0.0.1"
MIDI = INSTALLED and "without-midi" not in sys.argv
BURST = 50  # packets between two pauses: what a socket has no room for would test nothing
PAUSE = 0.004  # s


class Hunt:
    """The ports, and what is sent to each of them."""

    def __init__(self, folder: Path, count: int) -> None:
        udp, tcp = socket.SOCK_DGRAM, socket.SOCK_STREAM
        kinds = {"osc": udp, "freed": udp, "track": udp, "dfmoco": tcp, "foxglove": tcp, "zenoh": tcp}
        self.ports = {name: free_port(kind) for name, kind in kinds.items()}
        self.pipe, self.count = folder / "ltc", count
        os.mkfifo(self.pipe)

    def entries(self) -> list[str]:
        at = {name: f"'{HERE}:{port}'" for name, port in self.ports.items()}
        found = [
            f"{{type: osc, listen: {at['osc']}, to: '{HERE}:9'}}",
            f"{{type: dfmoco, listen: 'tcp:{HERE}:{self.ports['dfmoco']}'}}",
            f"{{type: freed, listen: {at['freed']}, as: target}}",
            f"{{type: opentrackio, listen: {at['track']}, as: base, target: [0, 5, 1]}}",
            f"{{type: freed, to: '{HERE}:9'}}",
            f"{{type: opentrackio, to: '{HERE}:9'}}",
            f"{{type: foxglove, listen: {at['foxglove']}}}",
            f"{{type: zenoh, name: cam, listen: 'tcp/{HERE}:{self.ports['zenoh']}'}}",
            f"{{type: timecode, source: ltc, device: 'pipe:{self.pipe}', rate: 25, chase: nudge, at: '01:00:00:00'}}",
        ]
        if MIDI:
            found += [
                "{type: midi, port: desk, api: jack, controls: [{sends: cc 7, position: pan}, {sends: cc 9, jog: roll}]}",  # noqa: E501
                "{type: timecode, source: mtc, port: tape, api: jack, chase: nudge, at: '01:00:00:00'}",
            ]
        return found

    def datagrams(self, name: str, make: Callable[[random.Random], bytes]) -> None:
        chance, sender = random.Random(name), socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        for number in range(self.count):
            data = make(chance)
            if name != "osc" or not asks_by_osc(data):
                sender.sendto(data, (HERE, self.ports[name]))
            if number % BURST == 0:
                time.sleep(PAUSE)

    def lines(self) -> None:
        chance, stream = random.Random("dfmoco"), socket.create_connection((HERE, self.ports["dfmoco"]))
        for number in range(self.count):
            line = dfmoco_bytes(chance) + b"\r\n"
            if not MOVING.search(b"\n" + line):
                stream.sendall(line)
            if number % BURST == 0:
                stream.settimeout(0.01)
                with suppress(TimeoutError):
                    stream.recv(1 << 20)
                stream.settimeout(60)

    def foxglove(self) -> None:
        chance = random.Random("foxglove")
        texts = ['{"op":"subscribe","subscriptions":[{"id":%d,"channelId":%d}]}', '{"op":"%d%d"}', "[%d,%d]", "{%d%d"]
        for _ in range(max(1, self.count // 1000)):
            with suppress(OSError), socket.create_connection((HERE, self.ports["foxglove"])) as raw:
                raw.sendall(chance.randbytes(chance.randrange(1, 200)))
            with (
                suppress(Exception),
                self._client() as client,
            ):
                for _ in range(100):
                    text = chance.choice(texts) % (chance.randrange(-9, 99), chance.randrange(99))
                    client.send(chance.choice([text, text[: chance.randrange(20)], chance.randbytes(30)]))

    def _client(self) -> ClientConnection:
        """One that waits for no answer to its end: it has sent what no server has to answer."""
        address = f"ws://{HERE}:{self.ports['foxglove']}"
        return connect(address, subprotocols=[Subprotocol("foxglove.sdk.v1")], close_timeout=0.5)

    def zenoh(self) -> None:
        chance = random.Random("zenoh")
        for _ in range(self.count // 1000):
            with suppress(OSError), socket.create_connection((HERE, self.ports["zenoh"]), 5) as raw:
                for _ in range(10):
                    raw.sendall(chance.randbytes(chance.randrange(1, 200)))

    def sound(self) -> None:
        chance, pipe = random.Random("ltc"), os.open(self.pipe, os.O_RDWR)
        for _ in range(self.count // 10):
            os.write(pipe, chance.randbytes(chance.randrange(1, 400)))
            time.sleep(0.0005)
        os.close(pipe)

    def midi(self) -> None:
        chance, desks = random.Random("midi"), [JackController("desk"), JackController("tape")]
        for number in range(self.count // 10):
            size = chance.choice([1, 2, 2, 3, 3, 3])
            first = chance.choice([0xF1, 0xF1, 0xB0, 0x80, 0xE0, 0xFE, 0xF8, 0xC0])
            data = [first, *(chance.randrange(128) for _ in range(size - 1))]
            if data[:2] not in ([0xB0, 7], [0xB0, 9]):  # what asks for something
                desks[number % 2].send(*data)
            if number % BURST == 0:
                time.sleep(PAUSE)


def memory(process: int) -> float:
    """In MB."""
    fields = Path(f"/proc/{process}/status").read_text().split("VmRSS:")[1].split()
    return int(fields[0]) / 1024


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    logging.getLogger().setLevel(logging.ERROR)  # python-osc's own word on each
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        if MIDI:
            stack.enter_context(jack_server())
        hunt = Hunt(folder, count)
        errors = stack.enter_context((folder / "errors").open("wb"))
        console = stack.enter_context(real_exchange(folder, *hunt.entries(), errors=errors))
        time.sleep(3)
        gateway, control = console.gateway, console._process.pid
        places = {name: axis["commanded"] for name, axis in console.state["axes"].items()}
        works: list[Callable[[], None]] = [
            lambda: hunt.datagrams("osc", osc_packet),
            lambda: hunt.datagrams("freed", freed_message),
            lambda: hunt.datagrams("track", opentrackio_packet),
            *(hunt.lines, hunt.foxglove, hunt.zenoh, hunt.sound),
            *([hunt.midi] if MIDI else []),
        ]
        began = time.monotonic()
        threads = [threading.Thread(target=work, daemon=True) for work in works]
        for thread in threads:
            thread.start()
        grown: list[str] = []
        while any(thread.is_alive() for thread in threads):
            grown.append(f"{memory(gateway):.1f}/{memory(control):.1f}")
            for thread in threads:
                thread.join(1.0)
        time.sleep(1)
        grown.append(f"{memory(gateway):.1f}/{memory(control):.1f}")
        after = {name: axis["commanded"] for name, axis in console.state["axes"].items()}
        said = (folder / "errors").read_text(errors="replace")
        step = max(1, len(grown) // 12)
        print(f"{count} of each in {time.monotonic() - began:.0f} s; MB of gateway/control: {' '.join(grown[::step])}")
        print(
            f"{len(said.splitlines())} lines said; moved: {after != places}; same gateway: {console.gateway == gateway}"
        )
        for line in dict.fromkeys(line[11:110] for line in said.splitlines()):
            print("  ", line)
        assert "Traceback" not in said
        assert "Error" not in said
        assert after == places
        assert console.gateway == gateway
        assert not console.state["stopped"]


if __name__ == "__main__":
    main()
