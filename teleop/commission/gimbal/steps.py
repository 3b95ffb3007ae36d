"""All steps of a gimbal's commissioning, in their order."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from teleop.commission.gimbal.accessories import CameraStep, FocusStep
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.listening import CameraIdle, Listen, Replies
from teleop.commission.gimbal.modes import FollowStep, RecenterStep
from teleop.commission.gimbal.position import PositionStep
from teleop.commission.gimbal.questions import Identity, Ready, Settings
from teleop.commission.gimbal.readings import Pushes, Readings
from teleop.commission.gimbal.soft_limits import SoftLimitsStep
from teleop.commission.gimbal.speed import SpeedStep
from teleop.commission.gimbal.stick import StickStep
from teleop.commission.gimbal.stop import LatencyStep, StopStep
from teleop.commission.gimbal.under_speed import UnderSpeedStep
from teleop.commission.step import Step
from teleop.links.url import LinkAddress


def gimbal_steps(bench: GimbalBench, address: LinkAddress, others: Sequence[Step] = ()) -> Sequence[Step]:
    """For the gimbal on `bench`; `others` (the pad) come before the last that need the operator's hands."""
    driven = bench.driven

    def each(make: Callable[[GimbalBench, int], Step]) -> list[Step]:
        return [make(bench, index) for index in driven]

    return [
        Listen(bench, address),
        CameraIdle(bench),
        Replies(bench, address),
        Ready(bench),
        Identity(bench),
        Settings(bench),
        Readings(bench),
        Pushes(bench),
        *each(PositionStep),
        *each(SpeedStep),
        UnderSpeedStep(bench, driven[0]),
        *each(StickStep),
        StopStep(bench),
        *each(LatencyStep),
        FollowStep(bench),
        RecenterStep(bench),
        FocusStep(bench),
        CameraStep(bench),
        *others,
        *each(SoftLimitsStep),
    ]
