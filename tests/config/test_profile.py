"""Profiles: what is refused, where, all at once; what is shipped."""

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.profile import load_profile
from teleop.config.resources import find, folder
from teleop.core.axes import STICKS, Axis

GOOD = """\
name: Test rig
links: {gimbal: "virtual:test"}
axes:
  pan:   {min: null, max: null, velocity: 120, acceleration: 240, jerk: 1200}
  tilt:
    min: -56
    max: 146
    velocity: 90
    acceleration: 180
    jerk: 900
sinks:
  - {type: gimbal, link: gimbal, mode: position, rate: 50}
"""


def problems_of(tmp_path: Path, old: str, new: str) -> list[str]:
    assert old in GOOD
    file = tmp_path / "rig.yaml"
    file.write_text(GOOD.replace(old, new))
    with pytest.raises(DocumentError) as caught:
        load_profile(str(file))
    return [problem.removeprefix(f"{tmp_path}/") for problem in caught.value.problems]


def test_a_good_profile_gives_the_limits_of_each_axis(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    file.write_text(GOOD)
    limits = load_profile(str(file)).limits
    assert limits[Axis.PAN].continuous
    assert not limits[Axis.TILT].continuous
    assert (limits[Axis.TILT].minimum, limits[Axis.TILT].jerk) == (-56, 900)


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("velocity: 90", "velocity: 0", "rig.yaml:8:15: axes.tilt.velocity must be positive"),
        ("velocity: 90", "velocity: .inf", "rig.yaml:8:15: axes.tilt.velocity must be a finite number, not inf"),
        ("    jerk: 900\n", "", "rig.yaml:6:5: axes.tilt.jerk is missing"),
        ("min: -56", "min: 200", "rig.yaml:6:10: axes.tilt.min must be less than max (146)"),
        (
            "min: -56",
            "min: null",
            "rig.yaml:6:10: axes.tilt.min and max must both be numbers, or both null for a continuous axis",
        ),
        ("name: Test rig", "nme: Test rig", "rig.yaml:1:1: unknown key `nme`; did you mean `name`?"),
        (
            "mode: position",
            "mode: warp",
            "rig.yaml:12:40: sinks[0].mode must be one of position, speed, stick, not 'warp'",
        ),
        ("rate: 50", "rate: true", "rig.yaml:12:56: sinks[0].rate must be a number, not true"),
        ("rate: 50", "rate: 50, signs: {pan: true}", "rig.yaml:12:73: sinks[0].signs.pan must be a number, not true"),
        (
            "rate: 50",
            "rate: 30",
            "rig.yaml:12:56: sinks[0].rate must be one of 1, 2, 4, 5, 10, 20, 25, 50, 100, not 30",
        ),
        (
            "link: gimbal,",
            "link: cable,",
            "rig.yaml:12:26: sinks[0].link must be one of the links (gimbal), not 'cable'",
        ),
        (
            "mode: position, rate: 50",
            "mode: speed, rate: 4",
            "rig.yaml:12:53: sinks[0].rate must be at least 5: a gimbal forgets a speed after 0.5 s",
        ),
        (
            "type: gimbal",
            "type: crane",
            "rig.yaml:12:5: sinks[0] type must be one of gimbal, focus, camera, virtual-rc, flight, not 'crane'",
        ),
        (
            "type: gimbal",
            "type: [1]",
            "rig.yaml:12:5: sinks[0] type must be one of gimbal, focus, camera, virtual-rc, flight, not '[1]'",
        ),
        ("  tilt:\n", "  focus:\n", "rig.yaml:6:5: axes.focus: no sink drives it"),
        (
            "  - {type: gimbal,",
            "  - {type: focus, link: gimbal, rate: 50}\n  - {type: gimbal,",
            "rig.yaml:12:5: sinks[0]: it drives focus, and `axes` has none of them",
        ),
        (
            "rate: 50",
            "rate: 50, mapping: {pitch: tilt, yaw: tilt}",
            "rig.yaml:12:5: sinks[0]: tilt is already driven by sinks[0]",
        ),
        ("rate: 50", "rate: 50, mapping: {pitch: tilt}", "rig.yaml:4:10: axes.pan: no sink drives it"),
        (
            "  - {type: gimbal,",
            "  - {type: gimbal, link: gimbal, mode: speed, rate: 50}\n  - {type: gimbal,",
            "rig.yaml:13:5: sinks[1]: pan is already driven by sinks[0]",
        ),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(tmp_path: Path, old: str, new: str, problem: str) -> None:
    assert problem in problems_of(tmp_path, old, new)


def test_all_errors_come_at_once(tmp_path: Path) -> None:
    file = tmp_path / "rig.yaml"
    text = GOOD.replace("velocity: 90", "velocity: -1").replace("min: -56", "min: 200").replace("virtual:", "virtul:")
    file.write_text(text.replace("link: gimbal,", "link: cable,"))
    with pytest.raises(DocumentError) as caught:
        load_profile(str(file))
    assert [problem.split(":")[1] for problem in caught.value.problems] == ["2", "6", "8", "12"]


@pytest.mark.parametrize("file", sorted(folder("profiles").glob("*.yaml")), ids=lambda file: file.stem)
def test_every_shipped_profile_is_right(file: Path) -> None:
    assert load_profile(file.stem).name


def test_a_bare_name_is_looked_up_and_a_path_is_a_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sim").write_text("not this one")
    assert find("sim", "profiles", "rig")[0].parent == folder("profiles")
    with pytest.raises(DocumentError, match=r"smi: no rig of that name is shipped; did you mean sim\?"):
        load_profile("smi")
    with pytest.raises(DocumentError, match=r"\./rig\.yaml: no such file"):
        load_profile("./rig.yaml")


def test_links_can_be_replaced_by_other_urls() -> None:
    assert load_profile("rs2", {"gimbal": "virtual:x"}).links == {"gimbal": "virtual:x"}
    with pytest.raises(DocumentError) as caught:
        load_profile("rs2", {"gimbal": "nonsense", "drone": "sim:"})
    assert "link drone: rs2.yaml has no such link; it has gimbal" in caught.value.problems
    assert any(problem.startswith("link gimbal: link 'nonsense'") for problem in caught.value.problems)


DRONE = """
name: Drone
links: {drone: "serial:/dev/ttyUSB0@230400", gimbal: "slcan:/dev/ttyACM0"}
axes:
  pan:   {min: -180, max: 180, velocity: 120, acceleration: 240, jerk: 1200}
  stick_roll:  {min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}
  stick_pitch: {min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}
sinks:
  - {type: gimbal, link: gimbal, mode: position, rate: 50}
  - {type: flight, link: drone, mode: velocity-body, full_scale: {horizontal: 3, vertical: 1, yaw: 30}}
"""


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("link: drone", "link: gimbal", "drone.yaml:10:26: sinks[1].link must be the drone's alone, and gimbal is on"),
        ("serial:/dev/ttyUSB0@230400", "slcan:/dev/ttyACM1", "drone.yaml:3:16: links.drone must be a serial line"),
        ("horizontal: 3", "horizontal: 11", "sinks[1].full_scale.horizontal must be at most 10 m/s in this mode"),
        (
            "velocity-body, full_scale: {horizontal: 3",
            "tilt, full_scale: {horizontal: 31",
            "must be at most 30 deg in this mode",
        ),
        ("yaw: 30", "yaw: 101", "sinks[1].full_scale.yaw must be at most 100 deg/s in this mode"),
        ("vertical: 1", "vertical: 4.5", "sinks[1].full_scale.vertical must be at most 4 m/s in this mode"),
        ("velocity-body", "thrust", "sinks[1].mode must be one of velocity-body, velocity-ground, tilt"),
        (
            "flight, link: drone, mode: velocity-body, full_scale:",
            "virtual-rc, link: drone, rate: 50, full_scale:",
            "sinks[1].rate must be one of 20",
        ),
        ("stick_roll:  {min: -1", "stick_roll:  {min: 0.2", "axes.stick_roll is a stick: its min and max must be"),
        ("stick_pitch: {min: -1, max: 1", "stick_pitch: {min: null, max: null", "axes.stick_pitch is a stick"),
    ],
)
def test_what_is_wrong_with_a_drone_is_said_where_it_stands(tmp_path: Path, old: str, new: str, problem: str) -> None:
    (tmp_path / "drone.yaml").write_text(DRONE.replace(old, new))
    with pytest.raises(DocumentError) as caught:
        load_profile(str(tmp_path / "drone.yaml"))
    assert any(problem in each for each in caught.value.problems), caught.value.problems


