"""How others reach the run, over the view of it: the address and its QR code, while a key asks for them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

from rich.text import Text

from teleop.cli.screens.picture import Rows
from teleop.cli.screens.run_rows import hint_rows
from teleop.core.invitation import Invitation
from teleop.core.run_status import Hint
from teleop.inputs.keymaps import INVITE

QR = "bright_white on black"  # whatever the terminal's own colors: a phone wants dark on light, and reads this
HINTS = (Hint(INVITE, "back"), Hint("space", "STOP"))
AROUND = 3  # rows of a terminal that are not the code's: title, banner and keys


class Inviting(Protocol):
    """Keys that may ask for it."""

    @property
    def inviting(self) -> bool: ...


@dataclass(frozen=True)
class InvitationSheet:
    """What is shown of it while the keys want it."""

    invitation: Invitation
    keys: Inviting

    def over(self, rows: Rows, width: int, height: int) -> Rows:
        """What is drawn instead of `rows`: the title and what stops everything stay."""
        if not self.keys.inviting:
            return rows
        code, lines = self.invitation.code, self.invitation.lines
        if code and (height < len(code) + AROUND or width < len(code[0])):
            lines = [*lines, f"The QR code needs a terminal of {len(code[0])} x {len(code) + AROUND}."]
            code = ()
        drawn = [Text(f" {line}") for line in lines]
        return replace(
            rows,
            axes=[Text(line, QR) for line in code] or [Text(), *drawn],
            state=drawn if code else (),
            notes=(),
            bottom=hint_rows(HINTS, width),
        )


def sheet(invitation: Invitation | None, keys: Inviting | None) -> InvitationSheet | None:
    """None where nobody can be invited, or no key asks for it."""
    return None if invitation is None or keys is None else InvitationSheet(invitation, keys)


def announced() -> str:
    """The line for an operator with keys when the run begins: the address itself is longer than a terminal is wide."""
    return f"Console: {INVITE} shows its address and QR code"
