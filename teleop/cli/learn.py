"""`teleop live --learn`: asks for each control on the terminal, shows what they do, and writes the profile."""

from __future__ import annotations

import contextlib
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from teleop.app.learn.session import LearnSession, Stage
from teleop.app.learn.target import Target
from teleop.app.operator_inputs import device_backend
from teleop.cli.options import announce, announce_json
from teleop.cli.screens.folded import complain
from teleop.cli.screens.learn_view import LearnView
from teleop.cli.signals import CODE, signals_to
from teleop.config.profile import Profile
from teleop.core.clock import SystemClock
from teleop.core.errors import UsageError
from teleop.inputs.hid.recording import Recording
from teleop.inputs.keyboard import Keyboard, has_keys, terminal
from teleop.inputs.learn_keymap import KEYS
from teleop.inputs.playback_keymap import PlayKeys

_TURN = 0.02  # s between two looks at the devices
_OPENING = 1.0  # s for all devices to be opened, before what is recorded begins


def learn(profile: Profile, rig: str, out: Path | None, recordings: Sequence[Recording], json: bool) -> int:
    """Ask for each axis and command of the rig, and write the `inputs:` of its profile, or of a new one at `out`.

    Raises UsageError without a terminal or a device, DeviceError when the device cannot be read or is unplugged.
    """
    keyboard = _keyboard()
    target = Target(rig, out)
    clock = SystemClock()
    begin = [math.inf]  # of the recordings: once their devices are read, as they are before a run
    session = LearnSession(profile, target, device_backend(recordings, clock, lambda: begin[0]), clock.now)
    latest = clock.now() + _OPENING
    interrupted: list[str] = []
    with signals_to(interrupted.append), keyboard, session, LearnView(session) as view:
        while not session.over and not interrupted:
            held = keyboard.read(clock.now())
            if held.trouble:
                interrupted.append(held.trouble)
            if begin[0] == math.inf and (session.devices.are_read or clock.now() > latest):
                begin[0] = clock.now()
            session.turn(clock.now(), [press.command for press in held.presses])
            view.update()
            time.sleep(_TURN)
    if interrupted:
        with contextlib.suppress(OSError):  # the terminal may be gone
            complain(f"teleop: {interrupted[0]}: nothing was written")
        return CODE
    return _report(session, json)


def _keyboard() -> Keyboard:
    """Raises UsageError without a terminal whose keys may be read."""
    if not sys.stdin.isatty():
        raise UsageError("--learn asks questions: run it on a terminal")
    if not has_keys():
        raise UsageError("--learn cannot see Enter on this system: use Linux or macOS, or copy a shipped mapping")
    descriptor = terminal()
    if descriptor is None:
        raise UsageError("--learn asks questions: run it in the foreground")
    return Keyboard(descriptor, PlayKeys(KEYS))


def _report(session: LearnSession, json: bool) -> int:
    file = session.target.file
    if session.stage is Stage.LEFT:
        complain("teleop: nothing was written")
    elif session.stage is Stage.OUTPUT and file is None:
        print(session.output, end="")
        complain("Copy these lines into your profile, or run it again with -o FILE.")
    elif file is not None:
        if session.stage is Stage.OUTPUT:
            session.target.write(session.output)
        done = f"{file}: its inputs are what was learned. Try it: teleop live --rig {file}"
        announce_json({"ok": True, "file": str(file)}, file) if json else announce(done, file)
    return 0
