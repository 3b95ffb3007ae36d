"""Play a move twice and compare the two takes: how well does the rig repeat?

    python compare_takes.py

The second run begins elsewhere, so its way to the first keyframe is another one. The move itself is the same, and ends
when the commanded velocity is 0 for good.
"""

import tempfile
from pathlib import Path

import numpy as np

import teleop

folder = Path(tempfile.mkdtemp())
pan = {"title": "Pan", "keyframes": [{"at": 0, "pan": -20}, {"at": 6, "pan": 20}]}

with teleop.open("sim", virtual=True) as rig:
    for name, start in (("first", 0), ("second", 35)):
        rig.move(pan=start)
        rig.play(pan, take=folder / f"{name}.mcap")

before_end = np.linspace(-6, 0, 300)  # s: the move without the way to it
positions = []
for name in ("first", "second"):
    take = teleop.read_take(folder / f"{name}.mcap")
    _, velocity, _ = take.motion["pan"]
    end = take.times[np.flatnonzero(velocity)[-1] + 1]
    times, measured = take.measured["pan"]
    positions.append(np.interp(before_end, times - end, measured))

difference = positions[1] - positions[0]
print(f"the passes differ by {np.sqrt(np.mean(difference**2)):.4f} deg rms, {abs(difference).max():.4f} deg at most")
