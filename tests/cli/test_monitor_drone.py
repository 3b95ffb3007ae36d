"""What a drone says on its serial line is told in units, and no secret with it."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

import pytest
from far_drone import far_drone

from teleop.cli import run
from teleop.cli.monitor import Tap, Watch
from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast import Broadcast
from teleop.dji.drone.broadcast_parts import Position
from teleop.dji.drone.enums import FlightStatus
from teleop.dji.drone.movement import Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.dji.drone.onboard_sdk import M100
from teleop.dji.drone.session import OnboardSession
from teleop.links import FAR_END


def test_a_drone_is_heard_on_its_serial_line_in_one_direction(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TELEOP_DJI_APP_ID", "1")
    with far_drone() as (_, url):
        rig = ["--rig", "m100", "--link", f"drone={url}"]
        assert run(["send", "drone", "activate", *rig]) == 0
        capsys.readouterr()
        assert run(["monitor", "drone", "--json", "--seconds", "0.2", *rig]) == 0
    printed = capsys.readouterr()
    records = [json.loads(line) for line in printed.out.splitlines()]
    assert {record["direction"] for record in records} == {"from drone"}
    assert any(record["fields"].get("status") == "standby" for record in records)
    listening, summary = printed.err.splitlines()
    assert listening == (
        f"listening on {url}: time in s, <- from the drone; a serial line does not show what is sent to it"
    )
    assert summary.startswith(f"{len(records)} frames from the drone, 0 damaged")


class Overheard:
    """A listener that heard these bytes from a drone."""

    def __init__(self, data: bytes) -> None:
        self.foreign: Counter[int] = Counter()
        self.counts: Counter[str] = Counter()
        self._heard = [(FAR_END, data)]

    def receive(self) -> list[tuple[int, bytes]]:
        heard, self._heard = self._heard, []
        return heard

    def close(self) -> None: ...


@pytest.mark.parametrize("as_json", [False, True])
def test_an_app_id_that_is_overheard_is_not_shown(as_json: bool, capsys: pytest.CaptureFixture[str]) -> None:
    tapped = Tap("serial:x@1", "drone", M100, {FAR_END: "from drone"})
    Watch(Overheard(OnboardSession().command(drone.Activate(1030093))), tapped, as_json).look(1.0)
    told = capsys.readouterr().out
    assert "1030093" not in told
    assert "hidden" in told


def test_a_broadcast_in_units(capsys: pytest.CaptureFixture[str]) -> None:
    tapped = Tap("serial:x@1", "drone", M100, {FAR_END: "from drone"})
    said = OnboardSession()
    broadcast = Broadcast(position=Position(0.5, 1.25, 60.0, 3.5, 4), status=FlightStatus.IN_AIR, battery=87)
    modes: dict[str, Any] = {"horizontal": Horizontal.VELOCITY, "vertical": Vertical.VELOCITY, "yaw_control": Yaw.RATE}
    move = Move(stable=True, frame=ReferenceFrame.GROUND, x=1, y=0, z=2, yaw=9, **modes)
    Watch(Overheard(said.command(broadcast) + said.command(move)), tapped, False).look(1.0)
    assert capsys.readouterr().out.splitlines() == [
        "    1.000 <- drone.broadcast, position.latitude 0.5 rad, position.longitude 1.25 rad, position.altitude 60 m, "
        "position.height 3.5 m, position.health 4, status in_air, battery 87 %",
        "    1.000 <- drone.move, stable true, frame ground, yaw_control rate, vertical velocity, horizontal velocity, "
        "x 1 m/s, y 0 m/s, z 2 m/s, yaw 9 deg/s",
    ]
