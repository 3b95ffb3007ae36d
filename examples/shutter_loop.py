"""Take a picture at each of several places: move, let the rig settle, press the shutter.

    python shutter_loop.py

For a timelapse with a schedule, a journal and --resume, write a sequence with `timelapse:` and use `teleop play`.
"""

import teleop

PLACES = [(-30, 0), (-10, 5), (10, 5), (30, 0)]  # pan, tilt

with teleop.open("sim", virtual=True) as rig:
    for number, (pan, tilt) in enumerate(PLACES, start=1):
        rig.move(pan=pan, tilt=tilt)
        rig.jog(pan=0, seconds=0.5)  # half a second at rest: the head stops trembling
        rig.shutter()  # returns once the camera has confirmed
        print(f"picture {number} at pan {rig.angles()['pan']:.1f}, tilt {rig.angles()['tilt']:.1f}")
