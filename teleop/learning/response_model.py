"""How the measured angle answered the commanded one in a pass: an impulse response, whatever made it.

What moves an axis is a gimbal behind a correction of its own, so a dead time and a lag do not describe it: it may ring.
The response is fitted by least squares to the pass itself, starting from the delay and the scale of
`monitors.delay_estimate`. What the pass does not show stays near that start, and late parts are held to be small
(a kernel as of T. Chen, H. Ohlsson, L. Ljung: On the estimation of transfer functions, 2012).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from teleop.monitors.delay_estimate import Delay, estimate
from teleop.planner.polynomial import Array

STEP = 0.04  # s between samples: a gimbal is asked 25 times a second
TAPS = 50  # samples, 2 s: after that nothing of a command is left
FADES = 0.5  # s in which what may differ from the start fades
FREEDOM = 0.1  # of a tap from its start, at first
NOISE = 0.04  # units of the range below: half of a gimbal's grid
OFFSET, DRIFT = 0.2, 1.0  # deg, deg/s that are no answer to the command
SCALES = 0.5, 1.5  # times as far as commanded, at most
MOST_DELAY = 0.5  # s


def fitted(commanded: Array, measured: Array, known: NDArray[np.bool_]) -> tuple[Array, Delay | None]:
    """The response (TAPS,) by positions (n,) every STEP, and the delay that it started from; both begin at rest.

    What is not `known` (n,) of the measured ones does not count.
    """
    times = np.arange(len(commanded)) * STEP
    read = np.array([times[known], measured[known]]).T.tolist()
    delay = estimate(np.array([times, commanded]).T.tolist(), read, 0.0, float(times[-1]))
    start = _start(delay)
    away = commanded - commanded[0]
    answers = np.stack([np.concatenate([np.zeros(k), away])[: len(away)] for k in range(TAPS)], axis=1)
    model = np.concatenate([np.ones((len(times), 1)), times[:, None], answers], axis=1)
    left = (measured - commanded[0] - answers @ start)[known]
    model = model[known]
    later = np.maximum.outer(np.arange(TAPS), np.arange(TAPS))
    kernel = FREEDOM**2 * math.exp(-STEP / FADES) ** later
    weight = np.zeros((TAPS + 2, TAPS + 2))
    weight[0, 0], weight[1, 1] = 1 / OFFSET**2, 1 / DRIFT**2
    weight[2:, 2:] = np.linalg.inv(kernel)
    found = np.linalg.solve(model.T @ model / NOISE**2 + weight, model.T @ left / NOISE**2)
    return start + found[2:], delay


def _start(delay: Delay | None) -> Array:
    """A pure delay, between the two samples around it."""
    seconds, scale = (0.0, 1.0) if delay is None or math.isinf(delay.doubt) else (delay.seconds, delay.scale)
    place = min(max(seconds, 0.0), MOST_DELAY) / STEP
    taps, whole = np.zeros(TAPS), math.floor(place)
    taps[whole], taps[whole + 1] = whole + 1 - place, place - whole
    return taps * min(max(scale, SCALES[0]), SCALES[1])
