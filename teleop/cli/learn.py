"""`teleop live --learn`: a mapping by moving each control when asked for it.

The questions go to stderr and the mapping to stdout, so that `teleop live --learn > inputs.yaml` keeps it; nothing is
ever written over. Only this reads the device: there is no rig to keep waiting.
"""

from __future__ import annotations

import select
import sys
from collections.abc import Callable, Sequence
from typing import Protocol

from teleop.config.inputs_section import DeviceSection
from teleop.core.axes import Axis
from teleop.core.clock import SystemClock
from teleop.core.errors import DeviceError, UsageError
from teleop.inputs.evdev.backend import AllDevices
from teleop.inputs.hid.backend import DeviceInfo, HidBackend, HidDevice, described
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.learn import Found, Kind, Learned, Question, Watch, other_way, questions, still
from teleop.inputs.hid.selection import wanted
from teleop.inputs.hid.state import HidState
from teleop.inputs.keyboard import has_keys

QUIET = 0.5  # s without a movement: everything has been let go
HELD = 2.0  # s: what is away from its rest for longer was put there, and is not merely held
_WAIT = 0.02  # s for a report
_ONE_WAY = (Kind.TRIGGER, Kind.BUTTON)


class Asker(Protocol):
    """Who is asked."""

    def notify(self, text: str) -> None: ...

    def skips(self) -> bool:
        """Whether Enter has been pressed since the last call: nothing is to do that."""
        ...


class Terminal:
    """The operator's terminal; raises UsageError when stdin is none."""

    def __init__(self) -> None:
        if not sys.stdin.isatty():
            raise UsageError("--learn asks questions: run it on a terminal")
        if not has_keys():
            raise UsageError("--learn cannot see Enter on this system: use Linux or macOS, or copy a shipped mapping")

    def notify(self, text: str) -> None:
        print(text, file=sys.stderr, flush=True)

    def skips(self) -> bool:
        pressed = False
        while select.select([sys.stdin], [], [], 0)[0]:
            if not sys.stdin.readline():
                raise UsageError("--learn: the terminal was closed; nothing was learned")
            pressed = True
        return pressed


def learn(
    axes: Sequence[Axis],
    backend: HidBackend | None = None,
    asker: Asker | None = None,
    now: Callable[[], float] | None = None,
) -> int:
    """Ask for each of `axes` and each command which control is to do it; prints the `inputs:` of a profile.

    Raises UsageError without a terminal or a joystick, DeviceError when the joystick cannot be read or is unplugged.
    """
    backend, asker, now = backend or AllDevices(), asker or Terminal(), now or SystemClock().now
    found = wanted(DeviceSection(), backend.enumerate(), None)
    if not found:
        raise UsageError("--learn: no joystick found: plug one in; `teleop devices` lists the devices")
    info = found[0]
    try:
        device = backend.open(info.path)
    except OSError as error:
        raise DeviceError(
            f"{described(info)}: cannot be opened ({error}): check its udev rule: teleop doctor"
        ) from None
    try:
        learned = _Dialogue(info, device, asker, now).hold(axes)
    except OSError:
        raise DeviceError(f"{described(info)}: unplugged; nothing was learned") from None
    finally:
        device.close()
    print(learned.text(info.vendor_id, info.product_id, described(info)), end="")
    asker.notify("Copy these lines into your profile.")
    return 0


class _Dialogue:
    def __init__(self, info: DeviceInfo, device: HidDevice, asker: Asker, now: Callable[[], float]) -> None:
        self._info, self._device, self._asker, self._now = info, device, asker, now
        self._state = HidState(parse_descriptor(device.get_report_descriptor()))
        self._state.watched = self._state.relative
        self._learned = Learned()

    def hold(self, axes: Sequence[Axis]) -> Learned:
        """Raises OSError when the device is unplugged."""
        self._asker.notify(f"{described(self._info)}: release all controls.")
        self._rest()
        for question in questions(axes):
            answer = self._answer(question)
            if answer is None:
                continue
            self._learned.add(question, answer)
            back = question.axis is not None and answer.kind in _ONE_WAY
            if back and (answer := self._answer(other_way(question))):
                self._learned.add(question, answer, back=True)
        return self._learned

    def _answer(self, question: Question) -> Found | None:
        """The control that was moved and released again; None when the question is skipped."""
        self._asker.notify(f"{question.text}. Enter: skip.")
        while True:
            watch = Watch(self._state.values, smooth=question.axis is not None)
            found = self._moved(watch)
            if found is None:
                return None
            self._asker.notify(f"  {found.name}; release it")
            self._rest()
            if watch.settled(found, self._state.values).kind is Kind.LEVER:
                self._rest(HELD)
            if not self._learned.has(found.name):
                return watch.settled(found, self._state.values)
            self._asker.notify(f"  {found.name} is already in use: choose another")

    def _moved(self, watch: Watch) -> Found | None:
        while not self._asker.skips():
            self._poll()
            if found := watch.see(self._state.values, self._state.changes(), self._now()):
                return found
        return None

    def _rest(self, quiet: float = QUIET) -> None:
        """Wait until nothing has moved for so long."""
        before, since = self._state.values, self._now()
        while self._now() - since < quiet:
            self._poll()
            if not still(before, self._state.values):
                before, since = self._state.values, self._now()
        for _ in self._state.changes():
            pass  # what was counted meanwhile is no answer

    def _poll(self) -> None:
        if report := self._device.read(_WAIT):
            self._state.take(report, self._now())
