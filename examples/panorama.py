"""Build a sequence as a dict, here a panorama for a lens, and play it.

    python panorama.py [FOCAL_LENGTH_MM]

A dict has the keys that a sequence file has, and is checked like one.
"""

import math
import sys

import teleop

focal_length = float(sys.argv[1]) if len(sys.argv) > 1 else 35.0
across, up = (2 * math.degrees(math.atan(side / 2 / focal_length)) for side in (36, 24))  # full frame, mm

sequence = {
    "title": f"Panorama at {focal_length:g} mm",
    "panorama": {
        "fov": [across, up],
        "overlap": "30%",
        "pan": [-60, 60],
        "tilt": [20, -20],
        "every": "3s",
        "settle": "0.7s",
        "exposure": "0.5s",
    },
}

with teleop.open("sim", virtual=True) as rig:
    move = teleop.plan(sequence)
    print(f"{move.title}: {move.duration:.0f} s, a picture covers {across:.0f} x {up:.0f} deg")
    report = rig.play(move)
    print("done" if report.ok else report.reason)
