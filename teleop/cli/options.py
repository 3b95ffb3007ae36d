"""The options that every command has, and what they mean."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter, Token

from teleop.cli.completion import offered
from teleop.cli.screens.folded import complain, tell
from teleop.config.document import DocumentError, UnplayableError
from teleop.config.files import is_stdout
from teleop.config.profile import Profile, load_profile
from teleop.recording.writer import ENDING

if TYPE_CHECKING:
    from teleop.sequence.compile import CompiledSequence
    from teleop.timelapse.compile import Timelapse

MOVES, RIGS = offered("sequences", ".yaml", ".yml", ENDING), offered("profiles", ".yaml", ".yml")


def whole(_type: Any, tokens: Sequence[Token]) -> int:
    """What is typed as a whole number, and nothing that would have to be rounded to one."""
    try:
        return int(tokens[0].value)
    except ValueError:
        raise ValueError("It must be a whole number.") from None


@Parameter(name="*")
@dataclass(frozen=True)
class Options:
    """Which rig, where, and how to talk about it."""

    rig: Annotated[
        str, Parameter(metavar="NAME|FILE", help="The rig: a shipped profile's name, or a file.", completer=RIGS)
    ] = "sim"
    link: Annotated[
        tuple[str, ...],
        Parameter(
            metavar="NAME=URL",
            help="URL of one of the rig's links, instead of the profile's.",
            negative=(),
            show_default=False,
        ),
    ] = ()
    json: Annotated[bool, Parameter(help="Print JSON, for programs.", negative=(), show_default=False)] = False
    debug: Annotated[bool, Parameter(help="Print tracebacks.", negative=(), show_default=False)] = False

    def profile(self) -> Profile:
        """The rig asked for; raises DocumentError."""
        links: dict[str, str] = {}
        for text in self.link:
            name, equals, url = text.partition("=")
            if not equals or not name:
                raise DocumentError([f"--link {text}: write it as NAME=URL, as in gimbal=socketcan:can0"])
            links[name] = url
        return load_profile(self.rig, links, "--link ")

    def compiled(self, file: str, share: float = 1.0) -> tuple[Profile, CompiledSequence, Timelapse | None]:
        """The sequence or take called `file`, compiled for the rig, its warnings said.

        `share` is what it may have of the rig's velocity, acceleration and jerk. Of a timelapse, which is handed out
        too, it is the rehearsal, whose warnings are left to whoever rehearses. Raises DocumentError, and with --json
        prints it.
        """
        from teleop.sequence.compile import load_performance
        from teleop.timelapse.compile import load_timelapse

        timelapse = None
        try:
            profile = self.profile()
            limits = {axis: of_axis.scaled(share) for axis, of_axis in profile.limits.items()}
            if is_take(file):
                from teleop.recording.replay import take_performance

                performance = take_performance(Path(file), limits, profile.name)
            elif timelapse := load_timelapse(file, limits, profile.name):
                performance = timelapse.rehearsal()
            else:
                devices = [sink.type for sink in profile.sinks]
                performance = load_performance(file, limits, profile.name, devices)
        except DocumentError as error:
            if share < 1 and isinstance(error, UnplayableError):
                error = UnplayableError([*error.problems, f"{file}: was planned with {share:.0%} of the rig's limits"])
            if self.json:
                print(json.dumps({"ok": False, "problems": error.problems}))
            raise error from None
        warn(performance if timelapse is None else timelapse)
        return profile, performance, timelapse


def warn(compiled: CompiledSequence | Timelapse) -> None:
    """Say what is merely to be known about it."""
    for warning in compiled.warnings:
        print(warning, file=sys.stderr)


def announce(line: str, *written: Path) -> None:
    """Print `line`, for people, about the files that were written; to stderr where one of them is standard output."""
    (complain if any(map(is_stdout, written)) else tell)(line)


def announce_json(content: object, *written: Path) -> None:
    """As `announce`, for programs: one line whatever the width of the terminal."""
    print(json.dumps(content), file=sys.stderr if any(map(is_stdout, written)) else sys.stdout)


def is_take(file: str) -> bool:
    """Whether this is a recording, not a sequence: by its ending."""
    return Path(file).suffix.lower() == ENDING


DEFAULTS = Options()
