"""What is kept of how the axes of rigs answer, for `teleop doctor`."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

from teleop.cli.doctor.finding import Finding, Findings, State
from teleop.cli.screens.response_lines import key_words, response_words
from teleop.config.response_store import Kept, ResponseStore, default_folder
from teleop.core.errors import TeleopError


def kept_responses() -> tuple[Sequence[Kept], str]:
    """What is kept, of all rigs; and a line about what cannot be read, "" without any."""
    try:
        store = ResponseStore(default_folder())
    except TeleopError as error:
        return [], str(error)
    return store.read(), store.damage


def responses() -> Findings:
    """A line for each rig, gimbal, link, mode and payload."""
    kept, damage = kept_responses()
    for key, of_key in groupby(kept, key=lambda each: each.key):
        axes = [f"{each.axis} {response_words(each.response)}" for each in of_key]
        yield Finding("response", State.OK, f"{key.rig}, {key_words(key)}: {'; '.join(axes)}")
    if damage:
        found, _, cure = damage.rpartition(": ")
        yield Finding("response", State.PROBLEM, found, cure)
    if not kept and not damage:
        yield Finding("response", State.OK, "none kept: a run in mode speed or stick finds how its axes answer")
