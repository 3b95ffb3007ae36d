"""Reads a sequence file and the files that it includes, with all errors of all of them at once.

A file that is included is checked as if it were played alone, so that nothing that can be wrong with it depends on who
includes it; each error is named where it stands, and where that was included. How many files, and how deep, is
bounded: a few lines can include a million.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from teleop.config.documents.document import (
    Document,
    DocumentError,
    UnplayableError,
    mapping,
    numbered,
    sequence,
)
from teleop.config.documents.yaml_loader import read_document
from teleop.config.file_kinds import refuse_other_kind
from teleop.config.quantities import percentage, seconds
from teleop.config.resources import find, is_bare
from teleop.core.axes import STICKS, Axis, Limits
from teleop.core.events import Action
from teleop.sequence.aim import UnaimedError
from teleop.sequence.model import SequenceModel
from teleop.sequence.rules import file_rules, rig_rules
from teleop.sequence.timelapse_section import is_timelapse
from teleop.sequence.timeline import Block, Origin, Timeline, expand, joined

DEEPEST = 8  # files within files
MOST_FILES = 200  # each counted as often as it is included


@dataclass
class SequenceReader:
    """Reads files for a rig. `problems` are of all of them, `more` only counted; `beyond_rig` are only the rig's."""

    limits: Mapping[Axis, Limits]
    rig: str
    devices: Collection[str] | None = None
    problems: list[str] = field(default_factory=list)
    more: int = 0
    beyond_rig: int = 0
    _files: int = 0
    _documents: dict[Path, Document] = field(default_factory=dict)

    def read(self, path: Path, name: str, note: str = "", chain: tuple[Path, ...] = ()) -> Timeline | None:
        """The file with all that it includes; None where something is wrong, and then `problems` say what.

        `note` ends every line about it; `chain` are the files around it, from the outermost one.
        """
        self._files += 1
        before = len(self.problems)
        try:
            document = self._document(path, name, note)
            refuse_other_kind(document, "sequence")
        except DocumentError as error:
            self.problems += error.problems
            return None
        beyond_rig = list(rig_rules(document.data, self.limits, self.rig, self.devices))
        timeline = None
        try:
            model = document.check(SequenceModel, [*file_rules(document.data), *beyond_rig])
            timeline = Timeline.of(document, model)
        except UnaimedError as error:
            self.problems.append(document.problem(error.place, f": {error}"))
        except DocumentError as error:
            self.problems += error.problems
            self.more += error.more
            self.beyond_rig += len(beyond_rig)
        entries = enumerate(sequence(document.data, "include"))
        included = [self._include(document, index, entry, (*chain, path.resolve())) for index, entry in entries]
        if timeline is None or len(self.problems) > before:
            return None
        blocks = timeline.own_blocks(self.limits)
        for index, inner in enumerate(included):
            if inner is not None:
                self._insert(timeline, index, inner, blocks)
        run_up = self._add_table(timeline, path.parent, blocks)
        if len(self.problems) > before:
            return None
        timeline.keys, overlaps = joined(blocks)
        timeline.cues.sort(key=lambda timed: timed.cue.at)
        self.problems += overlaps or list(expand(timeline, self.limits))
        timeline.move_later(run_up)
        return None if len(self.problems) > before else timeline

    def _document(self, path: Path, name: str, note: str) -> Document:
        """The document in a file, which is parsed once however often it is included. Raises DocumentError."""
        known = self._documents.get(path.resolve())
        if known is None:
            known = self._documents[path.resolve()] = read_document(path, name, note)
        return replace(known, name=name, note=note)

    def _include(self, document: Document, index: int, entry: Any, chain: tuple[Path, ...]) -> Timeline | None:
        """The file that an entry of `include` names."""
        move, here = mapping(entry).get("move"), ("include", index, "move")
        if not isinstance(move, str):
            return None
        try:
            path, name = find(move, "sequences", "sequence", chain[-1].parent)
        except DocumentError as error:
            self.problems.append(document.problem(here, f": {error}"))
            return None
        around = [*chain, path.resolve()]
        if path.resolve() in chain:
            circle = " -> ".join(each.name for each in around[chain.index(path.resolve()) :])
            self.problems.append(document.problem(here, f"includes itself: {circle}"))
        elif len(chain) > DEEPEST:
            self.problems.append(document.problem(here, f"is too deep: at most {DEEPEST} files within files"))
        elif self._files > MOST_FILES:
            if self._files == MOST_FILES + 1:
                self._files += 1  # reported once
                self.problems.append(document.problem(here, f"is too much: at most {MOST_FILES} files can be included"))
        else:
            line, column = document.places["include", index]
            note = f" (included at {document.name}:{line}:{column}){document.note}"
            shown = name if is_bare(move) else str(Path(document.name).parent / move)
            inner = self.read(path, shown, note, chain)
            if inner is not None and is_timelapse(inner.document.data):
                self.problems.append(document.problem(here, "is a timelapse: its times are frames, not seconds"))
            return inner
        return None

    def _add_table(self, timeline: Timeline, folder: Path, blocks: dict[Axis, list[Block]]) -> float:
        """Put the table that a file names in `source` among the blocks; the seconds of its run-up, 0 without one."""
        model, document = timeline.model, timeline.document
        if model.source is None:
            return 0.0
        from teleop.sequence.tables.fitted_table import TableReader

        may_stretch = model.fit == "stretch"
        reader = TableReader(document, model.source, model.fps, folder, self.limits, self.rig, may_stretch)
        try:
            table = reader.read()
        except DocumentError as error:
            self.problems += error.problems
            self.more += error.more
            self.beyond_rig += len(error.problems) if isinstance(error, UnplayableError) else 0
            return 0.0
        own = any(timed.cue.action in (Action.RECORD, Action.STOP) for timed in timeline.cues)
        camera = self.devices is None or "camera" in self.devices
        timeline.add_table(table, blocks, record=model.source.record and camera and not own)
        return table.run_up

    def _insert(self, timeline: Timeline, index: int, inner: Timeline, blocks: dict[Axis, list[Block]]) -> None:
        """Put what `include[index]` names among the blocks."""
        entry, where = timeline.model.include[index], numbered("include", index)
        inserted = inner.inserted_at(seconds(entry.at, timeline.model.fps), percentage(entry.speed), where)
        timeline.places |= inserted.places
        timeline.cues += inserted.cues
        timeline.aims += inserted.aims
        timeline.remarks += inner.remarks
        for axis, of_axis in inserted.frames.items():
            timeline.frames.setdefault(axis, []).extend(of_axis)
        for axis, of_axis in inserted.keys.items():
            place = Origin(timeline.document, ("include", index))
            blocks.setdefault(axis, []).append(Block(of_axis, where, place))
        sticks = [axis for axis in STICKS if axis in inserted.keys]
        if sticks and percentage(entry.speed) != 1:
            text = f"leaves {', '.join(sticks)} as far as they are: the drone flies for another time, and so elsewhere"
            timeline.remarks.append(timeline.document.problem(("include", index, "speed"), text))
