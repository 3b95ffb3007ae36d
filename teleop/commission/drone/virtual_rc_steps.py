"""The RC's mode switch, and virtual RC with neutral sticks: on, off, and how long it lasts without any.

Every look checks that the drone still stands by on the ground, its RC in F. Whatever it says otherwise ends the step,
and with it virtual RC.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping

from teleop.commission.drone.base import ActivatedStep, check_on_ground, until, wait
from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.step import Pause, Question, Script, Wait
from teleop.core.errors import DeviceError
from teleop.devices.drone.control_mode import word_of
from teleop.dji.drone.enums import ControlDevice, RcMode

SETTLES = 0.3  # s until the broadcast shows the switch
CONFIRMS = 1.5  # s within which the bit is to follow
HOLDS = 2.0  # s of virtual RC, its sticks neutral
LONGEST = 5.0  # s for which the time-out is waited for

SWITCH = {
    mode: Subject(f"rc.mode.{mode.name.lower()}", f"Mode switch of the RC in {mode.name}, as broadcast", float(mode))
    for mode in (RcMode.A, RcMode.P, RcMode.F)
}
ON = Subject("virtual_rc.on", "The control field says that virtual RC is on (05 00)", True)
ON_AFTER = Subject("virtual_rc.on_after", "Time from the enable until it says so", None, "s")
DEVICE = Subject("virtual_rc.device", "What controls the drone meanwhile, by the control field")
MIRRORS = Subject("virtual_rc.mirrored", "The RC that is broadcast shows the virtual sticks")
KEPT = Subject("virtual_rc.kept", f"It stays on for {HOLDS:g} s of neutral sticks", True)
OFF = Subject("virtual_rc.off", "The control field says that virtual RC is off again", True)
OFF_AFTER = Subject("virtual_rc.off_after", "Time from the disable until it says so", None, "s")
TIMEOUT = Subject("virtual_rc.timeout", "Time without sticks after which virtual RC ends", 1.0, "s")


class ModeSwitch(ActivatedStep):
    """The mode switch of the RC, seen in each place, last in F."""

    key, title = "mode-switch", "The mode switch of the RC"
    about = ("You are asked to turn the RC's mode switch to A, P and F.", "Nothing is sent, nothing moves.")
    subjects = tuple(SWITCH.values())

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        shown: dict[RcMode, int | None] = {}
        for mode in SWITCH:
            yield Question(f"Turn the RC's mode switch to {mode.name}, then press Enter.", {"enter": "it is there"})
            yield from wait(self.bench, SETTLES, "reading")
            rc = self.bench.get("rc")
            shown[mode] = None if rc is None else int(rc.mode)
        return [_place_of(mode, shown) for mode in SWITCH]


def _place_of(mode: RcMode, shown: Mapping[RcMode, int | None]) -> Fact:
    """What was broadcast for one place; a value that came for several belongs to the place that the document gives."""
    value, subject = shown[mode], SWITCH[mode]
    if value is None:
        return subject.not_seen("no RC field came")
    if value != mode and list(shown.values()).count(value) > 1:
        return subject.not_seen("the broadcast showed the same as for another place")
    return subject.found(float(value), "broadcast when the operator had turned it")


class VirtualRcStep(ActivatedStep):
    """What the two steps with virtual RC have in common."""

    def unfit(self, findings: Findings) -> str:
        unfit = super().unfit(findings)
        if unfit or findings.value(SWITCH[RcMode.F].key) is not None:
            return unfit
        return "the mode switch of the RC was not seen in F"

    def take(self) -> Pause:
        """Virtual RC on, its sticks neutral, once the drone allows it. Raises DeviceError."""
        bench = self.bench
        yield from until(
            bench, lambda: bench.wait == 0, bench.wait + 0.1, "waiting 2 s: twice within that would lock the drone"
        )
        check_on_ground(bench)
        rc, control = bench.get("rc"), bench.get("control")
        if rc is None or rc.mode != RcMode.F:
            raise DeviceError("the RC's mode switch is not in F: turn it there")
        if control is not None and control.virtual_rc:
            raise DeviceError("virtual RC is on already, for another program: wait until it ends")
        if control is not None and control.device == ControlDevice.MOBILE_DEVICE:
            raise DeviceError("the mobile device has control: close its app")
        bench.enable()

    def bit(self, since: float) -> bool | None:
        """Whether virtual RC is on, by a control field that came after `since`."""
        check_on_ground(self.bench)
        control = self.bench.get("control", since)
        return None if control is None else control.virtual_rc

    def confirm(self, on: bool, subject: Subject, after: Subject) -> Generator[Wait | Question, str, list[Fact]]:
        """Whether the bit follows, and how fast."""
        bench, since = self.bench, self.bench.now
        came = yield from until(bench, lambda: self.bit(since) is on, CONFIRMS, "waiting for the control field")
        if came:
            took = round(bench.came("control") - since, 2)
            return [subject.found(True, "the bit of the control field"), after.found(took, "by the control field")]
        known = self.bit(since)
        if known is None:
            how = "no control field came"
            return [subject.not_seen(how), after.not_seen(how)]
        return [
            subject.found(False, f"the bit did not follow within {CONFIRMS:g} s"),
            after.not_seen("it did not follow"),
        ]


class VirtualRcOnOff(VirtualRcStep):
    """Virtual RC on with neutral sticks for two seconds, then off."""

    key, title = "virtual-rc", "Virtual RC on and off, sticks neutral"
    consent = "The program holds the drone's sticks for 3 s, all of them neutral."
    about = (
        "Virtual RC is enabled once, neutral sticks are sent for 2 s, then it ends.",
        "The motors stay off. Space ends it, and so does the mode switch that leaves F.",
    )
    subjects = (ON, ON_AFTER, DEVICE, MIRRORS, KEPT, OFF, OFF_AFTER)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        yield from self.take()
        facts = yield from self.confirm(True, ON, ON_AFTER)
        began, lost = bench.now, False
        while bench.now < began + HOLDS:
            lost |= self.bit(began) is False and facts[0].found is True
            yield Wait(0.02, "virtual RC is on, sticks neutral")
        facts += self._meanwhile(began, facts[0].found is True, lost)
        bench.disable()
        return [*facts, *(yield from self.confirm(False, OFF, OFF_AFTER))]

    def _meanwhile(self, began: float, was_on: bool, lost: bool) -> list[Fact]:
        bench = self.bench
        control, rc = bench.get("control", began), bench.get("rc", began)
        if not was_on or control is None:
            return [each.not_seen("virtual RC was not seen on") for each in (DEVICE, MIRRORS, KEPT)]
        facts = [DEVICE.found(word_of(control.device), "the control field")]
        facts.append(
            MIRRORS.not_seen("no RC field came")
            if rc is None
            else MIRRORS.found(rc.mode == RcMode.P, "the virtual mode switch is in P, that of the RC in F")
        )
        return [*facts, KEPT.found(not lost, "the bit of the control field")]


class VirtualRcTimeout(VirtualRcStep):
    """Virtual RC on, then no more sticks: how long it lasts."""

    key, title = "virtual-rc-timeout", "How long virtual RC lasts without sticks"
    consent = "The program holds the drone's sticks for 6 s at most, all of them neutral."
    about = (
        "Virtual RC is enabled once, neutral sticks are sent for 0.5 s, then none.",
        "The drone ends it by itself; after 5 s the program does. The motors stay off.",
    )
    subjects = (TIMEOUT,)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        yield from self.take()
        began = bench.now
        if not (yield from until(bench, lambda: self.bit(began) is True, CONFIRMS, "waiting for the control field")):
            return [TIMEOUT.not_seen("virtual RC was not seen on")]
        yield from until(bench, lambda: self.bit(began) is False, 0.5, "virtual RC is on, sticks neutral")
        bench.fall_silent()
        since = bench.last_sticks
        ended = yield from until(bench, lambda: self.bit(since) is False, LONGEST, "no sticks: waiting for its end")
        seconds = round(bench.came("control") - since, 2)
        bench.disable()
        if not ended:
            return [TIMEOUT.found(LONGEST, f"it was still on after {LONGEST:g} s", different=True)]
        return [TIMEOUT.found(seconds, "from the last sticks until the bit went off", within=0.15)]
