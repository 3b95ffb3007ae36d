"""OpenTimelineIO (.otio): cues as markers, and back.

The timeline has one clip as long as the move, and on it a marker for each cue, called as the cue is written in a
sequence (`camera: record`), at the frame nearest to it; its exact time stands in its metadata. The clip's metadata has
the path too, so that nothing is lost on the way back; other programs keep metadata. What is read may come from any
editor: markers of timelines, tracks, clips and gaps count at their place in the whole timeline, and one whose name is a
cue becomes that cue. Source: OpenTimelineIO's documentation (Timeline Structure, Time Ranges, Marker), and its library.
"""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.core.plain import plain
from teleop.interchange.companion import facts, file_rate, is_own, meant_rate, title_of
from teleop.interchange.isolated import read_isolated
from teleop.interchange.motion import Motion, TimedCue, number_rows, within_reach
from teleop.interchange.table import Hints, WriteOptions
from teleop.sequence.cues import KINDS, CueSection, cue_rules

BARE: Mapping[str, tuple[str, str]] = {
    "record": ("camera", "record"),
    "rec": ("camera", "record"),
    "stop": ("camera", "stop"),
    "shutter": ("camera", "shutter"),
    "focus": ("camera", "focus"),
    "end_focus": ("camera", "end_focus"),
    "wait": ("wait", "operator"),
}
"""Markers of one word, as people set them in an editor."""
NAMED = re.compile(rf"({'|'.join(KINDS)})\s*[:=]\s*(\S.*?)", re.IGNORECASE | re.DOTALL)
FAR = 1e6  # s


def write(motion: Motion, options: WriteOptions) -> bytes:
    """A timeline of one track and one clip."""
    otio = importlib.import_module("opentimelineio")
    rate = float(motion.known_rate)

    def moment(frame: float) -> Any:
        return otio.opentime.RationalTime(frame, rate)

    known = {
        **facts(motion, options.axes, options.not_carried),
        "units": "degrees; + is right, up, clockwise seen from behind; focus 0..1",
    }
    columns = [motion.times, *(motion.column(axis) for axis in options.axes)]
    clip = otio.schema.Clip(
        name=motion.title,
        source_range=otio.opentime.TimeRange(moment(0), moment(np.ceil(motion.times[-1] * rate - 1e-6) + 1)),
        metadata={"teleop": {**known, "path": np.array(columns).T.tolist()}},
    )
    for cue in motion.cues:
        clip.markers.append(
            otio.schema.Marker(
                name=cue.name,
                marked_range=otio.opentime.TimeRange(moment(round(cue.at * rate)), moment(0)),
                color=otio.schema.MarkerColor.GREEN,
                metadata={"teleop": {"at": cue.at, "cue": dict(cue.content)}},
            )
        )
    timeline = otio.schema.Timeline(name=motion.title, metadata={"teleop": {"made_by": known["made_by"]}})
    track = otio.schema.Track(name=motion.title, kind=otio.schema.TrackKind.Video)
    track.append(clip)
    timeline.tracks.append(track)
    return otio.adapters.write_to_string(timeline, "otio_json").encode()


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """Its cues, and the path if teleop wrote it."""
    return motion_of(read_isolated("otio", raw, ".otio", name), name, hints)


def motion_of(found: Any, name: str, hints: Hints) -> Motion:
    """The path and the cues of what `otio_extract` found in a file."""
    markers = found["markers"]
    cues, strangers = [], []
    for marker in markers:
        if not abs(marker["at"]) < FAR:
            raise DocumentError([f"{name}: marker {plain(marker['name'][:40])!r} is too far away"])
        cue = _cue(marker)
        if cue is None:
            strangers.append(f"marker {plain(marker['name'][:60]) or '(no name)'!r} at {marker['at']:.3f} s: is no cue")
        elif marker["at"] < 0:
            strangers.append(f"cue {cue.name!r} at {marker['at']:.3f} s: is before the start")
        else:
            cues.append(cue)
    cues.sort(key=lambda cue: cue.at)
    rate = hints.rate or meant_rate(found["rate"])
    path = found["path"]
    if not is_own(path):
        return Motion(found["name"][:200], np.zeros(1), {}, rate, cues=cues, remarks=strangers)
    return _with_path(path, name, rate, cues, strangers)


def _with_path(
    path: dict[str, Any], name: str, rate: Fraction | None, cues: list[TimedCue], remarks: list[str]
) -> Motion:
    axes = [Axis(str(each)) for each in path.get("axes", []) if str(each) in [*Axis]]
    rows = number_rows(path.get("path"), len(axes) + 1, name, "the path in the clip's metadata")
    columns = within_reach({axis: rows[:, index] for index, axis in enumerate(axes, 1)}, name)
    exact_rate = file_rate(path.get("frame_rate"), name)
    rate = exact_rate if rate is None or abs(float(rate - exact_rate)) < 1e-6 else rate
    return Motion(title_of(path), rows[:, 0] - rows[0, 0], columns, rate, cues=cues, remarks=remarks)


def _cue(marker: Mapping[str, Any]) -> TimedCue | None:
    """The cue that a marker is; the exact time where its frame was not moved. None for any other marker."""
    own = marker["own"] if isinstance(marker["own"], dict) else {}
    content = own.get("cue")
    at = own.get("at")
    if not isinstance(at, float | int) or abs(at - marker["at"]) > 0.5 / max(marker["rate"], 1.0) + 1e-6:
        at = marker["at"]
    for each in ([content] if isinstance(content, dict) else []) + list(_by_name(marker["name"])):
        if _is_cue(each):
            return TimedCue(float(at), {str(key): str(value) for key, value in each.items()})
    return None


def _by_name(name: str) -> Iterator[Mapping[str, str]]:
    words = name.strip()
    if words.lower() in BARE:
        kind, value = BARE[words.lower()]
        yield {kind: value}
    if found := NAMED.fullmatch(words):
        yield {found[1].lower(): found[2]}
        yield {found[1].lower(): found[2].lower()}


def _is_cue(content: Mapping[Any, Any]) -> bool:
    if not all(isinstance(each, str) and len(each) < 200 for each in (*content, *content.values())):
        return False
    cue = {"at": 0, **content}
    try:
        CueSection.model_validate(cue)
        return "at" not in content and not list(cue_rules(cue, ("cues", 0)))
    except (ValueError, DocumentError):
        return False
