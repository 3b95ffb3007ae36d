"""Ways round on an axis without ends: the short one where that is asked for, a remark where a long one is gone.

Positions are written as -180..180 as often as not, so 170 -> -170 may mean 20 degrees or 340. The keys after a short
way stay in the turn that it led to.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.keys import Key
from teleop.sequence.keys import Keys, frame_of
from teleop.sequence.model import SequenceModel

TURN = 360.0  # deg


def unwrapped(keys: Keys, model: SequenceModel, limits: Mapping[Axis, Limits]) -> Keys:
    """The keys, with those that `through: shortest` leads to in the turn nearest to the key before."""
    return {
        axis: _shortest(of_axis, model) if axis in limits and limits[axis].continuous else of_axis
        for axis, of_axis in keys.items()
    }


def _shortest(keys: Sequence[Key], model: SequenceModel) -> Sequence[Key]:
    turned, offset = list(keys[:1]), 0.0
    for key in keys[1:]:
        position = key.position + offset
        if model.goes_shortest(frame_of(key)):
            nearest = TURN * round((turned[-1].position - position) / TURN)
            offset, position = offset + nearest, position + nearest
        turned.append(replace(key, position=position))
    return turned


def long_ways(keys: Keys, limits: Mapping[Axis, Limits]) -> Iterator[tuple[int, str]]:
    """The number (from 0) of each keyframe that is gone to the long way round, and a line about it."""
    for axis, of_axis in keys.items():
        if axis in limits and limits[axis].continuous:
            for first, last in pairwise(of_axis):
                way = abs(last.position - first.position)
                if TURN / 2 < way < TURN:
                    text = f"{axis} goes {way:g} deg round from {first.where} to {last.where}"
                    yield frame_of(last), f"{text}; with `through: shortest` it goes {TURN - way:g} deg"
