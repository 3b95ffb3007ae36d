"""How even the speed between keys is to be, as a file says it: 0 (smoothest) to 1 (constant), or `even`."""

from __future__ import annotations

from typing import Literal

Tension = float | Literal["even"]
EVEN: Literal["even"] = "even"  # what a file has that names none: as smooth as can be, and even through keys
