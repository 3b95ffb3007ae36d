"""A DJI handheld gimbal, a joystick and a YAML file as a motion-control head.

For programs: `plan` is what `teleop check` and `teleop play` begin with. Everything else is the command line's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from teleop.planner.trajectory import Move


def plan(sequence: str | Path, rig: str | Path = "sim") -> Move:
    """The move that a sequence makes on a rig; each a shipped name, or a file.

    `Move.at(t)` is the state of every axis t seconds after the first keyframe's zero, `Move.duration` its length in s;
    of a timelapse it is the rehearsal, at the speed of its clip.
    Raises `teleop.config.document.DocumentError` with a line for each mistake, UnplayableError where the rig cannot.
    """
    from teleop.config.profile import load_profile
    from teleop.sequence.compile import load_performance
    from teleop.timelapse.compile import load_timelapse

    profile = load_profile(str(rig))
    if timelapse := load_timelapse(str(sequence), profile.limits, profile.name):
        return timelapse.rehearsal().move
    return load_performance(str(sequence), profile.limits, profile.name).move
