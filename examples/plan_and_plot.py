"""Plan a move without a rig, look at its numbers, and draw it as move.svg.

    python plan_and_plot.py

Drawing needs matplotlib: `pip install 'rs-teleop[plot]'`. Nothing is opened, and nothing moves.
"""

import numpy as np

import teleop

move = teleop.plan("reveal")
print(f"{move.title}: {move.duration:.1f} s")

middle = move.at(move.duration / 2)["pan"]
print(f"in the middle pan is at {middle.position:.2f} deg and moves at {middle.velocity:.2f} deg/s")

times = np.linspace(0, move.duration, 500)
position, velocity, acceleration, jerk = move.sample(times)["tilt"]
print(f"tilt goes from {position.min():.1f} to {position.max():.1f} deg, at {abs(velocity).max():.2f} deg/s at most")

move.plot().savefig("move.svg")
print("drawn: move.svg")
