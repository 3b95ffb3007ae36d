"""Ten minutes of a move, by the frame, are written and read in a fraction of the time that they take to play.

Measured: written in 0.1 s (text) to 1 s (USD, OpenTimelineIO, Blender), read in 0.1 to 0.6 s; the child that reads USD
and OpenTimelineIO takes as long again. Nothing of this runs in the control process.
"""

from __future__ import annotations

from fractions import Fraction
from time import process_time

import pytest
from made_motions import content, made_motion

from teleop.interchange.table import BY_NAME, Hints

FRAMES, RATE = 14_400, Fraction(24)
MOST = 60.0  # s of the processor for ten minutes of a move: a tenth of it


@pytest.mark.parametrize("name", BY_NAME)
def test_ten_minutes_take_seconds(name: str) -> None:
    motion = made_motion(FRAMES, RATE)
    begin = process_time()
    raw = content(name, motion)
    written = process_time() - begin
    hints = Hints(RATE, "ZXY", ["pan", "tilt", "roll", "focus"]) if name == "raw" else Hints(RATE, "ZXY")
    begin = process_time()
    found = BY_NAME[name].load().read(raw, f"file{BY_NAME[name].endings[0]}", hints)
    read = process_time() - begin
    print(f"\n{name}: {len(raw) / 1e6:.1f} MB, written in {written:.2f} s, read in {read:.2f} s")
    assert len(found.times) == FRAMES
    assert written + read < MOST
