"""`teleop fleet` with real rigs on this computer: what is listed, STOP, and a start that they have in common."""

from __future__ import annotations

import json
from contextlib import ExitStack
from pathlib import Path

from fleet_bench import FleetCommand, RigProcess, until_alive

from teleop.studio.fleet import Fleet

MOVE = """
title: pan
keyframes:
  - {at: 0, pan: 0}
  - {at: 3, pan: 30}
"""


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


def starts(fleet: Fleet, names: list[str]) -> dict[str, list[float]]:
    """When each rig's move began, by this machine's monotonic clock, as each state of it tells."""
    found: dict[str, dict[float, float]] = {name: {} for name in names}

    def look() -> bool:
        for name in names:
            state = fleet.rig(name).state
            move = state.get("move") or {}
            if move.get("phase") == "playing" and move["at"] > 0:
                found[name][state["time"]] = state["time"] - move["at"]
        return all(len(times) > 10 for times in found.values())

    assert fleet.until(look, 60)
    return {name: sorted(times.values()) for name, times in found.items()}


def test_three_rigs_start_within_10_ms_of_each_other(tmp_path: Path):
    (tmp_path / "move.yaml").write_text(MOVE)
    names = ["cam-a", "cam-b", "cam-c"]
    with ExitStack() as stack:
        rigs = [stack.enter_context(RigProcess(tmp_path, name)) for name in names]
        operator = FleetCommand(tmp_path, [rig.endpoint for rig in rigs])
        until_alive(operator, *names)
        done = operator.run("play", *(f"{name}=move.yaml" for name in names), "--at", "now+2s", "--json")
        assert done.returncode == 0, done.stderr
        accepted = json.loads(done.stdout)
        assert accepted["attended"] is False
        fleet = stack.enter_context(Fleet([rig.endpoint for rig in rigs], memory=False))
        fleet.wait(30)
        found = starts(fleet, names)
        first = [times[0] for times in found.values()]
        assert max(first) - min(first) < 0.010
        for rig in accepted["rigs"]:
            assert all(abs(begin - rig["at"]) < 0.002 for begin in found[rig["name"]])  # and not at some tick
        assert fleet.rig("cam-a").state["holder"] is None
