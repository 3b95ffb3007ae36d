"""The devices in an operator's hands, opened: joysticks and dials of the profile, and the keys of the terminal."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import ExitStack

from teleop.config.inputs_section import DeviceSection
from teleop.config.profile import Profile
from teleop.core.errors import DeviceError, UsageError
from teleop.core.interfaces import Clock
from teleop.core.operator_input import Input
from teleop.inputs.evdev.backend import AllDevices
from teleop.inputs.hid.backend import HidBackend
from teleop.inputs.hid.device import open_inputs
from teleop.inputs.hid.recording import RecordedDevices, Recording
from teleop.inputs.hid.selection import wanted

_NO_JOYSTICK = "live: no joystick was recorded: name the device that was under inputs: in the profile (--rig)"


def open_devices(
    stack: ExitStack,
    profile: Profile,
    clock: Clock,
    keys: bool,
    without: str,
    recordings: Sequence[Recording] = (),
    begin: Callable[[], float] = lambda: math.inf,
    virtual: bool = False,
) -> tuple[Sequence[Input], str]:
    """The joysticks and dials of the profile, open until the stack is left, and a line about what is absent.

    `recordings` are devices too, from `begin` on; in `virtual` time they are the only ones. Without `keys` a device has
    to be there: raises UsageError, whose text is `without`, when none is, and DeviceError when no device can be read.
    """
    try:
        backend: HidBackend = (
            RecordedDevices(recordings, clock.now, begin) if virtual else device_backend(recordings, clock, begin)
        )
    except DeviceError as error:
        if not keys:
            raise
        return [], str(error)
    there = [*(info for each in recordings for info in each.infos), *backend.enumerate()]  # plugged in later ones too
    if not keys and not profile.inputs and not wanted(DeviceSection(), there, None):
        raise UsageError(_NO_JOYSTICK if recordings else without)
    shaping = profile.sticks
    opened = open_inputs(
        profile.inputs, clock.now, backend, dead_zone=shaping.dead_zone, expo=shaping.expo, polled=virtual
    )
    return stack.enter_context(opened), ""


def device_backend(recordings: Sequence[Recording], clock: Clock, begin: Callable[[], float]) -> HidBackend:
    """All devices of this computer, and those of the `recordings`, plugged in from `begin` on.

    Raises DeviceError where no device can be read and none is recorded.
    """
    try:
        real: HidBackend | None = AllDevices()
    except DeviceError:
        if not recordings:
            raise
        real = None
    return RecordedDevices(recordings, clock.now, begin, real) if recordings or real is None else real
