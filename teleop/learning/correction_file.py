"""A correction as a JSON file beside its take: written whole or not at all, and read with every doubt.

It moves a rig, so that one that was edited or cut short is refused: `checksum` is of all the rest.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.config.files import write_text
from teleop.core.axes import Axis
from teleop.learning.correction import Correction, Error, PassFigures
from teleop.planner.trajectory import Track

FORMAT, VERSION = "teleop learned passes", 1
ENDING = ".learned.json"
STATE = ("position", "velocity", "acceleration")
PLACES = (9, 8, 7)  # decimals: an error of position has ten million times its size in the jerk


def write_correction(path: Path, correction: Correction) -> None:
    """Raises OutputError."""
    content = _content(correction)
    write_text(path, json.dumps({**content, "checksum": _checksum(content)}, indent=1) + "\n")


def read_correction(path: Path) -> Correction:
    """Raises DocumentError, with one line, for a file that is no correction or is damaged."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DocumentError([f"{path}: cannot be read: {error.strerror or error}"]) from None
    except ValueError:
        raise DocumentError(
            [f"{path}: damaged, or not a file of learned passes: learn it again with --learn"]
        ) from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise DocumentError([f"{path}: not a file of learned passes: it is what --learn writes"])
    if content.get("version") != VERSION:
        raise DocumentError([f"{path}: has version {content.get('version')}, this program reads {VERSION}"])
    checksum = content.pop("checksum", None)
    if checksum != _checksum(content):
        raise DocumentError([f"{path}: damaged or edited: learn it again with --learn"])
    try:
        return _correction(content)
    except (ValueError, KeyError, TypeError, AttributeError, IndexError):
        raise DocumentError([f"{path}: damaged: learn it again with --learn"]) from None


def _content(correction: Correction) -> dict[str, Any]:
    axes = {axis.value: _offset(axis, track, correction.best[axis]) for axis, track in correction.offsets.items()}
    passes = [
        {
            "pass": each.number,
            "ignored": each.ignored,
            "axes": {axis.value: _rounded(error) for axis, error in each.errors.items()},
        }
        for each in correction.passes
    ]
    about = {"rig": correction.rig, "title": correction.title, "sequence": correction.sequence}
    return {"format": FORMAT, "version": VERSION, **about, "axes": axes, "passes": passes}


def _offset(axis: Axis, track: Track, best: int) -> Mapping[str, Any]:
    """An offset by its states at its breaks; between these it is the quintic through them."""
    starts = track.coefficients[:, :3] * (1, 1, 2)
    states = np.vstack([starts, [track.end, 0.0, 0.0]]).T
    rows = {
        name: [round(value, places) for value in row]
        for name, places, row in zip(STATE, PLACES, states.tolist(), strict=True)
    }
    times = [round(time, 9) for time in track.breaks.tolist()]
    return {"unit": axis.unit or "0..1", "best_pass": best, "times": times, **rows}


def _rounded(error: Error) -> Mapping[str, float]:
    return {name: round(value, 6) for name, value in asdict(error).items()}


def _correction(content: Mapping[str, Any]) -> Correction:
    offsets, best = {}, {}
    for name, of_axis in content["axes"].items():
        times, states = np.array(of_axis["times"], float), np.array([of_axis[row] for row in STATE], float)
        if states.shape != (3, len(times)) or len(times) < 2 or not (np.diff(times) > 0).all():
            raise ValueError("not a time for each state")
        if not np.isfinite(states).all() or states[:, [0, -1]].any():
            raise ValueError("it does not begin and end at rest")
        offsets[Axis(name)] = Track.through(times, states)
        best[Axis(name)] = int(of_axis["best_pass"])
    passes = [
        PassFigures(
            int(each["pass"]),
            {Axis(name): Error(**error) for name, error in each["axes"].items()},
            str(each["ignored"]),
        )
        for each in content["passes"]
    ]
    return Correction(content["rig"], content["title"], content["sequence"], offsets, best, passes)


def _checksum(content: Mapping[str, Any]) -> str:
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
