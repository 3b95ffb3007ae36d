"""Three rigs, each with a gimbal on a bus of its own, begin their moves at one moment: by the frames on the buses."""

from __future__ import annotations

import json
from contextlib import ExitStack
from pathlib import Path

from far_gimbal import far_end
from fleet_bench import FleetCommand, RigProcess, side_by_side, until_alive
from fleet_frames import began, pans
from fleet_net import studio
from waiting import wait_until

from teleop.studio.keys import KeyFolder

RIGS = ("cam-a", "cam-b", "cam-c")
BUS = "udp_multicast:239.74.163.2"
MOVE = "keyframes: [{at: 0, pan: 0}, {at: 3, pan: 30}]\n"


def keys(folder: Path) -> Path:
    made = KeyFolder(folder / "keys")
    for name in RIGS:
        made.add(name, "rig", serves=True)
    made.add("anna", "operate", serves=False)
    return made.folder


def test_three_rigs_start_within_10_ms_of_each_other(tmp_path: Path):
    with ExitStack() as stack:
        place = keys(tmp_path)
        hosts = stack.enter_context(studio([*RIGS, "desk"]))
        fars = []
        for name in RIGS:
            with hosts[name].inside():
                fars.append(stack.enter_context(far_end(BUS)))

        def started(name: str) -> RigProcess:
            entry = f"listen: 'tls/{hosts[name].address}:7447', credentials: {place / f'{name}.yaml'}"
            return RigProcess(tmp_path, name, entry, hosts[name].run, link=BUS)

        for rig in side_by_side(started, RIGS):
            stack.enter_context(rig)
        (tmp_path / "move.yaml").write_text(MOVE)
        operator = FleetCommand(
            tmp_path,
            [f"tls/{hosts[name].address}:7447" for name in RIGS],
            str(place / "anna.yaml"),
            hosts["desk"].run,
        )
        until_alive(operator, *RIGS)
        done = operator.run("play", *(f"{name}=move.yaml" for name in RIGS), "--at", "now+1.5s", "--json")
        assert done.returncode == 0, done.stderr
        told = json.loads(done.stdout)
        assert told["attended"] is False
        wait_until(lambda: all(any(pan > 29.9 for _, pan in pans(far)) for far in fars), "the end of every move")
        moments = began(fars)
        assert max(moments) - min(moments) < 0.010, moments
        for moment, rig in zip(moments, told["rigs"], strict=True):
            assert 0 <= moment - rig["at"] < 0.2  # a jerk-limited start takes 0.1 s to the first tenth of a degree
