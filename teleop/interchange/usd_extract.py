"""What is in a USD file, for `usd`: runs in a process of its own, because the library is not made for hostile files."""

from __future__ import annotations

import importlib
import math
from pathlib import Path
from typing import Any

from teleop.interchange.isolated import ExtractError
from teleop.interchange.motion import MOST_FRAMES

FOCUS = "teleop:focus"
MOST_PRIMS = 100_000
MOST_CAMERAS = 20


def extract(path: Path) -> dict[str, Any]:
    """Its up axis, its rate, what teleop wrote into it, and each camera's rows: time, matrix, focus."""
    sdf, usd, geometry = (importlib.import_module(f"pxr.{name}") for name in ("Sdf", "Usd", "UsdGeom"))
    try:
        layer = sdf.Layer.OpenAsAnonymous(str(path))
    except Exception:  # noqa: BLE001 - the library's own error, of no Python class that could be named
        layer = None
    if layer is None:
        raise ExtractError("is not USD")
    if others := sorted(layer.GetCompositionAssetDependencies()):
        raise ExtractError(f"needs other files ({others[0][:100]}): flatten it first, by usdcat --flatten")
    stage = usd.Stage.Open(layer)
    cameras: list[Any] = []
    for count, prim in enumerate(stage.Traverse()):
        if count > MOST_PRIMS or len(cameras) > MOST_CAMERAS:
            raise ExtractError("is too large: export the camera alone")
        if prim.IsA(geometry.Camera):
            cameras.append(prim)
    own = layer.customLayerData.get("teleop", {})
    return {
        "up": str(geometry.GetStageUpAxis(stage)),
        "rate": float(stage.GetTimeCodesPerSecond()),
        "own": {str(key): str(value) for key, value in own.items()} if isinstance(own, dict) else {},
        "cameras": [_camera(prim, usd, geometry) for prim in cameras],
    }


def _camera(prim: Any, usd: Any, geometry: Any) -> dict[str, Any]:
    focus = prim.GetAttribute(FOCUS)
    has_focus = bool(focus) and focus.HasAuthoredValue()
    rows = []
    cache = geometry.XformCache()
    for time in _times(prim, geometry):
        cache.SetTime(usd.TimeCode(time))
        matrix = cache.GetLocalToWorldTransform(prim)
        position = focus.Get(time) if has_focus else 0.0
        row = [time, *(matrix[i][j] for i in range(4) for j in range(4)), float(position or 0.0)]
        if not all(map(math.isfinite, row)):
            raise ExtractError(f"{prim.GetPath()} has numbers that are not finite at {time:g}")
        rows.append(row)
    return {"path": str(prim.GetPath()), "focus": has_focus, "rows": rows}


def _times(prim: Any, geometry: Any) -> list[float]:
    """Every time at which it, or what it hangs on, has a sample: every frame between those, where all are frames."""
    found: set[float] = set()
    each = prim
    while each and not each.IsPseudoRoot():
        found |= set(geometry.Xformable(each).GetTimeSamples()) if each.IsA(geometry.Xformable) else set()
        each = each.GetParent()
        if len(found) > MOST_FRAMES:
            raise ExtractError(f"has too many time samples: at most {MOST_FRAMES}")
    times = sorted(found)
    if not times:
        return [0.0]
    if not all(map(math.isfinite, times)) or times[-1] - times[0] >= MOST_FRAMES:
        raise ExtractError(f"is too long: at most {MOST_FRAMES} frames")
    if all(time == round(time) for time in times):
        return [float(time) for time in range(round(times[0]), round(times[-1]) + 1)]
    return times
