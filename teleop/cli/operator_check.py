"""Whether there is somebody for whom a sequence can wait: asked before anything moves."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from teleop.core.errors import UsageError
from teleop.sequence.cues import Wait

if TYPE_CHECKING:
    from teleop.sequence.compile import CompiledSequence


def attended(file: str, performance: CompiledSequence, keys: bool, fast: bool) -> CompiledSequence:
    """The performance, which waits only where `keys` can say go on; with `fast` it waits for nobody.

    Raises UsageError when it would wait for ever.
    """
    waits = [cue.at for cue in performance.cues if isinstance(cue.action, Wait)]
    if not waits or keys:
        return performance
    if not fast:
        raise UsageError(f"{file} waits for the operator at {waits[0]:g} s: run it on a terminal")
    print("--fast: waits for the operator are skipped", file=sys.stderr)
    return replace(performance, cues=[cue for cue in performance.cues if not isinstance(cue.action, Wait)])
