"""Hostile OSC packets and DFMoco lines, in process and at a real run's sockets.

python tests/benchmarks/hunt_exchange_input.py [COUNT]
"""

from __future__ import annotations

import socket
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from random import Random

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from exchange_fuzz import MOVING, asks_by_osc, dfmoco_bytes, dfmoco_hunt, osc_hunt, osc_packet
from real_exchange import free_port, real_exchange


def at_sockets(count: int) -> None:
    """What no judge sees a command in goes to a real rig, which must stay where it is, with the same gateway."""
    osc, dfmoco, chance = free_port(socket.SOCK_DGRAM), free_port(), Random(7)
    entries = f"{{type: osc, listen: '127.0.0.1:{osc}'}}", f"{{type: dfmoco, listen: 'tcp:127.0.0.1:{dfmoco}'}}"
    with tempfile.TemporaryDirectory() as folder, real_exchange(Path(folder), *entries) as console:
        gateway, places = console.gateway, {name: axis["commanded"] for name, axis in console.state["axes"].items()}
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        stream = socket.create_connection(("127.0.0.1", dfmoco))
        stream.settimeout(0.001)
        for number in range(count):
            data = osc_packet(chance)
            if not asks_by_osc(data):
                sender.sendto(data, ("127.0.0.1", osc))
            line = dfmoco_bytes(chance) + b"\r\n"
            if not MOVING.search(line) and b"zm" not in line and b"np" not in line:
                stream.settimeout(5)
                stream.sendall(line)
            if number % 100 == 0:
                stream.settimeout(0.01)
                with suppress(TimeoutError):
                    stream.recv(1 << 20)
        time.sleep(1)
        assert console.gateway == gateway
        assert {name: axis["commanded"] for name, axis in console.state["axes"].items()} == places
        assert not console.state["stopped"]


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    print(f"OSC: {count} packets, {osc_hunt(count)} asked for something that was in them")
    print(f"DFMoco: {count} pieces, {dfmoco_hunt(count)} moved what was asked")
    at_sockets(count)
    print(f"a real run: {count} of each without a command; nothing moved, and its gateway is the same")


if __name__ == "__main__":
    main()
