"""A router as `zenohd -c FILE` is one: Zenoh's Python package in its mode router. `fleet_router.py FILE [ENDPOINT]`."""

from __future__ import annotations

import json
import os
import sys
import threading
from pathlib import Path

import zenoh


def main(file: str, listen: str = "") -> None:
    os.chdir(Path(file).parent)
    config = zenoh.Config.from_file(file)
    if listen:
        config.insert_json5("listen/endpoints", json.dumps([listen]))
    with zenoh.open(config):
        threading.Event().wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
