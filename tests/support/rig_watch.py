"""Beside a rig, on its own host: what its console shows of pan, a JSON line each 10 ms. `python rig_watch.py URL`."""

from __future__ import annotations

import json
import sys
import time
import urllib.request


def main(url: str) -> None:
    while True:
        with urllib.request.urlopen(f"{url}api/state", timeout=5) as answer:
            state = json.load(answer)
        pan = state["axes"]["pan"]
        shown = {"time": state["time"], "speed": pan["speed"], "at": pan["commanded"]}
        sys.stdout.write(json.dumps(shown) + "\n")
        sys.stdout.flush()
        time.sleep(0.01)


if __name__ == "__main__":
    main(sys.argv[1])
