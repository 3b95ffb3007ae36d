"""A hash of a compiled sequence: two that are planned alike have the same, and an edited key gives another one."""

from __future__ import annotations

import json
from hashlib import sha256

import numpy as np

from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Wait

EVERY = 0.1  # s
PLACES = 3  # decimals of a degree, and two more of a share of the range: finer than any gimbal's grid


def fingerprint(compiled: CompiledSequence) -> str:
    """SHA-256 of the axes, the keys, the cues, and where the move is every tenth of a second; in hexadecimal.

    A wait for the operator moves nothing, and does not count.
    """
    times = np.arange(0.0, compiled.move.duration + EVERY, EVERY)
    axes = {}
    for axis, track in sorted(compiled.move.tracks.items()):
        places = PLACES if axis.is_angle else PLACES + 2
        keys = [[round(key.at, 4), round(key.position, 5), round(key.hold, 4)] for key in compiled.keys.get(axis, ())]
        path = [round(position, places) + 0.0 for position in track.sample(times)[0].tolist()]
        axes[axis.value] = {"keys": keys, "path": path}
    cues = [[round(cue.at, 4), cue.name] for cue in compiled.cues if not isinstance(cue.action, Wait)]
    content = {"axes": axes, "cues": cues}
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
