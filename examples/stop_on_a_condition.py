"""Pan until something happens: another thread watches the rig and stops it.

    python stop_on_a_condition.py

This one runs in real time, for two seconds. The condition is an angle here; it can be a sensor or a picture as well.
`stop()` may be called from any thread: it is the fastest stop within the limits, and latches until `clear()`.
"""

import threading
import time

import teleop

with teleop.open("sim") as rig:

    def stop_at_ten_degrees() -> None:
        while rig.angles()["pan"] < 10:
            time.sleep(0.01)
        rig.stop()

    watcher = threading.Thread(target=stop_at_ten_degrees)
    watcher.start()
    try:
        rig.jog(pan=15, seconds=10)
    except teleop.StoppedError as error:
        print(f"the jog ended: {error}")
    watcher.join()

    rig.clear()
    print("the STOP is cleared: the rig moves again")
    rig.move(pan=10)
    print(f"pan {rig.angles()['pan']:.1f}")
