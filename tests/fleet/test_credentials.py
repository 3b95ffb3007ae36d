"""Who may do what: certificates of the fleet's own authority, and roles by the names in them; all others nothing."""

from __future__ import annotations

import json
import stat
from pathlib import Path

import pytest
from fleet_bench import RigProcess, free_port

from teleop.cli.fleet.keys import fleet_keys
from teleop.config.documents.document import DocumentError
from teleop.config.profile import checked_profile
from teleop.config.resources import find
from teleop.core.errors import DeviceError, UsageError
from teleop.studio.common_start import FleetError, SentMove, play
from teleop.studio.credentials import load
from teleop.studio.fleet import Fleet
from teleop.studio.keys import KeyFolder
from teleop.studio.stopping import stop
from teleop.studio.transport import opened

MOVE = SentMove("pan", "keyframes: [{at: 0, pan: 0}, {at: 3, pan: 20}]")


def with_entry(entry: str):
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    return checked_profile(f"{text}\nexchange:\n  - {{type: zenoh, name: cam-a, {entry}}}\n", "test.yaml")


@pytest.mark.parametrize(
    ("entry", "refused"),
    [
        ("listen: tcp/127.0.0.1:7447", ""),
        ("listen: 'tcp/[::1]:7447'", ""),
        ("listen: tcp/localhost:7447, connect: [tcp/127.0.0.1:7448]", ""),
        ("listen: tls/0.0.0.0:7447, credentials: cam-a.yaml", ""),
        ("listen: tls/0.0.0.0:7447", "needs credentials"),
        ("listen: tcp/0.0.0.0:7447", "can be reached by others"),
        ("listen: tcp/0.0.0.0:7447, credentials: cam-a.yaml", "can be reached by others"),
        ("listen: tcp/192.168.1.20:7447", "can be reached by others"),
        ("listen: 'tcp/[::]:7447'", "can be reached by others"),
        ("listen: 'tcp/[::ffff:192.168.1.20]:7447'", "can be reached by others"),
        ("listen: tcp/rig.local:7447", "can be reached by others"),
        ("listen: udp/127.0.0.1:7447", "must be tcp/HOST:PORT"),
        ("listen: 'tcp/127.0.0.1:7447#iface=eth0'", "must be tcp/HOST:PORT"),
        ("listen: 127.0.0.1:7447", "must be tcp/HOST:PORT"),
        ("connect: [tcp/192.168.1.1:7447]", "can be reached by others"),
        ("listen: tcp/127.0.0.1:7447, rate: 4", "rate"),  # it would be lost between two states
        ("rate: 10", "needs listen, connect or both"),
    ],
)
def test_what_others_can_reach_needs_credentials_when_the_profile_is_read(entry: str, refused: str):
    if refused:
        with pytest.raises(DocumentError, match=refused):
            with_entry(entry)
    else:
        assert with_entry(entry).exchange


def test_keys_are_for_their_owner_alone_and_made_once(tmp_path: Path):
    made = KeyFolder(tmp_path / "keys")
    made.add("cam-a", "rig", serves=True)
    made.add("anna", "operate", serves=False)
    assert {stat.S_IMODE(file.stat().st_mode) for file in made.folder.iterdir()} == {0o600}
    assert stat.S_IMODE(made.folder.stat().st_mode) == 0o700
    authority = (made.folder / "ca.pem").read_text()
    again = KeyFolder(tmp_path / "keys")
    assert (again.members, (made.folder / "ca.pem").read_text()) == ({"cam-a": "rig", "anna": "operate"}, authority)
    for name in ("anna", "ca", "access"):
        with pytest.raises(UsageError, match="choose another name"):
            again.add(name, "watch", serves=False)


def test_the_file_of_a_router_has_those_who_are_members_now(tmp_path: Path):
    def named() -> set[str]:
        subjects = json.loads((tmp_path / "studio.router.json5").read_text().partition("\n")[2])["access_control"][
            "subjects"
        ]
        return {name for each in subjects for name in each["cert_common_names"]}

    made = KeyFolder(tmp_path)
    made.add("studio", "router", serves=True)
    made.add("anna", "operate", serves=False)
    assert named() == {"studio", "anna"}
    access = tmp_path / "access.yaml"
    access.write_text(access.read_text().replace("  anna: operate\n", ""))
    assert fleet_keys(tmp_path) == 0
    assert named() == {"studio"}
    with pytest.raises(UsageError, match="name the members"):
        fleet_keys(tmp_path / "new")


def test_an_operator_operates_a_watcher_stops_and_a_stranger_does_nothing(tmp_path: Path):
    made = KeyFolder(tmp_path / "keys")
    made.add("cam-a", "rig", serves=True)
    made.add("anna", "operate", serves=False)
    made.add("wim", "watch", serves=False)
    made.add("odd", "watch", serves=False)
    made.members.pop("odd")  # of this authority, and no member any more
    made.write_access()
    foreign = KeyFolder(tmp_path / "foreign")
    foreign.add("anna", "operate", serves=False)
    endpoint = f"tls/127.0.0.1:{free_port()}"
    entry = f"listen: '{endpoint}', credentials: {made.folder / 'cam-a.yaml'}"

    with RigProcess(tmp_path, "cam-a", entry):

        def fleet(file: Path) -> Fleet:
            return Fleet([endpoint], load(str(file)), memory=False)

        with fleet(made.folder / "anna.yaml") as anna:
            assert anna.until(lambda: [rig for rig in anna.rigs if rig.alive], 60)
            assert "error" not in anna.command("cam-a", {"do": "take_control"})
            with fleet(made.folder / "wim.yaml") as wim:
                assert wim.until(lambda: [rig for rig in wim.rigs if rig.alive], 60)
                with pytest.raises(FleetError, match="does not answer wim: that needs the role `operate` in its"):
                    play(wim, {"cam-a": MOVE}, lambda: 1.0)
                assert wim.command("cam-a", {"do": "release_control"})["kind"] == "lost"
                assert stop(wim) == []
            assert anna.until(lambda: anna.rig("cam-a").stopped, 60)
            assert anna.rig("cam-a").state["holder"] == anna.name  # a STOP takes no control
        with fleet(made.folder / "odd.yaml") as odd:
            odd.wait(10)
            assert odd.rigs == []
            assert odd.problems == [f"{endpoint}: answers, but shows no rig: is odd in its access.yaml?"]
            assert stop(odd, patience=0.1) == [endpoint]
        with fleet(foreign.folder / "anna.yaml") as stranger:
            stranger.wait(10)
            assert stranger.problems[0].startswith(f"{endpoint}: its certificate is of another fleet: both sides need")
            assert stop(stranger, patience=0.1) == [endpoint]
        with pytest.raises(DeviceError):
            opened("client", connect=[endpoint], credentials=load(str(foreign.folder / "anna.yaml")))
        with pytest.raises(DeviceError):
            opened("client", connect=[f"tcp{endpoint[3:]}"])
