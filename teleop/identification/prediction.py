"""Where an axis with a known response would have been under the speeds that were sent to it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from teleop.core.axes import Reading
from teleop.core.response import Response
from teleop.identification.travel import Floats, Travel

LEAST_LAG = 1e-3  # s


def predicted(sent: Sequence[tuple[float, float]], readings: Sequence[Reading], response: Response) -> Floats:
    """The positions (n,) at the times of the readings, placed so that their mean is that of the readings.

    `sent` are times (s) and speeds (deg/s) in the order of their times, as are the readings.
    """
    travel, places = Travel(np.array([max(response.lag, LEAST_LAG)])), []
    commands = iter([*sent, (np.inf, 0.0)])
    time, speed = next(commands)
    for reading in readings:
        while time <= reading.time:
            travel.sent(time, speed)
            time, speed = next(commands)
        (place,), _ = travel.at(np.array([reading.time - response.dead_time]))
        places.append(response.gain * float(place[0]) + response.drift * (reading.time - readings[0].time))
    found = np.array(places)
    return found + np.mean([each.position for each in readings]) - found.mean()
