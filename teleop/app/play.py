"""What a plan needs before it is played: its devices, an operator at the keys, limits wide enough to follow a take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from teleop.app.planning import Plan
from teleop.config.profile import Profile
from teleop.core.errors import UsageError
from teleop.core.events import Action
from teleop.planner.offset_limits import sequence_limits
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Wait
from teleop.sequence.cycle import Cycle
from teleop.sequence.source import SequenceSource


def devices_in_use(plan: Plan, shoots: bool) -> Profile:
    """The plan's rig with only the devices that it moves or that its cues are for, and the camera if it `shoots`."""
    actions = [cue.action for cue in plan.sequence.cues]
    return plan.profile.in_use(plan.axes, [*actions, *([Action.SHUTTER] if shoots else [])])


def waits(sequence: CompiledSequence) -> Sequence[float]:
    """When it waits for the operator, in s."""
    return [cue.at for cue in sequence.cues if isinstance(cue.action, Wait)]


def attended(file: str, sequence: CompiledSequence, keys: bool, virtual: bool) -> CompiledSequence:
    """The sequence without waits on the virtual clock, where no key can end them.

    Raises UsageError for one that would wait for ever: in real time, without keys.
    """
    times = waits(sequence)
    if not times or keys:
        return sequence
    if not virtual:
        raise UsageError(f"{file} waits for the operator at {times[0]:g} s: run it on a terminal")
    return replace(sequence, cues=[cue for cue in sequence.cues if not isinstance(cue.action, Wait)])


def following(profile: Profile) -> Profile:
    """The rig with limits slightly wider than those of a take, so that the planner can follow it exactly."""
    from teleop.recording.replay import followable

    return followable(profile)


def source_of(sequence: CompiledSequence, profile: Profile, share: float, speed: float, cycle: Cycle) -> SequenceSource:
    """The source that plays it with `share` of the rig's limits; raises PlanError where the speed is too high."""
    return SequenceSource(sequence, sequence_limits(profile.limits, share), speed, cycle=cycle)
