"""A script for Blender that makes a camera: quaternions baked by the frame, in Blender's world.

A Blender camera cannot have pan, tilt and roll as Euler channels: its z axis points backwards, and so its roll comes
before the 90 degrees that put it upright. Quaternions say the same attitude in every program. In Blender z is up; the
camera of this script looks along +y where pan is 0. glTF would do too, but its animations are 32-bit floats, which are
1e-5 degrees off. Blender's own F-curves are 32-bit as well; the numbers in the script are not, and are what is read
back. Sources: Blender's Python API (Object.rotation_quaternion, keyframe_insert) and manual (camera, orientation);
glTF 2.0, "Animations".
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.interchange.companion import facts, file_rate, is_own, title_of
from teleop.interchange.motion import CAMERA, Motion, number_rows, within_reach
from teleop.interchange.rotation import head_angles, head_matrices, quaternion_matrices, quaternions, y_up, z_up
from teleop.interchange.table import Hints, WriteOptions

BEGIN, END = "DATA = json.loads(r'''", "''')"

SCRIPT = """\
# A camera for Blender 2.80 and later, made by teleop. Run it: Scripting, Open, Run Script; or blender -P FILE.
# Quaternions are w, x, y, z for each frame, in Blender's world: z is up, and pan 0 looks along +y.
import json

import bpy

{begin}
{data}
{end}


def make(data):
    scene = bpy.context.scene
    rate = data["blender_fps"]
    scene.render.fps, scene.render.fps_base = rate[0], rate[1]
    scene.frame_start, scene.frame_end = data["frames_from"], data["frames_to"]
    camera = bpy.data.objects.new(data["title"][:60] or "teleop", bpy.data.cameras.new("teleop"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.rotation_mode = "QUATERNION"
    if data["vfov"]:
        camera.data.sensor_fit = "VERTICAL"
        camera.data.angle_y = data["vfov"] * 3.141592653589793 / 180
    edit = bpy.context.preferences.edit
    before, edit.keyframe_new_interpolation_type = edit.keyframe_new_interpolation_type, "LINEAR"
    for frame, *quaternion in data["quaternions"]:
        camera.rotation_quaternion = quaternion
        camera.keyframe_insert("rotation_quaternion", frame=frame)
    edit.keyframe_new_interpolation_type = before
    return camera


make(DATA)
"""


def write(motion: Motion, options: WriteOptions) -> bytes:
    """The frames may have fractions: Blender has keys between frames."""
    matrices = z_up(head_matrices(*(motion.column(axis) for axis in CAMERA)))
    rows = np.column_stack([motion.frames, quaternions(matrices)])
    rate = motion.known_rate
    whole = math.ceil(rate)
    known = {
        **facts(motion, options.axes, options.not_carried),
        "units": "quaternions w, x, y, z by frame; z is up, pan 0 looks along +y; angles in degrees",
        "vfov": options.vfov,
        "blender_fps": [whole, float(whole / rate)],
        "frames_from": int(motion.frames[0]),
        "frames_to": math.ceil(motion.frames[-1]),
        "begins_at": [float(motion.column(axis)[0]) for axis in CAMERA],
    }
    lines = [json.dumps(known, ensure_ascii=True)[:-1] + ', "quaternions": [']
    lines.append(",\n".join(json.dumps([round(each, 15) for each in row]) for row in rows.tolist()))
    data = "\n".join([*lines, "]}"]).replace("'", "\\u0027")
    return SCRIPT.format(begin=BEGIN, data=data, end=END).encode()


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """What `write` has put into a script; the script itself is not run."""
    text = raw.decode("utf-8-sig", "replace")
    begin = text.find(BEGIN)
    end = text.find(END, begin)
    if begin < 0 or end < 0:
        text = "is not a script that teleop wrote; export the camera from Blender as USD, and import that"
        raise DocumentError([f"{name}: {text}"])
    try:
        data = json.loads(text[begin + len(BEGIN) : end])
    except (ValueError, RecursionError):
        raise DocumentError(
            [f"{name}:{text[:begin].count(chr(10)) + 1}: its data was changed and is not JSON"]
        ) from None
    return _motion(data, name, hints)


def _motion(data: Any, name: str, hints: Hints) -> Motion:
    if not is_own(data):
        raise DocumentError([f"{name}: its data was not written by teleop"])
    rate = hints.rate or file_rate(data.get("frame_rate"), name)
    rows = number_rows(data.get("quaternions"), 5, name, "quaternions")
    frames = rows[:, 0]
    begins = number_rows([data.get("begins_at", [0, 0, 0])], 3, name, "begins_at")[0].tolist()
    try:
        matrices = y_up(quaternion_matrices(rows[:, 1:]))
    except ValueError as error:
        raise DocumentError([f"{name}: {error}"]) from None
    found = dict(zip(CAMERA, head_angles(matrices, (begins[0], begins[1], begins[2])), strict=True))
    axes = [axis for axis in CAMERA if axis.value in map(str, data.get("axes") or ())] or CAMERA
    positions = within_reach({axis: found[axis] for axis in axes}, name)
    return Motion(title_of(data), (frames - frames[0]) / float(rate), positions, rate, int(frames[0]))
