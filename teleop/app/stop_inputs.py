"""The STOP of every input, open in a run that moves by itself: a pad beside the camera stops it, whoever started it.

Only what stops a run, and what goes on after it, is read of these devices: their sticks move nothing. One that is
absent is a warning and no more; plugged in later, it counts from then on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack

from teleop.config.inputs_section import InputSection
from teleop.config.profile import Profile
from teleop.core.errors import DeviceError
from teleop.core.interfaces import Clock
from teleop.inputs.evdev.backend import AllDevices
from teleop.inputs.hid.device import HidInput, open_inputs
from teleop.inputs.hid.pads import may_stop
from teleop.inputs.hid.selection import wanted
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.playback_keymap import RUN_KEYS, PlayKeys
from teleop.manual.stop_guard import Relay, Resumable, StopGuard


def open_stop_inputs(
    stack: ExitStack, profile: Profile, clock: Clock, warn: Callable[[str], object]
) -> Sequence[HidInput]:
    """The profile's devices that have a STOP, open until the stack is left; without any, the joystick that is there.

    `warn` gets a line for each device of the profile that is absent. Raises DocumentError for a pad that is unusable.
    """
    sections = [each for each in profile.inputs or [InputSection()] if may_stop(each)]
    if not sections:
        return []
    try:
        backend = AllDevices()
        found = backend.enumerate()
    except (DeviceError, OSError) as error:
        if profile.inputs:
            warn(f"{error}, so no input can be read and none can STOP the run")
        return []
    absent = [each for each in sections if not wanted(each.device, found, None)]
    if absent and not profile.inputs:
        return []
    for each in absent:
        warn(f"{each.name or each.device}: not plugged in, so it cannot STOP the run")
    return stack.enter_context(open_inputs(sections, clock.now, backend, stop_only=True))


def guarded(
    stack: ExitStack,
    source: Resumable,
    profile: Profile,
    clock: Clock,
    terminal: int | None,
    virtual: bool,
    warn: Callable[[str], object],
) -> tuple[StopGuard, Sequence[Keyboard]]:
    """`source` under every STOP that there is, and the keys of the terminal, which are to be entered."""
    keys = [] if terminal is None else [Keyboard(terminal, PlayKeys(RUN_KEYS))]
    devices = [] if virtual else open_stop_inputs(stack, profile, clock, warn)
    return StopGuard(source, [Relay(each) for each in (*devices, *keys)]), keys
