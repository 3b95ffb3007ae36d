"""The times of the control loop, which sources, devices and reports have to fit."""

from __future__ import annotations

RATE = 100  # Hz, of ticks
PERIOD = 1 / RATE  # s, of a tick
KEEP_ALIVE = 0.4  # s: the longest a resting loop sleeps; a gimbal forgets a speed after 0.5 s
FIRST_REPORT = 2.0  # s to wait for the first report of every axis in use
