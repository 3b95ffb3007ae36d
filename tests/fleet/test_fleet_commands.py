"""`teleop fleet` with real rigs on this computer: what is listed, and STOP."""

from __future__ import annotations

import json
from pathlib import Path

from fleet_bench import FleetCommand, RigProcess, until_alive


def test_rigs_are_listed_stopped_and_remembered(tmp_path: Path):
    with RigProcess(tmp_path, "cam-a") as first, RigProcess(tmp_path, "cam-b") as second:
        operator = FleetCommand(tmp_path, [first.endpoint, second.endpoint])
        until_alive(operator, "cam-a", "cam-b")
        rigs = operator.rigs()
        assert [rigs[name]["state"] for name in ("cam-a", "cam-b")] == ["ready", "ready"]
        assert all(rig["holder"] is None and rig["clock_doubt_ms"] < 1000 for rig in rigs.values())

        done = operator.run("stop", "--json")
        assert (done.returncode, json.loads(done.stdout)["stopped"]) == (0, ["cam-a", "cam-b"]), done.stderr
        assert {rig["state"] for rig in operator.rigs().values()} == {"stopped"}

        second.kill()
        lost = operator.rigs()
        assert (lost["cam-a"]["alive"], lost["cam-b"]["alive"], lost["cam-b"]["state"]) == (True, False, "lost")
        done = operator.run("stop", "--all")
        assert done.returncode == 1
        assert "cam-b NOT REACHED" in done.stderr
        assert "cam-a: stopped" in done.stdout
        fresh = FleetCommand(tmp_path / "fresh", [first.endpoint, second.endpoint])
        fresh.folder.mkdir()
        assert list(fresh.rigs()) == ["cam-a"]
