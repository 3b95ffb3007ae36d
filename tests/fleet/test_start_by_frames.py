"""Three rigs, each with a gimbal on a bus of its own, begin their moves at one moment: by the frames on the buses."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from subprocess import PIPE

import fleet_gimbals
import pytest
from fleet_bench import FleetCommand, RigProcess, side_by_side, until_alive
from fleet_frames import began
from fleet_net import Host, studio

from teleop.studio.keys import KeyFolder

RIGS = ("cam-a", "cam-b", "cam-c")
MOVE = "keyframes: [{at: 0, pan: 0}, {at: 3, pan: 30}]\n"


def keys(folder: Path) -> Path:
    made = KeyFolder(folder / "keys")
    for name in RIGS:
        made.add(name, "rig", serves=True)
    made.add("anna", "operate", serves=False)
    return made.folder


def gimbals(stack: ExitStack, hosts: Sequence[Host]) -> subprocess.Popen[str]:
    words = [sys.executable, fleet_gimbals.__file__, *(host.namespace for host in hosts)]
    process = stack.enter_context(subprocess.Popen(words, stdin=PIPE, stdout=PIPE, text=True))
    stack.callback(process.kill)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    return process


@pytest.mark.timeout(300)
def test_three_rigs_start_within_10_ms_of_each_other(tmp_path: Path):
    with ExitStack() as stack:
        place = keys(tmp_path)
        hosts = stack.enter_context(studio([*RIGS, "desk"]))
        endpoints = {name: f"tls/{hosts[name].address}:7447" for name in RIGS}
        buses = gimbals(stack, [hosts[name] for name in RIGS])

        def started(name: str) -> RigProcess:
            entry = f"listen: '{endpoints[name]}', credentials: {place / f'{name}.yaml'}"
            return RigProcess(tmp_path, name, entry, hosts[name].run, link=fleet_gimbals.BUS)

        for rig in side_by_side(started, RIGS):
            stack.enter_context(rig)
        (tmp_path / "move.yaml").write_text(MOVE)
        operator = FleetCommand(tmp_path, list(endpoints.values()), str(place / "anna.yaml"), hosts["desk"].run)
        until_alive(operator, *RIGS)
        moves = [f"{name}=move.yaml" for name in RIGS]
        done = operator.run("play", *moves, "--at", "now+1.5s", "--attended", "--json")  # it ends with the moves
        assert done.returncode == 0, done.stderr
        told = json.loads(done.stdout)
        moments = began([json.loads(line) for line in buses.communicate()[0].splitlines()])
        assert max(moments) - min(moments) < 0.010, moments
        for moment, rig in zip(moments, told["rigs"], strict=True):
            assert 0 <= moment - rig["at"] < 0.2  # a jerk-limited start takes 0.1 s to the first tenth of a degree
