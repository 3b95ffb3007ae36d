"""The fleet of a rig on its console: the others as tiles for the page, and STOP ALL for every role."""

from __future__ import annotations

import json
import urllib.request
from pathlib import Path
from typing import Any

from console_bench import ConsoleBench
from fleet_bench import RigProcess
from waiting import wait_until


def asked(rig: RigProcess, path: str, data: bytes | None = None) -> Any:
    with urllib.request.urlopen(urllib.request.Request(f"{rig.url}{path}", data), timeout=30) as answer:
        return json.load(answer)


def test_a_rig_without_a_fleet_has_no_tiles():
    with ConsoleBench() as bench:
        assert bench.get("/api/fleet").json() == {"rigs": []}
        assert bench.post("/api/fleet/stop").status_code == 404


def test_tiles_show_the_other_rigs_and_stop_all_stops_them(tmp_path: Path):
    with RigProcess(tmp_path, "cam-a") as first:
        second = RigProcess(tmp_path, "cam-b", f"connect: [{first.endpoint}]")
        with second:

            def tiles(rig: RigProcess) -> dict[str, Any]:
                try:
                    return {each["name"]: each for each in asked(rig, "api/fleet")["rigs"]}
                except OSError:  # it is starting
                    return {}

            def both(state: str, rig: RigProcess) -> bool:
                found = tiles(rig)
                return [found.get(name, {}).get("state") for name in ("cam-a", "cam-b")] == [state, state]

            wait_until(lambda: both("ready", first), "both rigs")
            # The first that is asked of this console: it knows no rig yet.
            assert asked(second, "api/fleet/stop", b"{}") == {"ok": True, "not_reached": []}
            for rig in (first, second):
                wait_until(lambda rig=rig: both("stopped", rig), "both rigs stopped on both consoles")
            second.kill()
            wait_until(lambda: tiles(first)["cam-b"]["alive"] is False, "a lost rig")
            assert asked(first, "api/fleet/stop", b"{}") == {"ok": False, "not_reached": ["cam-b"]}
