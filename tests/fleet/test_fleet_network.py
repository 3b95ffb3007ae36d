"""Rigs, a router and an operator on hosts of their own, joined by cables that can be cut, with certificates."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from time import monotonic

import fleet_pan
import fleet_router
import rig_watch
from fleet_bench import JsonProcess, RigProcess
from fleet_net import Host, studio

from teleop.studio.keys import KeyFolder

RIGS = ("cam-a", "cam-b", "cam-c")


def keys(folder: Path) -> Path:
    made = KeyFolder(folder / "keys")
    for name in RIGS:
        made.add(name, "rig", serves=True)
    made.add("anna", "operate", serves=False)
    made.add("wim", "watch", serves=False)
    made.add("router", "router", serves=True)
    return made.folder


def rig(folder: Path, place: Path, name: str, host: Host, router: Host | None = None) -> RigProcess:
    credentials = f"credentials: {place / f'{name}.yaml'}"
    where = f"listen: 'tls/{host.address}:7447'" if router is None else f"connect: ['tls/{router.address}:7447']"
    return RigProcess(folder, name, f"{where}, {credentials}", host.run)


def routing(stack: ExitStack, words: Sequence[str]) -> subprocess.Popen[bytes]:
    process = stack.enter_context(subprocess.Popen(words))
    stack.callback(process.kill)
    return process


def test_a_link_that_is_cut_in_mid_pan_stops_the_rig_and_is_shown(tmp_path: Path):
    with ExitStack() as stack:
        place = keys(tmp_path)
        hosts = stack.enter_context(studio([*RIGS, "desk"]))
        rigs = {name: stack.enter_context(rig(tmp_path, place, name, hosts[name])) for name in RIGS}
        endpoints = [f"tls/{hosts[name].address}:7447" for name in RIGS]
        pan = [*hosts["desk"].run, sys.executable, fleet_pan.__file__, str(place / "anna.yaml"), "cam-a", *endpoints]
        operator = JsonProcess(stack, pan)
        watch = JsonProcess(stack, [*hosts["cam-a"].run, sys.executable, rig_watch.__file__, rigs["cam-a"].url])
        operator.until(lambda line: line.get("armed"))
        operator.say("pan 0.4")
        operator.until(lambda line: line.get("moves"))
        watch.until(lambda line: line["speed"] > 1)
        hosts["cam-a"].cut()
        cut = monotonic()
        lost = operator.until(lambda line: line.get("alive") and not line["alive"]["cam-a"], cut)
        rests = watch.until(lambda line: line["speed"] == 0, cut)
        assert lost["alive"]["cam-b"]
        assert lost["time"] - cut < 0.5
        assert rests["time"] - cut < 1.0  # 0.25 s of silence, and the ramp

        hosts["cam-a"].mend()
        mended = monotonic()
        back = operator.until(lambda line: line.get("alive") and line["alive"]["cam-a"], mended)
        operator.until(lambda line: line.get("armed") is False, back["time"] - 1e-9)  # the stick is held, for nothing
        operator.say("pan 0")
        operator.say("take")
        operator.until(lambda line: line.get("armed"), back["time"])
        assert all(line["speed"] == 0 for line in list(watch.lines) if line["time"] > rests["time"])
        operator.say("pan -0.4")
        operator.until(lambda line: line.get("moves"), back["time"])

        hosts["cam-b"].cut()
        operator.say("stop 3")
        assert operator.until(lambda line: "missed" in line)["missed"] == ["cam-b"]
        watch.until(lambda line: line["speed"] == 0, back["time"])


def test_rigs_behind_a_router_that_is_killed_come_back(tmp_path: Path):
    with ExitStack() as stack:
        place = keys(tmp_path)
        hosts = stack.enter_context(studio([*RIGS[:2], "router", "desk"]))
        serve = [*hosts["router"].run, sys.executable, fleet_router.__file__, str(place / "router.router.json5")]
        router = routing(stack, serve)
        for name in RIGS[:2]:
            stack.enter_context(rig(tmp_path, place, name, hosts[name], hosts["router"]))
        endpoint = f"tls/{hosts['router'].address}:7447"
        pan = [*hosts["desk"].run, sys.executable, fleet_pan.__file__, str(place / "anna.yaml"), "cam-a", endpoint]
        operator = JsonProcess(stack, pan)
        operator.until(lambda line: line.get("armed"))
        operator.say("pan 0.4")
        operator.until(lambda line: line.get("moves"))
        router.kill()
        killed = monotonic()
        lost = operator.until(lambda line: line.get("alive") and not any(line["alive"].values()), killed)
        router.wait()
        routing(stack, serve)
        back = operator.until(lambda line: line.get("alive") and all(line["alive"].values()), lost["time"])
        assert not operator.until(lambda line: "moves" in line, back["time"] - 1e-9)["moves"]
        operator.say("stop 10")
        assert operator.until(lambda line: "missed" in line)["missed"] == []
