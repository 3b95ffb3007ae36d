"""Hostile messages by Zenoh move nothing, end nothing, and keep nobody from STOP (1e5: benchmarks/fleet_hostile.py)."""

from __future__ import annotations

import random
from pathlib import Path

from fleet_bench import RigProcess
from fleet_fuzz import send

from teleop.studio.fleet import Fleet
from teleop.studio.stopping import stop
from teleop.studio.transport import opened


def test_hostile_messages_move_nothing_and_a_stop_gets_through(tmp_path: Path):
    with RigProcess(tmp_path, "cam-a") as rig, Fleet([rig.endpoint], memory=False) as fleet:
        assert fleet.until(lambda: [each for each in fleet.rigs if each.alive], 60)
        seen = fleet.rig("cam-a")
        places = {name: axis["commanded"] for name, axis in seen.state["axes"].items()}
        session = opened("client", connect=[rig.endpoint])
        try:
            send(session, "cam-a", random.Random(1), 1000)
            assert stop(fleet) == []
        finally:
            session.close()
        assert seen.state["stopped_by"] == fleet.name
        assert {name: axis["commanded"] for name, axis in seen.state["axes"].items()} == places
        assert seen.state["holder"] is None
        assert not [line for line in seen.state["messages"] if "gateway" in line["text"]]
