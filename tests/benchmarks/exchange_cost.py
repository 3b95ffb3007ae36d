"""What OSC and DFMoco cost: latency of a command, processor time of the gateway, and of the control process as a ratio.

python tests/benchmarks/exchange_cost.py [SECONDS]
"""

from __future__ import annotations

import socket
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from processor_time import processor_time
from real_console import RealConsole
from real_exchange import free_port, real_exchange

from teleop.links.osc_packets import messages, packet


def load(console: RealConsole, seconds: float) -> tuple[float, float]:
    """Shares of a core that the control process and its gateway take, while an axis moves."""
    control, gateway = console._process.pid, console.gateway
    console.request("api/command", {"do": "goto", "axes": {"pan": 90}, "seconds": seconds})
    before = processor_time(control), processor_time(gateway)
    time.sleep(seconds)
    share = (processor_time(control) - before[0]) / seconds, (processor_time(gateway) - before[1]) / seconds
    console.request("api/command", {"do": "goto", "axes": {"pan": 0}, "seconds": 2, "wait": True})
    return share


def latencies(osc: int, feedback: socket.socket, dfmoco: int) -> tuple[list[float], list[float]]:
    """ms: from STOP to `/teleop/stopped 1` by OSC, and from `mm` to its answer by DFMoco."""
    sender, stops, moves = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), [], []
    for _ in range(20):
        for address, wanted in (("/teleop/stop", 1), ("/teleop/clear", 0)):
            begun = time.monotonic()
            sender.sendto(packet(address), ("127.0.0.1", osc))
            while messages(feedback.recv(4096))[0] != ("/teleop/stopped", (wanted,)):
                pass
            stops.append((time.monotonic() - begun) * 1000)
    stream = socket.create_connection(("127.0.0.1", dfmoco))
    lines = stream.makefile("rb")
    for number in range(40):
        begun = time.monotonic()
        stream.sendall(b"mm 1 %d\r\n" % (10 + 100 * (number % 2)))
        while not lines.readline().startswith(b"mm"):
            pass
        moves.append((time.monotonic() - begun) * 1000)
        time.sleep(0.1)
    return stops, moves


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    osc, dfmoco = free_port(socket.SOCK_DGRAM), free_port()
    feedback = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    feedback.bind(("127.0.0.1", 0))
    feedback.settimeout(20)
    to = feedback.getsockname()[1]
    entries = (
        f"{{type: osc, listen: '127.0.0.1:{osc}', to: '127.0.0.1:{to}'}}",
        f"{{type: dfmoco, listen: 'tcp:127.0.0.1:{dfmoco}'}}",
    )
    with tempfile.TemporaryDirectory() as folder:
        plain, spoken = Path(folder, "plain"), Path(folder, "spoken")
        for each in (plain, spoken):
            each.mkdir()
        with RealConsole(plain) as without, real_exchange(spoken, *entries) as with_them:
            stops, moves = latencies(osc, feedback, dfmoco)
            shares = [(load(without, seconds), load(with_them, seconds)) for _ in range(3)]
    for name, times in (("STOP to its feedback by OSC", stops), ("mm to its answer by DFMoco", moves)):
        print(f"{name}: median {statistics.median(times):.0f} ms, worst {max(times):.0f} ms")
    (control, gateway), (control_with, gateway_with) = (
        tuple(statistics.mean(pair[i][j] for pair in shares) for j in range(2)) for i in range(2)
    )
    print("control process, pairs without and with:", *(f"{a[0]:.1%} {b[0]:.1%};" for a, b in shares))
    print(f"gateway: {gateway:.1%} of a core without, {gateway_with:.1%} with both")
    print(f"control process: {control:.1%} without, {control_with:.1%} with: ratio {control_with / control:.3f}")


if __name__ == "__main__":
    main()
