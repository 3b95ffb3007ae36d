"""How an axis was found to answer, in a line for people and as an object for programs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from teleop.app.run import RunReport
from teleop.config.response_store import Kept, Key
from teleop.core.axes import Axis
from teleop.core.response import Response

LATE = 0.02  # s: less is not worth a line


def response_words(response: Response) -> str:
    """`0.12 s late (doubt 0.01), gain 0.97, drift 0.2 deg/s`, as far as these were found."""
    doubt = f" (doubt {response.delay_doubt:.1g})" if math.isfinite(response.delay_doubt) else ""
    drift = round(response.drift, 1) + 0.0  # no -0.0
    gain = f", gain {response.gain:.2f}" if math.isfinite(response.gain_doubt) else ""
    drifts = f", drift {drift:.1f} deg/s" if math.isfinite(response.drift_doubt) else ""
    return f"{response.delay:.2f} s late{doubt}{gain}{drifts}"


def response_facts(response: Response) -> Mapping[str, float | None]:
    """In s, deg/s and shares; a doubt is null where nothing is known of it."""
    values = {"delay": response.delay, **response._asdict()}
    return {name: round(value, 5) if math.isfinite(value) else None for name, value in values.items()}


def key_words(key: Key) -> str:
    """The conditions under which a response was found: `mode speed on socketcan, fx3-24mm, firmware 02.02.00.07`."""
    return ", ".join(
        (f"mode {key.mode} on {key.link}", key.payload or "no payload named", f"firmware {key.version or 'unknown'}")
    )


def run_lines(report: RunReport) -> Sequence[str]:
    """What a run found of each axis, and what becomes of it."""
    lines = []
    for axis, response in report.responses.items():
        if axis in report.kept.watched:
            lines += _late(axis, response, _delay(report, axis) or 0.0)
            continue
        then = f"the profile's delay of {delay:g} s counts" if (delay := _delay(report, axis)) is not None else ""
        kept = "kept for the next run" if axis in report.kept.kept else ""
        lines.append("; ".join(filter(None, (f"{axis} answers {response_words(response)}", then, kept))))
    return lines


def _late(axis: Axis, response: Response, delay: float) -> Sequence[str]:
    """Of an axis that is sent positions, where the profile's `delay` (s) is not what it needs."""
    if abs(response.delay - delay) < LATE:
        return []
    return [f"{axis} is {response.delay:.2f} s late: the profile can make up for it, with delay: {response.delay:.2f}"]


def run_facts(report: RunReport) -> Mapping[str, object]:
    """The same for programs, by axis."""
    return {
        axis.value: {
            **response_facts(response),
            "profile_delay": _delay(report, axis),
            "kept": axis in report.kept.kept,
        }
        for axis, response in report.responses.items()
    }


def kept_facts(kept: Kept) -> Mapping[str, object]:
    """What is kept of an axis, with its key, for programs."""
    return {**kept.key._asdict(), "axis": kept.axis.value, **response_facts(kept.response), "found": kept.found}


def _delay(report: RunReport, axis: Axis) -> float | None:
    return report.kept.delays.get(axis)
