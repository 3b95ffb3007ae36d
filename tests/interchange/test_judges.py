"""What is written, as other programs read it: each format by a reader that is none of this program's.

The judges: the physical head (pan turns the world, tilt the pan's right axis, roll the lens), scipy's rotations, the
USD library of Pixar, OpenTimelineIO, Python's csv and ElementTree, and the Blender script run with a Blender that
keeps its orders. Blender 5.0 itself has judged the script, and USD in both directions, by hand: within 3e-7.
"""

from __future__ import annotations

import csv
import importlib
import io
import math
import sys
import types
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from made_motions import CUES, NTSC, content, made_motion
from scipy.spatial.transform import Rotation

from teleop.core.axes import Axis
from teleop.interchange import usd
from teleop.interchange.motion import Motion
from teleop.interchange.table import WriteOptions

MOTION = made_motion()
RIGHT, UP, AHEAD = np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([0, 0, -1.0])


def looks(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Where the lens looks and where its top points, (n, 3) each, y up: from the angles' own definitions."""
    pan, tilt, roll = (np.radians(motion.column(axis)) for axis in (Axis.PAN, Axis.TILT, Axis.ROLL))
    ahead = np.outer(np.cos(pan) * np.cos(tilt), AHEAD) + np.outer(np.sin(pan) * np.cos(tilt), RIGHT)
    ahead += np.outer(np.sin(tilt), UP)
    right = np.outer(np.cos(pan), RIGHT) - np.outer(np.sin(pan), AHEAD)
    level = np.cross(right, ahead)
    return ahead, level * np.cos(roll)[:, None] + right * np.sin(roll)[:, None]


def judged(rotations: np.ndarray) -> None:
    """Matrices (n, 3, 3) for columns, y up and -z ahead, are the attitudes of MOTION."""
    ahead, top = looks(MOTION)
    assert np.abs(rotations @ AHEAD - ahead).max() < 1e-8
    assert np.abs(rotations @ UP - top).max() < 1e-8


def test_chan_by_scipys_euler_angles() -> None:
    rows = np.array([[float(each) for each in line.split()] for line in content("chan", MOTION).decode().splitlines()])
    assert rows.shape == (97, 8)
    assert (rows[:, 0] == 1001 + np.arange(97)).all()
    assert not rows[:, 1:4].any()
    x, y, z = rows[:, 4:7].T
    judged(Rotation.from_euler("zxy", np.array([z, x, y]).T, degrees=True).as_matrix())


@pytest.mark.parametrize("ending", [".usda", ".usdc"])
def test_usd_by_pixars_own_library(ending: str, tmp_path: Any) -> None:
    file = tmp_path / f"camera{ending}"
    file.write_bytes(usd.write(MOTION, WriteOptions(40.0, MOTION.axes), ending))
    core, geometry = (importlib.import_module(f"pxr.{name}") for name in ("Usd", "UsdGeom"))
    stage = core.Stage.Open(str(file))
    assert geometry.GetStageUpAxis(stage) == "Y"
    assert stage.GetTimeCodesPerSecond() == pytest.approx(float(NTSC))
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (1001, 1097)
    camera = geometry.Camera(stage.GetDefaultPrim())
    matrices = [np.array(camera.ComputeLocalToWorldTransform(core.TimeCode(1001 + frame))) for frame in range(97)]
    judged(np.array(matrices)[:, :3, :3].transpose(0, 2, 1))
    assert not np.array(matrices)[:, 3, :3].any()
    lens = camera.GetCamera(core.TimeCode(1001))
    assert lens.GetFieldOfView(lens.FOVVertical) == pytest.approx(40.0, abs=1e-3)
    assert stage.GetRootLayer().customLayerData["teleop"]["frame_rate"] == "24000/1001"


def test_the_blender_script_by_a_blender_that_writes_down_what_it_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[float, list[float]]] = []

    class Object(types.SimpleNamespace):
        def keyframe_insert(self, path: str, *, frame: float) -> None:
            assert (path, self.rotation_mode) == ("rotation_quaternion", "QUATERNION")
            told.append((frame, list(self.rotation_quaternion)))

    def space(**names: object) -> types.SimpleNamespace:
        return types.SimpleNamespace(**names)

    scene = space(render=space(), collection=space(objects=space(link=lambda _camera: None)))
    edit = space(keyframe_new_interpolation_type="BEZIER")
    fake = types.ModuleType("bpy")
    made = space(new=lambda name, data: Object(name=name, data=data))
    fake.__dict__["data"] = space(objects=made, cameras=space(new=lambda _name: space()))
    fake.__dict__["context"] = space(scene=scene, preferences=space(edit=edit))
    monkeypatch.setitem(sys.modules, "bpy", fake)
    exec(compile(content("blender", MOTION), "camera.py", "exec"), {})
    assert scene.render.fps / scene.render.fps_base == pytest.approx(24000 / 1001, abs=1e-12)
    assert (scene.frame_start, scene.frame_end, edit.keyframe_new_interpolation_type) == (1001, 1097, "BEZIER")
    assert [frame for frame, _ in told] == [1001 + frame for frame in range(97)]
    w, x, y, z = np.array([quaternion for _, quaternion in told]).T
    blender = Rotation.from_quat(np.array([x, y, z, w]).T).as_matrix()
    judged(np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]) @ blender)  # x right, y ahead, z up


