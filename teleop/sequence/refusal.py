"""A refusal as lines at the places of a file: one for each cause, the first of them in full and the others counted."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from teleop.config.documents.document import ENTRIES, UnplayableError, mapping
from teleop.config.quantities import frame_rate, seconds
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.findings import Finding, Infeasible, Overshooting, RampsTooLong, Unsolved
from teleop.sequence.panorama import WHERE, still_seconds
from teleop.sequence.timeline import Origin

IN_FULL = 20  # lines of a refusal: whoever has more of them slows the whole move

Found = Finding | RampsTooLong | Unsolved | Overshooting


def refusal(error: Infeasible, places: Mapping[str, Origin], text: Callable[[Found], str] = str) -> UnplayableError:
    """What is to be raised for a file whose keys, by their `where`, are at these places."""
    lines: dict[object, str] = {}
    for shots in _panoramas(error.findings):
        lines[shots[0].last] = _panorama_line(shots, places[shots[0].last])
    for found in error.findings:
        if not _is_timed_shot(found):
            place = places[found.last]
            # a file that is included twice has each of its mistakes once
            cause = found.axis, id(place.document.data), place.location, places[found.first].location, _had(found)
            lines.setdefault(cause, place.line(text(found)))
    in_order = list(dict.fromkeys(lines.values()))
    return UnplayableError(in_order[:IN_FULL], len(in_order[IN_FULL:]), error.findings)


def _had(found: Found) -> float | None:
    return None if isinstance(found, Unsolved) or found.seconds is None else round(found.seconds, 6)


def _is_timed_shot(found: Found) -> bool:
    """Whether `every` mends it: the way from one shot of a panorama to the next, with the time that it needs."""
    shots = all(ENTRIES[WHERE] in where.rpartition(", ")[2].split() for where in (found.first, found.last))
    return shots and isinstance(found, Finding) and found.shortest is not None


def _panoramas(findings: Sequence[Found]) -> list[list[Finding]]:
    """The findings of each panorama, by the file that it is in."""
    groups: dict[str, list[Finding]] = {}
    for found in findings:
        if isinstance(found, Finding) and _is_timed_shot(found):
            groups.setdefault(found.last.rpartition(", ")[0], []).append(found)
    return list(groups.values())


def _panorama_line(shots: Sequence[Finding], place: Origin) -> str:
    """The `every` that would do for all shots. An included panorama may be played faster than it is written."""
    data = place.document.data
    section, fps = mapping(data, WHERE), frame_rate(mapping(data).get("fps"))
    every, still = seconds(section["every"], fps), still_seconds(section, fps)
    worst = max(shots, key=lambda shot: (shot.shortest or 0.0) / (shot.seconds or 1.0))
    least = still + (every - still) * (worst.shortest or 0.0) / (worst.seconds or 1.0)
    least = math.ceil(least * 1000 - 1000 * SAME_TIME) / 1000
    needs = f"{worst.axis} needs {worst.shortest:.3f} s from {worst.first} to {worst.last}"
    return place.document.problem((WHERE, "every"), f"must be at least {least:g} s, not {every:g} s: {needs}")
