"""Move at a velocity for a time, as a stick does, and see a soft limit end the motion.

    python jog.py

Velocities are in degrees per second, and in 1 per second for focus. The rig speeds up and slows down within its limits.
"""

import teleop

with teleop.open("sim", virtual=True) as rig:
    rig.jog(pan=10, tilt=-2, seconds=2)
    print(f"after 2 s: pan {rig.angles()['pan']:.1f}, tilt {rig.angles()['tilt']:.1f}")

    rig.jog(tilt=-40, seconds=3)  # 120 degrees down, but the soft limit is at -56
    print(f"at the soft limit: tilt {rig.angles()['tilt']:.1f}")

    try:
        rig.jog(pan=500, seconds=1)
    except teleop.UsageError as error:
        print("refused:", error)
