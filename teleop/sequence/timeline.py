"""What there is to plan: keys and cues of a sequence file, and of all that it includes, on one clock.

A keyframe stands for itself, while a panorama and an included file are blocks: between their first and last key of an
axis nothing else may want that axis. An included file's first and last keys stay the stops that they are when it is
played alone, and so does the evenness of its speed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from teleop.config.document import Document, Location, numbered
from teleop.config.quantities import seconds
from teleop.core.axes import Axis, Limits
from teleop.core.events import Action
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.keys import Key
from teleop.planner.keyframes.repeat import repeated
from teleop.sequence.cues import Cue, moved_rules
from teleop.sequence.keys import SAME, Keys, KeysError, keys_of, recentred
from teleop.sequence.model import SequenceModel
from teleop.sequence.panorama import WHERE, shots

MOST_KEYS = 10_000  # of an axis, every pass of a repeat counted: the planner takes some 10 s for them


class Place(NamedTuple):
    """Where something stands, in one of several files."""

    document: Document
    location: Location

    def line(self, text: str) -> str:
        """A line for something that is said of it elsewhere."""
        return self.document.line(self.location, text)


class Timed(NamedTuple):
    """A cue at its time on the whole clock, in s."""

    cue: Cue
    needs_rest: bool
    place: Place


class Block(NamedTuple):
    """Keys of one axis that stand together; `name` is what errors call them."""

    keys: Sequence[Key]
    name: str
    place: Place

    @property
    def end(self) -> float:
        return self.keys[-1].at + self.keys[-1].hold


@dataclass
class Timeline:
    """A file's keys and cues; `places` are the keys' by their `where`, `remarks` lines for the user."""

    document: Document
    sheet: SequenceModel
    keys: Keys = field(default_factory=dict)
    cues: list[Timed] = field(default_factory=list)
    places: dict[str, Place] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, document: Document, sheet: SequenceModel) -> Timeline:
        """With the file's own cues and places, as yet without keys."""
        script = cls(document, sheet)
        for name, count in (("keyframes", len(sheet.keyframes)), ("cues", len(sheet.cues))):
            script.places |= {numbered(name, index): Place(document, (name, index)) for index in range(count)}
        for index, cue in enumerate(sheet.cues):
            if cue.act is not None:
                place = script.places[numbered("cues", index)]
                script.cues.append(Timed(Cue(seconds(cue.at, sheet.fps), cue.act), cue.needs_rest, place))
        if sheet.panorama:
            place = Place(document, (WHERE,))
            for index, at in enumerate(shots(sheet.panorama, sheet.fps).shutters):
                script.places[numbered(WHERE, index)] = place
                script.cues.append(Timed(Cue(at, Action.SHUTTER), False, place))
        return script

    def own_blocks(self) -> dict[Axis, list[Block]]:
        """The keyframes, each for itself, and a panorama as a whole."""
        blocks = {
            axis: [Block([key], key.where, self.places[key.where]) for key in of_axis]
            for axis, of_axis in keys_of(self.sheet).items()
        }
        if self.sheet.panorama:
            for axis, of_axis in shots(self.sheet.panorama, self.sheet.fps).keys.items():
                blocks.setdefault(axis, []).append(Block(of_axis, WHERE, Place(self.document, (WHERE,))))
        return blocks

    def laid(self, at: float, rate: float, name: str) -> Timeline:
        """As it is within a file that includes it as `name`, from `at` (s) on, `rate` times as fast."""
        tension = self.sheet.tension
        keys = {
            axis: [_laid(key, at, rate, name, tension, key in (of_axis[0], of_axis[-1])) for key in of_axis[:-1]]
            + [_laid(of_axis[-1], at, rate, name, None, True)]
            for axis, of_axis in self.keys.items()
        }
        cues = [timed._replace(cue=timed.cue._replace(at=at + timed.cue.at / rate)) for timed in self.cues]
        places = {f"{name}, {where}": place for where, place in self.places.items()}
        return replace(self, keys=keys, cues=cues, places=places)


def _laid(key: Key, at: float, rate: float, name: str, tension: float | None, stop: bool) -> Key:
    later = key.later(1 / rate)
    own = key.tension if key.tension is not None else tension
    return replace(later, at=at + later.at, stop=stop or key.stop, where=f"{name}, {key.where}", tension=own)


def joined(blocks: Mapping[Axis, list[Block]]) -> tuple[Keys, list[str]]:
    """Each axis's keys in order of time, and a line for each block that wants an axis which another one has."""
    keys, problems = {}, []
    for axis in (axis for axis in Axis if axis in blocks):
        in_order = sorted(blocks[axis], key=lambda block: block.keys[0].at)
        keys[axis] = [key for block in in_order for key in block.keys]
        problems += _overlaps(axis, in_order)
    return keys, problems


def _overlaps(axis: Axis, blocks: Sequence[Block]) -> Iterator[str]:
    last = blocks[0]
    for block in blocks[1:]:
        first = block.keys[0]
        meets = abs(first.at - last.end) < SAME and first.position == last.keys[-1].position
        if first.at < last.end + SAME and not meets:
            text = f"{block.name} must begin after {last.name} ends ({axis}, {last.end:g} s)"
            yield block.place.line(
                text if block.name != last.name else f"{block.name} uses {axis} twice at the same time"
            )
        last = max(last, block, key=lambda each: each.end)


def finish(script: Timeline, limits: Mapping[Axis, Limits]) -> Iterator[str]:
    """Add the passes of a repeat, and the keys of recentre cues; a line for all that cannot be."""
    document, sheet = script.document, script.sheet
    times = sheet.repeat.times if sheet.repeat else 1
    for axis, of_axis in script.keys.items():
        if (count := (len(of_axis) - 1) * times + 1) > MOST_KEYS:
            where = ("repeat", "times") if sheet.repeat else ()
            yield document.problem(where, f"needs {count} keys of {axis}; the maximum is {MOST_KEYS}")
            return
    if sheet.repeat:
        try:
            script.keys = repeated(script.keys, times, sheet.repeat.mode)
        except PlanError as error:
            yield document.problem(("repeat",), str(error))
    centres = [(index, cue) for index, cue in enumerate(sheet.cues) if cue.recenter is not None]
    for index, cue in sorted(centres, key=lambda each: seconds(each[1].at, sheet.fps)):
        at, duration = seconds(cue.at, sheet.fps), seconds(cue.recenter, sheet.fps)
        try:
            script.keys = recentred(script.keys, limits, at, duration, numbered("cues", index))
        except KeysError as error:
            yield document.problem(("cues", index, "recenter"), str(error))
    for index, cue in enumerate(sheet.cues):
        for location, text in moved_rules(cue.model_dump(), ("cues", index), script.keys):
            yield document.problem(location, text)
