"""How others get to a run: what its screens show of the console beside it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Invitation(NamedTuple):
    """Lines of text, and a QR code drawn in lines, () where no phone can reach the console."""

    lines: Sequence[str]
    code: Sequence[str] = ()
