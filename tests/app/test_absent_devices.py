"""Only what a run uses is opened, and what is absent takes its own axes out of a live run and out of nothing else."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

import pytest
from command import teleop

from teleop.app.absent_devices import open_present
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile, load_profile
from teleop.core.axes import STICKS, Axis
from teleop.core.clock import VirtualClock
from teleop.core.errors import LinkError
from teleop.core.events import Action, DeviceCommand, Exposure, ShutterStep
from teleop.devices.rig import open_rig
from teleop.sim.gimbal.device import SimulatedGimbal

GIMBAL = [Axis.PAN, Axis.TILT, Axis.ROLL]
NOWHERE = "serial:/dev/teleop-no-such-port@230400"


def m100(drone: str = NOWHERE, gimbal: str = "sim:") -> Profile:
    return load_profile("m100", {"drone": drone, "gimbal": gimbal})


@pytest.fixture(autouse=True)
def no_credentials(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    for name in ("TELEOP_DJI_APP_ID", "TELEOP_DJI_APP_KEY"):
        monkeypatch.delenv(name, raising=False)


def test_a_gimbals_move_needs_neither_the_drones_port_nor_its_keys() -> None:
    done = teleop("play", "nudge", "--rig", "m100", "--link", "gimbal=sim:", "--fast")
    assert done.returncode == 0, done.stderr
    assert "pan" in done.stdout


@pytest.mark.parametrize(
    ("axes", "acts", "links"),
    [
        ([Axis.PAN], [], {"gimbal"}),
        ([Axis.STICK_YAW], [], {"drone"}),
        ([Axis.STICK_YAW, Axis.TILT], [], {"drone", "gimbal"}),
        ([Axis.STICK_YAW], [Action.RECORD], {"drone", "gimbal"}),
        ([Axis.STICK_YAW], [Exposure(0, ShutterStep.PRESS)], {"drone", "gimbal"}),
        ([Axis.STICK_YAW], [DeviceCommand("gimbal", "follow lock")], {"drone", "gimbal"}),
        ([Axis.PAN], [DeviceCommand("drone", "land")], {"drone", "gimbal"}),
        ([], [], set()),
    ],
)
def test_which_links_a_run_needs(axes: list[Axis], acts: list[object], links: set[str]) -> None:
    used = m100().in_use(axes, acts)
    assert set(used.links) == links
    assert {section.link for section in used.sinks} == links


def present(profile: Profile) -> tuple[list[Axis], list[str], float]:
    clock = VirtualClock()
    with ExitStack() as stack:
        _, axes, notes = open_present(stack, profile, clock)
        return list(axes), list(notes), clock.now()


def test_everything_that_is_there_stays_and_costs_no_wait() -> None:
    axes, notes, waited = present(load_profile("sim"))
    assert (axes, notes) == ([*GIMBAL, Axis.FOCUS], [])
    assert waited < 0.1


def test_a_focus_motor_that_is_not_calibrated_takes_focus_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", lambda **_: SimulatedGimbal(focus_calibrated=False))
    axes, [note], waited = present(load_profile("sim"))
    assert axes == GIMBAL
    assert note.startswith("focus left out: the focus motor is not calibrated")
    assert "teleop send focus calibrate auto" in note
    assert waited < 0.2


def test_a_focus_motor_that_does_not_answer_takes_focus_out(monkeypatch: pytest.MonkeyPatch) -> None:
    class WithoutMotor(SimulatedGimbal):
        def receive(self, data: bytes, now: float) -> None:
            if data[12:14] != b"\x0e\x12":  # set and id of every command to the focus motor
                super().receive(data, now)

    monkeypatch.setattr("teleop.devices.rig.SimulatedGimbal", WithoutMotor)
    axes, [note], waited = present(load_profile("sim"))
    assert axes == GIMBAL
    assert note.startswith("focus left out: the focus motor does not answer; plug it in")
    assert waited < 2.2


def test_a_drone_without_a_port_or_keys_takes_its_sticks_out() -> None:
    axes, [note], _ = present(m100())
    assert axes == GIMBAL
    assert note.startswith(f"{' and '.join(STICKS)} left out: ")
    assert note.endswith("then start again")
    assert "\n" not in note


def test_a_gimbal_is_not_optional() -> None:
    with pytest.raises(LinkError, match="no port /dev/teleop-no-such-port"):
        present(load_profile("sim", {"gimbal": "slcan:/dev/teleop-no-such-port"}))


def test_where_nothing_is_left_to_be_moved_the_reason_is_raised(tmp_path: Path) -> None:
    text = Path("profiles/m100.yaml").read_text()
    kept = [
        line for line in text.splitlines() if not line.startswith(("  pan", "  tilt", "  roll", "  - {type: gimbal"))
    ]
    (tmp_path / "rig.yaml").write_text("\n".join(kept))
    with pytest.raises((LinkError, DocumentError)):
        present(load_profile(str(tmp_path / "rig.yaml"), {"drone": NOWHERE, "gimbal": "sim:"}))


def test_a_run_that_is_no_live_one_does_without_nothing() -> None:
    with pytest.raises((LinkError, DocumentError)), open_rig(m100(), VirtualClock()):
        pytest.fail("the drone is not there")
