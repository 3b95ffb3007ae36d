"""Open the simulated rig, move it to a place, and print where it is.

    python first_move.py

`virtual=True` runs on the virtual clock: the three seconds of the move take a fraction of one. Leave it out to run in
real time. For a gimbal, give its profile and link: `teleop.open("rs2", links={"gimbal": "socketcan:can0"})`.
"""

import teleop

with teleop.open("sim", virtual=True) as rig:
    print(f"{rig.name} has the axes {', '.join(rig.axes)}")
    print("before:", {axis: round(position, 2) for axis, position in rig.angles().items()})
    rig.move(pan=30, tilt=5, seconds=3)  # waits until the rig is there; without seconds, as soon as the limits allow
    print("after: ", {axis: round(position, 2) for axis, position in rig.angles().items()})