def test_arcm_by_another_reader_and_its_curves_stay_by_the_path() -> None:
    space = "{http://caliri.com/motion/scene}"
    scene = ElementTree.fromstring(content("arcm", MOTION))
    assert scene.tag == f"{space}scene"
    names = [(axis.get("name"), axis.get("units")) for axis in scene.findall(f"{space}axis")]
    assert names == [("pan", "deg"), ("tilt", "deg"), ("roll", "deg"), ("focus", None)]
    for axis in scene.findall(f"{space}axis"):
        points, handles = (
            np.array([[float(each.get("x") or ""), float(each.get("y") or "")] for each in axis.findall(space + kind)])
            for kind in ("points", "controlPoints")
        )
        path = MOTION.positions[Axis(str(axis.get("name")))]
        assert (points[:, 0] == 1001 + np.arange(97)).all()
        assert np.abs(points[:, 1] - path).max() < 1e-8
        assert len(handles) == 2 * (len(points) - 1)
        middles = (points[:-1] + 3 * handles[::2] + 3 * handles[1::2] + points[1:]) / 8  # of each Bezier curve
        assert np.abs(middles[:, 0] - points[:-1, 0] - 0.5).max() < 1e-8
        assert np.abs(middles[:, 1] - (points[:-1, 1] + points[1:, 1]) / 2).max() < np.abs(np.diff(path)).max() / 2


def test_csv_by_pythons_own_reader() -> None:
    rows = list(csv.DictReader(io.StringIO(content("csv", MOTION).decode())))
    assert list(rows[0]) == ["frame", "time", "pan", "tilt", "roll", "focus"]
    for axis, path in MOTION.positions.items():
        assert np.abs(np.array([float(row[axis.value]) for row in rows]) - path).max() < 1e-8
    assert float(rows[-1]["time"]) == pytest.approx(96 * 1001 / 24000, abs=1e-8)


def test_a_raw_move_has_twelve_characters_and_four_blanks_a_column() -> None:
    lines = content("raw", MOTION).decode().splitlines()
    assert len(lines) == 97
    for row, line in enumerate(lines):
        cells = [line[place : place + 16] for place in range(0, len(line), 16)]
        assert len(cells) == 4
        assert all(len(cell) == 16 and cell.endswith("    ") for cell in cells)
        for cell, path in zip(cells, MOTION.positions.values(), strict=True):
            assert float(cell) == pytest.approx(path[row], abs=1e-6)


def test_kuper_names_its_axes_in_the_first_line_and_ends_lines_as_dos_does() -> None:
    first, *rows = content("kuper", MOTION).decode().split("\r\n")
    assert first == "Axes = Pan, Tilt, Roll, Focus"
    assert rows.pop() == ""
    assert [len(row.split()) for row in rows] == [4] * 97
    assert float(rows[0].split()[0]) == 190.0


def test_markers_by_opentimelineio() -> None:
    otio = importlib.import_module("opentimelineio")
    timeline = otio.adapters.read_from_string(content("otio", MOTION).decode(), "otio_json")
    (clip,) = timeline.find_clips()
    assert clip.duration() == otio.opentime.RationalTime(97, float(NTSC))
    names = [marker.name for marker in clip.markers]
    assert names == ["camera: record", "wait: operator", "camera: stop"]
    for marker, cue in zip(clip.markers, CUES, strict=True):
        start = marker.marked_range.start_time
        assert start.rate == float(NTSC)
        assert abs(start.to_seconds() - cue.at) <= 0.5 / float(NTSC)
        assert marker.metadata["teleop"]["at"] == cue.at


@pytest.mark.parametrize(("axis", "moved"), [(Axis.PAN, RIGHT), (Axis.TILT, UP)])
def test_plus_is_right_and_up(axis: Axis, moved: np.ndarray) -> None:
    motion = Motion("", np.zeros(1), {axis: np.array([90.0])}, NTSC)
    assert looks(motion)[0][0] == pytest.approx(moved)


def test_plus_roll_leans_the_top_to_the_right() -> None:
    motion = Motion("", np.zeros(1), {Axis.ROLL: np.array([math.degrees(math.pi / 2)])}, NTSC)
    assert looks(motion)[1][0] == pytest.approx(RIGHT)
