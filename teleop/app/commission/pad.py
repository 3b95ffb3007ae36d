"""Which of the devices that are plugged in is the pad: the one whose stick is moved."""

from __future__ import annotations

from collections.abc import Callable

from teleop.app.learn.devices import LearnedDevice, LearnedDevices
from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.step import Question, Script, Wait
from teleop.config.profile import Profile
from teleop.core.errors import TeleopError
from teleop.inputs.hid.backend import HidBackend, described
from teleop.inputs.hid.pads import pad_for

LONGEST = 30.0  # s to move a stick
QUIET = 0.5  # s of rest before
LOOK = 0.02  # s between looks
DEVICE = Subject("pad.device", "The pad")
CONTROL = Subject("pad.control", "The control that was moved")
MAPPING = Subject("pad.mapping", "The shipped mapping for it")


class PadStep:
    """Listens to all devices until one is moved; nothing of the rig moves."""

    key, title, consent, automatic = "pad", "Which device is the pad?", "", False
    about = (
        "Plug in the joystick or pad, and leave it alone for a moment. You are then asked",
        "to push a stick. The gimbal does not move.",
    )
    subjects = (DEVICE, CONTROL, MAPPING)

    def __init__(
        self, profile: Profile, backend: Callable[[], HidBackend], now: Callable[[], float], polled: bool
    ) -> None:
        self._profile, self._backend, self._now, self._polled = profile, backend, now, polled

    def unfit(self, findings: Findings) -> str:  # noqa: ARG002
        return ""

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        try:
            devices = LearnedDevices(self._profile, self._backend(), self._now, self._polled)
        except TeleopError as error:
            return [each.not_seen(str(error).removeprefix("--learn: ")) for each in self.subjects]
        devices.open()
        try:
            return (yield from self._moved(devices))
        finally:
            devices.close()

    def _moved(self, devices: LearnedDevices) -> Script:
        begin = self._now()
        devices.rest(begin)
        while not devices.rested(self._now(), QUIET):
            if self._now() > begin + LONGEST:
                return [each.not_seen("no device came to rest") for each in self.subjects]
            devices.poll(self._now())
            yield Wait(LOOK, "leave the devices alone")
        for device in devices.each:
            device.watch(smooth=True)
        while self._now() < begin + LONGEST:
            devices.poll(self._now())
            for device in devices.each:
                if found := device.see(self._now()):
                    return self._facts(device, found.name)
            if (yield Question("Push a stick of the pad", {"n": "there is none"}, seconds=LOOK)) == "n":
                break
        return [each.not_seen("nothing was moved") for each in self.subjects]

    def _facts(self, device: LearnedDevice, control: str) -> list[Fact]:
        info, how = device.info, f"its {control} was moved"
        pad = pad_for(info)
        name = f"{described(info)} ({info.vendor_id:04x}:{info.product_id:04x})"
        mapping = MAPPING.not_seen("none is shipped: teleop live --learn makes one")
        if pad is not None and not pad.unreadable:
            mapping = MAPPING.found(_file_of(pad.name), "by its ids")
        return [DEVICE.found(name, how), CONTROL.found(control, how), mapping]


def _file_of(name: str) -> str:
    """The name of the shipped file of a mapping."""
    from teleop.config.inputs_section import PADS
    from teleop.config.pad_file import load_pad
    from teleop.config.resources import folder

    return next(file.stem for file in folder(PADS).glob("*.yaml") if load_pad(file.stem).name == name)
