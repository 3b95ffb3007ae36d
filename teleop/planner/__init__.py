"""From what an axis is asked to what it does, within its limits.

`live` turns demands into the next tick's motion, `keyframes` turns timed keys into a checked `Move`; both promise that
position, velocity, acceleration and jerk stay within the limits in continuous time. Nothing here knows a clock, a file
or a device.
"""
