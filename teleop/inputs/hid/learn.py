"""Finds the control that was just moved: the part of `live --learn` without a device, a question or a file.

The controls are watched from where they rest: the one that moves the furthest is meant. A stick leans on its neighbor
and a trigger often has a button beside it, so that a question for an axis waits a moment for something that can be half
way before it takes a button, and a question for a button the other way round. Whether a control springs back or stays
where it was put is seen when it is let go.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from enum import Enum
from typing import NamedTuple

from teleop.config.inputs_section import DIRECTIONS, ControlSection
from teleop.inputs.hid.state import Change, Sample
from teleop.inputs.stick_shaping import NEAR

FAR = 0.3  # of its range, to be meant: a stick pushed more than half way
SECOND_CHOICE = 0.5  # s until something of the other kind is taken
CLICKS = 3  # of a wheel, to be meant
COUNTER_RESTS = 1.0  # s in which a wheel that sends a counter stays where its clicks have brought it
MOVEMENT = 0.02  # of its range: more is a movement
RESTS = 0.25  # of its range from its middle: a stick
_TURNED = re.compile(r"(?:.*: )?(?:Dial|Wheel)(?: \d+)?")  # what may be turned without end


class Kind(Enum):
    """How a control answered."""

    STICK = "stick"  # rests in its middle
    TRIGGER = "trigger"  # rests at an end
    BUTTON = "button"
    WHEEL = "wheel"  # counts
    COUNTER = "counter"  # counts, by a number that runs on
    LEVER = "lever"  # stays where it is put


class Found(NamedTuple):
    """The control that was meant; `towards`: 1 when its value rose, -1 when it fell."""

    name: str
    kind: Kind
    towards: int


class Watch:
    """Controls watched from `rest` on, s on any clock; `smooth`: something that can be half way is meant.

    `known` is what a shipped mapping says of some: their true range, and which of them are counters.
    """

    def __init__(
        self, rest: Mapping[str, Sample], smooth: bool, known: Mapping[str, ControlSection] | None = None
    ) -> None:
        self._known = known or {}
        self._rest = {name: self._true(name, sample) for name, sample in rest.items()}
        self._smooth = smooth
        self._counted: dict[str, float] = {}
        self._turning = {name: _Turning(sample) for name, sample in self._rest.items()}
        self._since = math.inf  # when something of the other kind was moved

    def see(self, values: Mapping[str, Sample], changes: Iterable[Change], now: float) -> Found | None:
        """The control that is meant, once that is clear."""
        for change in changes:
            if change.sample.relative:
                self._counted[change.name] = self._counted.get(change.name, 0.0) + change.sample.value
        values = {name: self._true(name, sample) for name, sample in values.items() if not is_hat(name, values)}
        if turned := self._turned(values, now):
            return turned
        moved = {name: self._moved(name, sample) for name, sample in values.items() if not self._runs_on(name)}
        smooth = {name: far for name, far in moved.items() if not _is_button(values[name])}
        abrupt = {name: far for name, far in moved.items() if name not in smooth}
        first, second = (smooth, abrupt) if self._smooth else (abrupt, smooth)
        if found := _furthest(first):
            return self._found(found, first[found], values)
        if found := _furthest(second):
            self._since = min(self._since, now)
            if now - self._since >= SECOND_CHOICE:
                return self._found(found, second[found], values)
        return None

    def settled(self, found: Found, values: Mapping[str, Sample]) -> Found:
        """The same, looked at again after it was let go: what has not gone back is a lever."""
        if found.kind in (Kind.BUTTON, Kind.WHEEL, Kind.COUNTER):
            return found
        away = abs(self._moved(found.name, self._true(found.name, values[found.name])))
        return found._replace(kind=Kind.LEVER) if away >= FAR else found

    def was_released(self, found: Found, values: Mapping[str, Sample]) -> bool:
        """Whether it only came to its middle from where a hand had held it before."""
        if found.kind in (Kind.BUTTON, Kind.WHEEL, Kind.COUNTER):
            return False
        sample = self._true(found.name, values[found.name])
        return _is_near_middle(sample, NEAR / 2) and not _is_near_middle(self._rest[found.name], NEAR / 2)

    def _turned(self, values: Mapping[str, Sample], now: float) -> Found | None:
        """A counter that has been turned on by enough clicks."""
        for name, sample in values.items():
            if sample.null or not _may_turn(name, sample):
                continue
            turning = self._turning.setdefault(name, _Turning(sample))
            turning.see(sample.value, now)
            if abs(turning.clicks) >= CLICKS and (self._is_counter(name) or turning.is_counter(now)):
                return Found(name, Kind.COUNTER, 1 if turning.clicks > 0 else -1)
        return None

    def _runs_on(self, name: str) -> bool:
        """Whether its value is no place: that of a counter, or of what may be one."""
        return self._is_counter(name) or (name in self._turning and self._turning[name].wrapped)

    def _is_counter(self, name: str) -> bool:
        return name in self._known and self._known[name].value_type == "counter"

    def _true(self, name: str, sample: Sample) -> Sample:
        """With the range that is known of it."""
        ends = self._known[name].range if name in self._known else None
        return sample._replace(minimum=min(ends), maximum=max(ends)) if ends else sample

    def _moved(self, name: str, sample: Sample) -> float:
        """How far it is from its rest, as a share of its range, a wheel by its clicks; 1 is far."""
        if sample.relative:
            return self._counted.get(name, 0.0) * FAR / CLICKS
        rest = self._rest.setdefault(name, sample._replace(value=0) if _is_button(sample) else sample)
        if _is_button(sample) and not sample.pressed:
            self._rest[name] = rest = sample  # a switch that was on: only its next press is meant
        span = sample.maximum - sample.minimum
        return 0.0 if sample.null or rest.null or span <= 0 else (sample.value - rest.value) / span

    def _found(self, name: str, far: float, values: Mapping[str, Sample]) -> Found:
        sample = values[name]
        if sample.relative:
            kind = Kind.WHEEL
        elif _is_button(sample):
            kind = Kind.BUTTON
        else:
            kind = Kind.STICK if _is_near_middle(self._rest[name], RESTS) else Kind.TRIGGER
        return Found(name, kind, 1 if far > 0 else -1)


class _Turning:
    """A wheel that may send a counter: single steps that stay, round and round."""

    def __init__(self, sample: Sample) -> None:
        self._at, self._turn = sample.value, abs(sample.maximum - sample.minimum) + 1
        self.clicks, self._longest, self._since = 0.0, 0.0, -math.inf
        self._wrapped = False

    @property
    def wrapped(self) -> bool:
        """Whether it has gone from one end of its range to the other, in single steps."""
        return self._wrapped and self._longest <= 1

    def see(self, value: float, now: float) -> None:
        step = (value - self._at + self._turn / 2) % self._turn - self._turn / 2
        if step:
            self._wrapped = self._wrapped or step != value - self._at
            self.clicks, self._longest, self._since = self.clicks + step, max(self._longest, abs(step)), now
        self._at = value

    def is_counter(self, now: float) -> bool:
        return self._longest <= 1 and now - self._since >= COUNTER_RESTS


def still(before: Mapping[str, Sample], after: Mapping[str, Sample], switches: bool = False) -> bool:
    """Whether nothing has moved between two looks, and no button is held, which `switches` may be."""
    return not any(_restless(name, sample, before, after, switches) for name, sample in after.items())


def is_hat(name: str, names: Iterable[str]) -> bool:
    """Whether it is a hat, which is watched by its directions."""
    return f"{name} {DIRECTIONS[0]}" in names


def _restless(
    name: str, sample: Sample, before: Mapping[str, Sample], after: Mapping[str, Sample], switches: bool
) -> bool:
    if sample.relative or is_hat(name, after):
        return False
    moved = abs(sample.value - before.get(name, sample).value)
    if _is_button(sample):
        return bool(moved) or (sample.pressed and not switches)
    return moved > MOVEMENT * abs(sample.maximum - sample.minimum)


def _furthest(moved: Mapping[str, float]) -> str | None:
    name = max(moved, key=lambda name: abs(moved[name]), default=None)
    return name if name is not None and abs(moved[name]) >= FAR else None


def _is_button(sample: Sample) -> bool:
    return not sample.relative and sample.maximum - sample.minimum == 1


def _is_near_middle(sample: Sample, share: float) -> bool:
    middle = (sample.minimum + sample.maximum) / 2
    return abs(sample.value - middle) <= share * (sample.maximum - sample.minimum)


def _may_turn(name: str, sample: Sample) -> bool:
    return not sample.relative and not _is_button(sample) and bool(_TURNED.fullmatch(name))
