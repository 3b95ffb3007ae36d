"""The options that every command has, and what they mean."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter, Token

from teleop.app.planning import Plan, plan_file
from teleop.cli.completion import offered
from teleop.cli.screens.busy import busy
from teleop.cli.screens.folded import complain, spelled, tell
from teleop.config.documents.document import DocumentError
from teleop.config.files import is_stdout
from teleop.config.profile import Profile, load_profile
from teleop.recording import ENDING

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

    def plan(self, file: str, share: float = 1.0, by_hand: bool = False) -> Plan:
        """The sequence or take called `file`, planned for the rig with `share` of its limits; its warnings are printed.

        Raises DocumentError, and with --json prints it.
        """
        try:
            profile = self.profile()
            with busy("Planning"):
                plan = plan_file(file, profile, share, by_hand)
        except DocumentError as error:
            if self.json:
                more = {"more": error.more} if error.more else {}
                print(json.dumps({"ok": False, "problems": error.problems, **more}))
            raise
        print_warnings(plan.warnings)
        return plan


def print_warnings(warnings: Sequence[str]) -> None:
    """What is merely to be known about a sequence, on stderr."""
    for warning in warnings:
        print(spelled(warning), file=sys.stderr)


def announce(line: str, *written: Path) -> None:
    """Print `line`, for people, about the files that were written; to stderr where one of them is standard output."""
    (complain if any(map(is_stdout, written)) else tell)(line)


def announce_json(content: object, *written: Path) -> None:
    """As `announce`, for programs: one line whatever the width of the terminal."""
    print(json.dumps(content), file=sys.stderr if any(map(is_stdout, written)) else sys.stdout)


DEFAULTS = Options()
