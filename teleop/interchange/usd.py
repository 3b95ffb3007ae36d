"""A camera in USD (.usda, .usdc, .usd): a matrix for each frame, by Pixar's own library.

The stage has y up and meters; a USD camera looks along -z of its own space, y up, whichever axis is up in the stage.
Matrices are for rows there (v * M), so those of `rotation` are written transposed. Time codes are frames, fractions
for readings between them, `timeCodesPerSecond` is the rate; what is exact (24000/1001) and where the head begins stands
in the layer's custom data. Focus (0..1) is an attribute `teleop:focus`: USD's own focusDistance is a length. Source:
OpenUSD's documentation of UsdGeomCamera, UsdGeomXformable and GfMatrix4d.
"""

from __future__ import annotations

import importlib
import math
import tempfile
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.interchange.companion import facts, file_rate, is_own, meant_rate, title_of
from teleop.interchange.isolated import read_isolated
from teleop.interchange.motion import CAMERA, Motion, number_rows, within_reach
from teleop.interchange.rotation import head_angles, head_matrices, pure, y_up
from teleop.interchange.table import Hints, WriteOptions
from teleop.interchange.usd_extract import FOCUS

CAMERA_PATH = "/camera"
APERTURE = 15.2908  # mm: USD's own default of verticalAperture, which the focal length is relative to


def write(motion: Motion, options: WriteOptions, ending: str = ".usda") -> bytes:
    """Text for .usda, USD's binary form for the others."""
    stage = _stage(motion, options)
    if ending == ".usda":
        return stage.GetRootLayer().ExportToString().encode()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"camera{ending}"
        stage.GetRootLayer().Export(str(file))
        return file.read_bytes()


def _stage(motion: Motion, options: WriteOptions) -> Any:
    gf, sdf, usd, geometry = (importlib.import_module(f"pxr.{name}") for name in ("Gf", "Sdf", "Usd", "UsdGeom"))
    frames = motion.frames.tolist()
    stage = usd.Stage.CreateInMemory(".usda")
    geometry.SetStageUpAxis(stage, geometry.Tokens.y)
    geometry.SetStageMetersPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(float(motion.known_rate))
    stage.SetFramesPerSecond(float(motion.known_rate))
    stage.SetStartTimeCode(frames[0])
    stage.SetEndTimeCode(frames[-1])
    camera = geometry.Camera.Define(stage, CAMERA_PATH)
    stage.SetDefaultPrim(camera.GetPrim())
    if options.vfov:
        camera.CreateVerticalApertureAttr(APERTURE)
        camera.CreateFocalLengthAttr(APERTURE / 2 / math.tan(math.radians(options.vfov) / 2))
    turn = camera.AddTransformOp(geometry.XformOp.PrecisionDouble)
    matrices = np.tile(np.eye(4), (len(frames), 1, 1))
    matrices[:, :3, :3] = head_matrices(*(motion.column(axis) for axis in CAMERA)).transpose(0, 2, 1)
    for frame, matrix in zip(frames, matrices.reshape(-1, 16).tolist(), strict=True):
        turn.Set(gf.Matrix4d(*matrix), frame)
    if Axis.FOCUS in options.axes:
        focus = camera.GetPrim().CreateAttribute(FOCUS, sdf.ValueTypeNames.Double)
        for frame, position in zip(frames, motion.column(Axis.FOCUS).tolist(), strict=True):
            focus.Set(position, frame)
    known = facts(motion, options.axes, options.not_carried)
    known["begins_at"] = ",".join(repr(float(motion.column(axis)[0])) for axis in CAMERA)
    known |= {"axes": ",".join(known["axes"]), "not_carried": "; ".join(known["not_carried"])}
    known["units"] = "degrees, meters, frames"
    stage.GetRootLayer().customLayerData = {"teleop": known}
    return stage


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """The one camera of the file, or the one that `hints` names, at its time samples."""
    ending = Path(name).suffix.lower()
    ending = ending if ending in (".usda", ".usdc", ".usd") else ".usd"
    found = read_isolated("usd", raw, ending, name)
    return motion_of(found, name, hints)


def motion_of(found: Any, name: str, hints: Hints) -> Motion:
    """The path of what `usd_extract` found in a file."""
    camera = _camera(found["cameras"], name, hints.camera)
    own = found["own"] if is_own(found["own"]) else {}
    rate = hints.rate or _rate(found["rate"], own, name)
    rows = number_rows(camera["rows"], 18, name, f"time samples of {camera['path']}")
    try:
        matrices = pure(rows[:, 1:17].reshape(-1, 4, 4)[:, :3, :3].transpose(0, 2, 1))
    except ValueError as error:
        raise DocumentError([f"{name}: {camera['path']}: {error}"]) from None
    if found["up"] == "Z":
        matrices = y_up(matrices)
    angles = head_angles(matrices, hints.start or _begin(own))
    positions = dict(zip(CAMERA, angles, strict=True))
    if camera["focus"]:
        positions[Axis.FOCUS] = rows[:, 17]
    axes = [axis for axis in positions if not own or axis.value in str(own.get("axes")).split(",")] or CAMERA
    times = (rows[:, 0] - rows[0, 0]) / float(rate)
    remarks = ["positions: the camera travels, and a head only turns"] if np.ptp(rows[:, 13:16], axis=0).any() else []
    kept = within_reach({axis: positions[axis] for axis in axes}, name)
    return Motion(title_of(own), times, kept, rate, round(rows[0, 0]), remarks=remarks)


def _camera(cameras: Any, name: str, wanted: str | None) -> Any:
    paths = [each["path"] for each in cameras]
    if not cameras:
        raise DocumentError([f"{name}: has no camera"])
    fitting = [each for each in cameras if wanted in (None, each["path"], each["path"].rpartition("/")[2])]
    if len(fitting) != 1:
        shown = ", ".join(paths[:10])
        wrong = f"has no camera {wanted!r}" if not fitting else f"has {len(fitting)} cameras"
        raise DocumentError([f"{name}: {wrong}: give --camera, one of {shown}"])
    return fitting[0]


def _rate(found: float, own: Any, name: str) -> Fraction:
    if "frame_rate" in own:
        rate = file_rate(own["frame_rate"], name)
        if abs(float(rate) - found) < 1e-6:
            return rate
    meant = meant_rate(found)
    if meant is None:
        raise DocumentError([f"{name}: timeCodesPerSecond must be above 0, and 1000 at most: give --rate"])
    return meant


def _begin(own: Any) -> tuple[float, float, float] | None:
    try:
        pan, tilt, roll = (float(each) for each in str(own.get("begins_at")).split(","))
    except ValueError:
        return None
    return (pan, tilt, roll) if max(abs(pan), abs(tilt), abs(roll)) < 1e6 else None
