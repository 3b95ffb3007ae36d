"""How much memory the console's page takes over time, and how many bytes a second.

`python tests/benchmarks/page_memory.py [MINUTES]`.

The rig moves all the time, and the pages are changed once a minute. Prints a line a minute: heap in MB after a
collection, nodes of the document, bytes/s from the server.
"""

from __future__ import annotations

import math
import sys
import tempfile
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from page_bench import PageServer, chrome, take_control

TABS = ("live", "move", "shoot", "takes")


def sway(server: PageServer, ended: threading.Event) -> None:
    while not ended.wait(0.01):
        now = time.monotonic()
        server.rig.at.update(pan=60 * math.sin(now), tilt=20 * math.sin(1.7 * now), focus=0.5 + 0.4 * math.sin(now / 3))


def main(minutes: float) -> None:
    ended, received = threading.Event(), [0]
    with tempfile.TemporaryDirectory() as place, PageServer(Path(place)) as server, chrome() as browser:
        threading.Thread(target=sway, args=(server, ended), daemon=True).start()
        page = browser.open("about:blank")
        page.set_default_timeout(300_000)  # a busy computer is no reason to end after 20 minutes
        page.on("websocket", lambda socket: socket.on("framereceived", lambda text: received.append(len(text))))
        page.goto(server.url)
        take_control(page)
        client = page.context.new_cdp_session(page)
        client.send("Performance.enable")
        for minute in range(int(minutes) + 1):
            client.send("HeapProfiler.collectGarbage")
            found = {each["name"]: each["value"] for each in client.send("Performance.getMetrics")["metrics"]}
            print(
                f"{minute:3} min  {found['JSHeapUsedSize'] / 1e6:6.2f} MB  {found['Nodes']:6.0f} nodes",
                end="",
                flush=True,
            )
            received.clear()
            began = time.monotonic()
            for tab in (*TABS[1:], TABS[0]):
                page.get_by_test_id(f"tab-{tab}").click()
                page.wait_for_timeout(500)
            page.wait_for_timeout(58_000)
            print(f"  {sum(received) / (time.monotonic() - began) / 1000:5.1f} kB/s", flush=True)
        ended.set()
        browser.close()


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 30)