def test_the_shipped_drones_are_right() -> None:
    assert load_profile("m100").drones == load_profile("sim-drone").drones == {"drone"}


@pytest.mark.parametrize("name", ["m100", "sim-drone"])
def test_the_pad_that_a_shipped_drone_suggests_can_be_used(tmp_path: Path, name: str) -> None:
    text = (folder("profiles") / f"{name}.yaml").read_text()
    before, after = text.split("# inputs:")
    inputs = "".join(line.removeprefix("# ") + "\n" for line in after.splitlines() if line)
    (tmp_path / "rig.yaml").write_text(f"{before}\ninputs:\n{inputs}")
    [pad] = load_profile(str(tmp_path / "rig.yaml")).inputs
    assert {control.axis for control in pad.controls.values() if control} >= set(STICKS)


def test_signs_and_the_order_of_old_firmware_are_checked(tmp_path: Path) -> None:
    text = (folder("profiles") / "rs2.yaml").read_text()
    path = tmp_path / "rig.yaml"
    right = "rate: 50, speed_signs: {roll: -1}, report_signs: {tilt: -1}, legacy_angles: yaw-pitch-roll}"
    path.write_text(text.replace("rate: 50}", right, 1))
    section = load_profile(str(path)).sinks[0]
    assert section.type == "gimbal"
    assert (section.wiring.speed_sign(Axis.ROLL), section.wiring.report_sign(Axis.TILT)) == (-1, -1)
    assert section.legacy_angles == "yaw-pitch-roll"
    for wrong in ("speed_signs: {roll: 2}", "speed_signs: {yaw: -1}", "legacy_angles: pitch-yaw-roll"):
        path.write_text(text.replace("rate: 50}", f"rate: 50, {wrong}}}", 1))
        with pytest.raises(DocumentError, match=wrong.partition(":")[0]):
            load_profile(str(path))
