"""A rig that others can reach announces where a fleet connects, and `teleop fleet` without --connect finds it."""

from __future__ import annotations

import json
from contextlib import ExitStack
from ipaddress import ip_network
from pathlib import Path
from types import SimpleNamespace

import pytest
from fleet_bench import FleetCommand, RigProcess
from fleet_net import studio
from waiting import wait_until

from teleop.cli.console_options import ReachedOptions
from teleop.cli.fleet.discovered import best, discovered
from teleop.cli.options import DEFAULTS
from teleop.config.exchange import ENTRIES
from teleop.config.profile import load_profile
from teleop.core.errors import TeleopError, UsageError
from teleop.gateway import discovery
from teleop.gateway.announcing import ConsoleAt, announcement
from teleop.gateway.discovery import Announcement, Found
from teleop.studio.keys import KeyFolder

REACHED = "tls/192.0.2.7:7447"


def entry(listen: str) -> list:
    return ENTRIES.validate_python([{"type": "zenoh", "name": "cam-a", "listen": listen, "credentials": "cam-a.yaml"}])


def found(zenoh: str) -> Found:
    return Found("cam-a", "cam-a", ["192.0.2.7"], 7447, True, {"zenoh": zenoh})


@pytest.mark.parametrize(
    "listen", ["tls/127.0.0.1:7447", "tls/[::1]:7447", "tls/localhost:7447", "tls/192.0.2.7:0", "tls/no.invalid:7447"]
)
def test_what_only_this_computer_reaches_or_nobody_knows_is_not_announced(listen: str):
    assert announcement("rig", None, entry(listen)) == {}
    assert announcement("rig", ConsoleAt("127.0.0.1", 8470, False), entry(listen)) == {}
    console = announcement("rig", ConsoleAt("192.0.2.7", 8470, False), entry(listen))["announcement"]
    assert discovery._text(Announcement(**console), ["192.0.2.7"]) == {"rig": "rig", "tls": "0", "api": "/api"}


def test_a_rig_is_announced_with_its_console_and_without_one():
    def told(console: ConsoleAt | None) -> tuple[Announcement, dict[str, str]]:
        what = Announcement(**announcement("studio", console, entry("tls/0.0.0.0:7447"))["announcement"])
        return what, discovery._text(what, ["192.0.2.7", "2001:db8::7"])

    reached = {"tls": "1", "zenoh": "tls/192.0.2.7:7447 tls/[2001:db8::7]:7447"}
    for console in (None, ConsoleAt("127.0.0.1", 8470, True)):
        what, text = told(console)
        assert (what.port, text) == (7447, {"rig": "cam-a", **reached})
    what, text = told(ConsoleAt("192.0.2.7", 8470, True))
    assert (what.port, text) == (8470, {"rig": "studio", "api": "/api", **reached})
    many = discovery._text(what, [f"2001:db8::{number:x}" for number in range(99)])["zenoh"]
    assert len(many) <= discovery.LONGEST_TEXT
    assert found(many).endpoints == many.split()


def test_a_run_without_a_console_tells_its_gateway():
    profile = load_profile("sim").model_copy(update={"exchange": entry(REACHED)})
    with ReachedOptions().beside(None, DEFAULTS, profile) as gateway:
        assert gateway is not None
        assert gateway.settings["announcement"]["more"] == {"zenoh": REACHED}
    profile = profile.model_copy(update={"exchange": entry("tls/127.0.0.1:7447")})
    with ReachedOptions().beside(None, DEFAULTS, profile) as gateway:
        assert gateway is not None
        assert "announcement" not in gateway.settings


def test_the_endpoint_in_a_network_of_this_computer_is_taken():
    rig = found("tls/198.51.100.9:7447 tls/192.0.2.7:7447 nonsense tls/[::1%x]:7 tls/192.0.2.8:0")
    assert best(rig, "tls/", [ip_network("192.0.2.0/24")]) == REACHED
    assert best(rig, "tls/", []) == "tls/198.51.100.9:7447"
    assert best(rig, "tcp/", []) == ""


@pytest.mark.parametrize(
    ("rigs", "tls", "why"),
    [
        ([], True, "no rig was found by mDNS"),
        ([found("")], True, "no rig was found by mDNS"),
        ([found("x y tls/")], True, "no rig was found by mDNS"),
        ([found(REACHED)], False, "found by mDNS: cam-a: needs --credentials"),
        (TeleopError("no mDNS on this network: x"), True, "no mDNS on this network: x: name them with --connect"),
        (ImportError(), True, r"pip install 'rs-teleop\[fleet\]'"),
    ],
)
def test_where_nothing_is_found_it_says_why(rigs, tls: bool, why: str, monkeypatch: pytest.MonkeyPatch):
    async def browse() -> list[Found]:
        if isinstance(rigs, Exception):
            raise rigs
        return rigs

    monkeypatch.setattr(discovery, "browse", browse)
    with pytest.raises(UsageError, match=why):
        discovered(tls)


def test_a_rig_is_found_on_the_network_with_the_credentials_alone(tmp_path: Path):
    made = KeyFolder(tmp_path / "keys")
    made.add("cam-a", "rig", serves=True)
    made.add("anna", "operate", serves=False)
    with ExitStack() as stack:
        hosts = stack.enter_context(studio(["cam-a", "desk"]))
        listen = f"listen: 'tls/0.0.0.0:7447', credentials: {made.folder / 'cam-a.yaml'}"
        stack.enter_context(RigProcess(tmp_path, "cam-a", listen, hosts["cam-a"].run))
        operator = FleetCommand(tmp_path, [], str(made.folder / "anna.yaml"), hosts["desk"].run)
        kept = SimpleNamespace(rigs=[])

        def seen() -> bool:
            done = operator.run("--json", "--once")
            kept.rigs = json.loads(done.stdout)["rigs"] if done.returncode == 0 else []
            assert kept.rigs or "no rig was found by mDNS" in done.stderr, done.stderr
            return bool(kept.rigs)

        wait_until(seen, "a rig by mDNS")
        assert [(rig["name"], rig["alive"]) for rig in kept.rigs] == [("cam-a", True)]
        done = FleetCommand(tmp_path, [], "", hosts["desk"].run).run("stop")
        assert (done.returncode, "cam-a: needs --credentials" in done.stderr) == (2, True), done.stderr
