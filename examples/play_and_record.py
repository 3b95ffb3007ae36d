"""Play a shipped sequence, record the run as a take, and print how closely the rig followed.

    python play_and_record.py

A take is an .mcap file. `teleop take report FILE` draws it; `teleop take export FILE` writes it as a table.
"""

import tempfile
from pathlib import Path

import teleop

file = Path(tempfile.mkdtemp()) / "reveal.mcap"

with teleop.open("sim", virtual=True) as rig:
    report = rig.play("reveal", take=file)

print(f"the move took {report.seconds:.1f} s;", "done" if report.ok else report.reason)
for axis, errors in report.axes.items():
    print(f"{axis:6} rms {errors.rms:.3f}, peak {errors.peak:.3f}, from {errors.readings} readings")

take = teleop.read_take(file)
print(f"{file.name} has {len(take.times)} ticks in {take.duration:.1f} s")
