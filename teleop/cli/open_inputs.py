"""The devices in an operator's hands, opened: joysticks and dials of the profile, and the keys of the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack

from teleop.config.inputs_section import DeviceSection
from teleop.config.profile import Profile
from teleop.core.errors import DeviceError, UsageError
from teleop.core.interfaces import Clock
from teleop.core.operator_input import Input
from teleop.inputs.evdev.backend import AllDevices
from teleop.inputs.hid.device import open_inputs
from teleop.inputs.hid.reader import wanted


def open_devices(
    stack: ExitStack, profile: Profile, clock: Clock, keys: bool, nobody: str
) -> tuple[Sequence[Input], str]:
    """The joysticks and dials of the profile, open until the stack is left, and what is to be said of them.

    Without `keys` something else has to be there that could move anything: raises UsageError, saying `nobody`, when
    nothing is, and DeviceError when no device can be read.
    """
    try:
        backend = AllDevices()
    except DeviceError as error:
        if not keys:
            raise
        return [], str(error)
    if not keys and not profile.inputs and not wanted(DeviceSection(), backend.enumerate(), None):
        raise UsageError(nobody)
    shaping = profile.sticks
    opened = open_inputs(profile.inputs, clock.now, backend, dead_zone=shaping.dead_zone, expo=shaping.expo)
    return stack.enter_context(opened), ""
