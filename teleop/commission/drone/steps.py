"""All steps of a drone's commissioning, in their order."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.commission.drone.bench import DroneBench
from teleop.commission.drone.hand_steps import Fields, Signs
from teleop.commission.drone.session_steps import Activation, Frequencies, ListenToDrone, Propellers
from teleop.commission.drone.virtual_rc_steps import ModeSwitch, VirtualRcOnOff, VirtualRcTimeout
from teleop.commission.step import Step


def drone_steps(bench: DroneBench) -> Sequence[Step]:
    """For the drone on `bench`."""
    kinds = (
        *(Propellers, ListenToDrone, Activation, Frequencies, Fields, Signs),
        *(ModeSwitch, VirtualRcOnOff, VirtualRcTimeout),
    )
    return [kind(bench) for kind in kinds]
