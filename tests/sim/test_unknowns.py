"""What is not known of real gimbals is a setting of the simulated one: in a profile, by `teleop sim`, in a table."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import pytest
from sim_bench import Bench

from teleop.cli.sim_dynamics import DynamicsSim
from teleop.cli.sim_options import GIMBAL_DEFAULTS, GimbalSim
from teleop.config.profile import Profile, load_profile
from teleop.config.simulated_section import SimulatedSection
from teleop.core.errors import UsageError
from teleop.devices.gimbal.profile_firmware import profile_firmware
from teleop.devices.gimbal.profile_simulation import simulated_firmware, simulated_settings
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind
from teleop.dji.message import Result, ReturnCode
from teleop.sim.gimbal.firmware import DOCUMENTED, Firmware

ANGLES = gimbal.Angles(AngleKind.ATTITUDE)
TURN = gimbal.Speed(30.0, 0.0, 10.0, take_over=True, ignore_focal_length=True)
PAGE = Path(__file__).parents[2] / "docs" / "explanation" / "untested.md"
PROFILE = """
name: Unknown
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 1200}
  tilt: {min: -56,  max: 146, velocity: 60, acceleration: 180, jerk: 900}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50, simulated: {SIMULATED}}]
"""


def profile(folder: Path, simulated: str) -> Profile:
    path = folder / "rig.yaml"
    path.write_text(PROFILE.replace("SIMULATED", simulated))
    return load_profile(str(path))


def test_a_reply_may_come_late() -> None:
    bench = Bench(firmware=Firmware(reply_delay=0.05))
    frame, _ = bench.host.request(ANGLES, bench.now)
    bench.gimbal.receive(frame, bench.now)
    bench.wait(0.04)
    bench.now += 0.01
    assert [type(message) for message in bench.listen()] == [gimbal.AnglesReply]


def test_questions_for_angles_may_stay_without_a_reply_while_pushes_come() -> None:
    bench = Bench(firmware=Firmware(silent_angles=True))
    bench.tell(ANGLES)
    bench.wait(0.5)
    assert bench.unasked == []
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.wait(0.25)
    assert len(bench.unasked) == 2


def test_pushes_may_never_come() -> None:
    bench = Bench(firmware=Firmware(silent_pushes=True))
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.wait(1.0)
    assert bench.unasked == []


@pytest.mark.parametrize(
    ("firmware", "roll", "pitch"),
    [
        (Firmware(bare_replies=True), 2.0, 3.0),
        (Firmware(bare_replies=True, legacy_order="yaw-pitch-roll"), 3.0, 2.0),
        (Firmware(legacy_order="yaw-pitch-roll"), 2.0, 3.0),
        (Firmware(legacy_order="all-yaw-pitch-roll"), 3.0, 2.0),
    ],
)
def test_pitch_and_roll_may_be_exchanged_in_bare_replies_or_in_all(
    firmware: Firmware, roll: float, pitch: float
) -> None:
    reply = Bench(boot=(1.0, 2.0, 3.0), firmware=firmware).ask(ANGLES)
    assert isinstance(reply, gimbal.AnglesReply)
    assert (reply.roll, reply.pitch) == (roll, pitch)


def test_a_position_beyond_a_stop_may_be_refused() -> None:
    bench = Bench(firmware=Firmware(beyond_stop="refuse"))
    bench.ask(gimbal.SetLimits(20, 20, 30, 30, 10, 10))
    reply = bench.ask(gimbal.Position(10.0, 0.0, 25.0, absolute=True, time_for_action=0.5))
    assert isinstance(reply, Result)
    assert reply.return_code == ReturnCode.FAILED
    bench.wait(1.0)
    assert bench.gimbal.angles == (0, 0, 0)
    bench.ask(gimbal.Position(10.0, 0.0, 15.0, absolute=True, time_for_action=0.5))
    bench.wait(1.0)
    assert bench.gimbal.angles == pytest.approx((10.0, 0.0, 15.0))


def test_a_position_under_speed_control_may_be_ignored() -> None:
    bench = Bench(firmware=Firmware(position_under_speed="ignore"))
    bench.ask(TURN)
    bench.ask(gimbal.Position(-40.0, 0.0, 0.0, absolute=True, time_for_action=0.5))
    bench.wait(0.4)
    assert bench.gimbal.angles.yaw > 5


def test_full_deflection_may_have_another_speed() -> None:
    bench = Bench(firmware=Firmware(stick_speed=(20.0, 30.0, 40.0)))
    bench.tell(gimbal.Joystick(15000, 0, 15000))
    bench.wait(0.45)
    assert bench.gimbal.rates == pytest.approx((20.0, 0.0, 40.0), abs=0.1)


def test_automatic_tuning_may_need_its_type() -> None:
    bench = Bench(firmware=Firmware(autotune_needs_type=True))
    for kind, code in ((0, ReturnCode.FAILED), (1, ReturnCode.OK)):
        reply = bench.ask(gimbal.Calibrate(True, kind))
        assert isinstance(reply, Result)
        assert reply.return_code == code


def test_a_profile_sets_the_firmware(tmp_path: Path) -> None:
    made = profile(
        tmp_path,
        "ignore_speed: true, speed_signs: {pan: -1}, stick_speed: {tilt: 40}, pitch_max: 155, legacy_replies: true,"
        " legacy_order: yaw-pitch-roll, push_rate: 1, reaction: 0.1, focus_motor: absent",
    )
    firmware = Firmware(
        ignores_speed=True,
        speed_signs=(-1, 1, 1),
        stick_speed=(60.0, 30.0, 40.0),
        pitch_max=155,
        legacy_replies=True,
        legacy_order="yaw-pitch-roll",
        focus_motor="absent",
    )
    assert simulated_firmware(made, "gimbal") == profile_firmware(made, "gimbal") == firmware
    settings = simulated_settings(made, "gimbal")
    assert (settings["push_rate"], settings["reaction"]) == (1.0, 0.1)
    assert simulated_firmware(profile(tmp_path, ""), "gimbal") is DOCUMENTED


def test_options_overrule_the_profile_and_leave_the_rest_of_it() -> None:
    base = Firmware(short_push=True, pitch_max=155, stick_speed=(1.0, 2.0, 3.0))
    options = GimbalSim(pitch_max=150, ignore_speed=True, stick_speed="yaw=90", report_signs="pitch=-1")
    made = options.made({"push_rate": 2.0}, base)._firmware
    assert made.short_push
    assert made.ignores_speed
    assert (made.pitch_max, made.stick_speed, made.report_signs) == (150, (90.0, 30.0, 60.0), (1, 1, -1))
    assert GIMBAL_DEFAULTS.made({}, base)._firmware == base
    with pytest.raises(UsageError, match=r"--stick-speed must be above 0 and at most 360 deg/s, not 0"):
        GimbalSim(stick_speed="0").made()
    with pytest.raises(UsageError, match=r"--reply-delay must be 0\.\.1 s, not 2"):
        GimbalSim(reply_delay=2).made()


def test_the_profile_and_teleop_sim_have_the_same_settings() -> None:
    options: set[str] = {each.name for cls in (GimbalSim, DynamicsSim) for each in fields(cls)}
    assert options | {"adapter_reset"} == set(SimulatedSection.model_fields), "only a port of one's own can go"


def test_the_page_names_every_setting() -> None:
    page = PAGE.read_text(encoding="utf-8")
    named = set(re.findall(r"`([a-z_]+)(?:`|:)", page))
    assert set(SimulatedSection.model_fields) <= named
