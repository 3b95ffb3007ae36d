"""Plans a sequence for a rig: a shipped one, a file, a recorded run, or the content of a file as a dict."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.config.profile import Profile
from teleop.config.resources import is_bare
from teleop.core.axes import Axis
from teleop.core.errors import UsageError
from teleop.recording import ENDING
from teleop.sequence.compile import CompiledSequence, load_sequence

if TYPE_CHECKING:
    from teleop.timelapse.compile import Timelapse

CONTENT = "sequence"  # what a dict is called in errors


@dataclass(frozen=True)
class Plan:
    """`sequence` planned for the rig of `profile`; of a `timelapse` it is the rehearsal."""

    profile: Profile
    sequence: CompiledSequence
    timelapse: Timelapse | None = None

    @property
    def axes(self) -> list[Axis]:
        return list(self.sequence.move.tracks)

    @property
    def is_flown(self) -> bool:
        """Whether it moves a drone's sticks."""
        return any(axis.is_stick for axis in self.sequence.move.tracks)

    @property
    def warnings(self) -> Sequence[str]:
        """What the planner remarks on, a line each: of a timelapse those of the shoot, not of its rehearsal."""
        return self.sequence.warnings if self.timelapse is None else self.timelapse.warnings


def plan_file(file: str, profile: Profile, share: float = 1.0, by_hand: bool = False) -> Plan:
    """The sequence or take called `file`, which may use `share` of the rig's velocity, acceleration and jerk.

    `by_hand`: an operator shoots each frame of a timelapse, in no interval.
    Raises DocumentError with a line for each mistake in the file; UnplayableError when only the rig is in the way.
    """
    try:
        return _planned(file, profile, share, by_hand)
    except UnplayableError as error:
        if share == 1:
            raise
        raise UnplayableError(
            [*error.problems, f"{file}: was planned with {share:.0%} of the rig's limits"], error.more
        ) from None


def plan_content(content: Mapping[str, Any], profile: Profile) -> Plan:
    """As `plan_file`, of a dict: it is written as YAML and read as a file, so that every check and default is the same.

    Relative paths in it begin at the current folder. Raises UsageError for a value that no file can hold.
    """
    import yaml

    try:
        text = yaml.safe_dump(_from_here(_plain(content)), sort_keys=False)
    except yaml.YAMLError as error:
        raise UsageError(f"{CONTENT}: {' '.join(map(str, error.args))}") from None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{CONTENT}.yaml"
        file.write_text(text, encoding="utf-8")
        try:
            return plan_file(str(file), profile)
        except DocumentError as error:
            place = re.compile(rf"{re.escape(str(file))}(:\d+:\d+)?")  # a dict has no lines
            problems = [place.sub(CONTENT, problem) for problem in error.problems]
            raise type(error)(problems, error.more) from None


def is_take(file: str) -> bool:
    """Whether this is a recording, not a sequence: by its ending."""
    return Path(file).suffix.lower() == ENDING


def _planned(file: str, profile: Profile, share: float, by_hand: bool) -> Plan:
    limits = {axis: of_axis.scaled(share) for axis, of_axis in profile.limits.items()}
    if is_take(file):
        from teleop.recording.replay import take_performance

        return Plan(profile, take_performance(Path(file), limits, profile.name))
    from teleop.timelapse.compile import load_timelapse

    if timelapse := load_timelapse(file, limits, profile.name, by_hand):
        return Plan(profile, timelapse.rehearsal(), timelapse)
    devices = [sink.type for sink in profile.sinks]
    return Plan(profile, load_sequence(file, limits, profile.name, devices))


def _from_here(content: dict[str, Any]) -> dict[str, Any]:
    """With the files that it names, a table and moves, as seen from the current folder."""
    table, moves = content.get("source"), content.get("include")
    named = [(table, "file")] + [(move, "move") for move in (moves if isinstance(moves, list) else [])]
    for section, key in named:
        if isinstance(section, dict) and isinstance(path := section.get(key), str) and path and not is_bare(path):
            section[key] = str(Path.cwd() / Path(path).expanduser())
    return content


def _plain(value: Any) -> Any:
    """What YAML can hold, from mappings, sequences and numbers of any kind (numpy's included)."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in cast("Mapping[Any, Any]", value).items()}
    if isinstance(value, str | Path):
        return str(value)
    if isinstance(value, list | tuple):
        return [_plain(each) for each in cast("list[Any]", value)]
    return value.tolist() if hasattr(value, "tolist") else value
