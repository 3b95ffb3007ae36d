"""The automatic calibration of a simulated gimbal: it takes its time, and pushes how far it is."""

from __future__ import annotations

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import ReturnCode
from teleop.sim.gimbal.handlers import Answer, Handlers
from teleop.sim.gimbal.pushes import Beat, Due

STEPS = 20  # status pushes from the start to the last, which says complete
BETWEEN_STEPS = 0.5  # s between them


class Autotune:
    """Runs from a start command to its last push, or a stop command, which is answered by a push as well.

    One that `needs_type` refuses to start with type 0.
    """

    def __init__(self, needs_type: bool = False) -> None:
        self._needs_type = needs_type
        self._beat: Beat | None = None
        self._stopped: list[Due] = []
        self.handlers: Handlers = {gimbal.Calibrate: self._calibrate}

    def running(self, time: float) -> bool:
        return self._beat is not None and time < self._beat.end

    def due(self, now: float) -> list[Due]:
        """The status pushes up to `now`."""
        stopped, self._stopped = self._stopped, []
        return stopped + [(time, self._status(time)) for time in (self._beat.due(now) if self._beat else [])]

    def _status(self, time: float) -> gimbal.Calibration:
        if not self.running(time):
            return gimbal.Calibration(gimbal.CalibrationState.COMPLETE, 100)
        assert self._beat is not None
        share = (time - self._beat.start) / (self._beat.end - self._beat.start)
        return gimbal.Calibration(gimbal.CalibrationState.RUNNING, round(100 * share))

    def _calibrate(self, message: gimbal.Calibrate, now: float) -> Answer:
        if message.start and self._needs_type and not message.type:
            return ReturnCode.FAILED
        if message.start:
            self._beat = Beat(now, BETWEEN_STEPS, STEPS)
        elif self.running(now):
            self._beat = None
            self._stopped.append((now, gimbal.Calibration(gimbal.CalibrationState.NONE, 0)))
        return ReturnCode.OK
