"""A plan for the page: what the planner makes of the text of a move, as curves to draw or as what is wrong where.

The text lies in no file yet, and what it includes does: so it is planned in a folder of its own, with links to the
files that it names. It may only name shipped moves and files of the folder of moves, because it came in a request.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, cast

import numpy as np

from teleop.app.planning import Plan, plan_file
from teleop.config.documents.document import Document, DocumentError, UnplayableError, mapping, sequence
from teleop.config.documents.yaml_loader import parse_document
from teleop.config.named_files import NAME, NamedFiles
from teleop.config.profile import Profile, load_profile
from teleop.config.resources import is_bare
from teleop.console.settings import given
from teleop.core.axes import Axis, Limits
from teleop.core.errors import TeleopError
from teleop.planner.keyframes.findings import Overshooting, Unsolved
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Track
from teleop.plots.numbers import finite
from teleop.sequence.playback import fastest
from teleop.sequence.refusal import Found
from teleop.timelapse.compile import Timelapse

POINTS = 400  # of a curve, beside one at each key
DIGITS = 5
MOST_INTERVALS = 100
TABLES = (".csv", ".chan", ".txt", ".dat", ".arc", ".raw", ".tsv", ".asc")
REFERENCES = (".yaml", ".yml", *TABLES)
_PLACE = re.compile(r":(\d+):(\d+): ")
_KEY = re.compile(r"\bkey (\d+)")


def plan_text(text: str, name: str, folder: str, rig: str) -> dict[str, Any]:
    """The plan of a move called `name` in errors, as JSON: see the reference page of HTTP."""
    title = f"{name}.yaml"
    try:
        document = parse_document(text, title)
        if problems := list(_foreign(document, Path(folder))):
            return _refused(problems, title)
        profile = profile_of(rig)
        with tempfile.TemporaryDirectory() as place:
            file = Path(place) / title
            _link(document, Path(folder), Path(place))
            file.unlink(missing_ok=True)
            file.write_text(text, encoding="utf-8")
            try:
                return _planned(plan_file(str(file), profile), profile)
            except DocumentError as error:
                lines = [line.replace(f"{place}/", "") for line in error.problems]
                found = error.findings if isinstance(error, UnplayableError) else ()
                return _refused(lines, title, cast("Sequence[Found]", found))
    except DocumentError as error:
        return _refused(error.problems, title)
    except TeleopError as error:
        return _refused([str(error)], title)


@lru_cache(maxsize=4)
def profile_of(rig: str) -> Profile:
    """The profile of a rig, read once: one that is given, or has a name, or is a file."""
    return given(rig) or load_profile(rig)


def _foreign(document: Document, folder: Path) -> Iterator[str]:
    """A line for each file that the text names and may not."""
    own = NamedFiles(folder, REFERENCES)
    for path, name in _references(document):
        if not (is_bare(name) and path[0] == "include") and (not NAME.fullmatch(name) or own.find(name) is None):
            yield document.problem(path, f": {name}: no such file in the folder of moves")


def _references(document: Document) -> Iterator[tuple[tuple[str | int, ...], str]]:
    for index, entry in enumerate(sequence(document.data, "include")):
        if isinstance(name := mapping(entry).get("move"), str):
            yield ("include", index, "move"), name
    if isinstance(name := mapping(document.data, "source").get("file"), str):
        yield ("source", "file"), name


def _link(document: Document, folder: Path, place: Path) -> None:
    """Links to the files that the text names."""
    own = NamedFiles(folder, REFERENCES)
    for _, name in _references(document):
        if (file := own.find(name)) is not None and not (place / file.name).exists():
            (place / file.name).symlink_to(file.resolve())


def _planned(plan: Plan, profile: Profile) -> dict[str, Any]:
    compiled, limits = plan.sequence, profile.limits
    keys = sorted({key.at for of_axis in compiled.keys.values() for key in of_axis})
    times = np.union1d(np.linspace(0.0, compiled.move.duration, POINTS), keys)
    most = 1.0 if plan.is_flown else fastest(compiled.move, limits)
    return {
        "ok": True,
        "title": compiled.title,
        "shoot": _shoot(plan.timelapse) if plan.timelapse else None,
        "duration": round(compiled.move.duration, DIGITS),
        "max_speed": round(most, 3),
        "axes": {axis.value: _curve(axis, track, limits[axis], times) for axis, track in compiled.move.tracks.items()},
        "keys": _keys(plan),
        "cues": [{"at": cue.at, "name": cue.name} for cue in compiled.cues],
        "warnings": list(plan.warnings),
    }


def _curve(axis: Axis, track: Track, limits: Limits, times: Array) -> dict[str, Any]:
    position, velocity, _, _ = track.sample(times).round(DIGITS)
    peaks = track.peaks()
    return {
        "unit": axis.unit,
        "minimum": finite(limits.minimum),
        "maximum": finite(limits.maximum),
        "times": times.round(DIGITS).tolist(),
        "positions": position.tolist(),
        "velocities": velocity.tolist(),
        "peak_velocity": round(peaks.velocity, DIGITS),
        "max_velocity": limits.velocity,
        "range": [round(peaks.minimum, DIGITS), round(peaks.maximum, DIGITS)],
    }


def _shoot(timelapse: Timelapse) -> dict[str, Any]:
    """How long it takes, and its intervals, which may grow from frame to frame."""
    slots = timelapse.slots
    frames = np.linspace(0, max(slots.frames - 2, 0), min(slots.frames, MOST_INTERVALS)).round().astype(int).tolist()
    return {
        "frames": timelapse.frames,
        "seconds": round(slots.at(slots.frames), 3),
        "clip_s": None if timelapse.clip is None else round(timelapse.clip, 3),
        "intervals": [round(slots.interval(frame), 3) for frame in frames],
    }


def _keys(plan: Plan) -> list[dict[str, Any]]:
    """The keys of the file by their numbers, with the axes that each has."""
    found: dict[int, dict[str, Any]] = {}
    for axis, of_axis in plan.sequence.keys.items():
        for key in of_axis:
            if number := _number(key.where):
                entry = found.setdefault(number, {"number": number, "at": key.at, "hold": key.hold, "axes": {}})
                entry["axes"].setdefault(axis.value, key.position)
    return [found[number] for number in sorted(found)]


def _refused(lines: Sequence[str], title: str, found: Sequence[Found] = ()) -> dict[str, Any]:
    problems = [_problem(line, title) for line in lines]
    return {
        "ok": False,
        "error": problems[0]["text"] if len(problems) == 1 else f"{problems[0]['text']} (and {len(problems) - 1} more)",
        "problems": problems,
        "segments": [_segment(each) for each in found],
    }


def _problem(line: str, title: str) -> dict[str, Any]:
    """A line of an error with its place taken off; None where it has none, or one in another file."""
    match = _PLACE.search(line)
    if match and line[: match.start()] == title:
        return {"line": int(match[1]), "column": int(match[2]), "text": line[match.end() :]}
    return {"line": None, "column": None, "text": line.removeprefix(f"{title}: ")}


def _segment(found: Found) -> dict[str, Any]:
    seconds = None if isinstance(found, Unsolved) else found.seconds
    shortest = None if isinstance(found, Unsolved) else found.shortest
    first, last = found.first, found.last
    if isinstance(found, Overshooting):
        if found.way is None:
            seconds = shortest = None
        else:
            first, last = found.way
    return {
        "axis": found.axis.value,
        "first": _number(first),
        "last": _number(last),
        "seconds": seconds,
        "shortest": shortest,
        "text": str(found),
    }


def _number(where: str) -> int | None:
    match = _KEY.search(where)
    return int(match[1]) if match else None
