"""The devices that `live --learn` listens to: each interface with a reader of its own, the one that profiles use."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from teleop.config.inputs_section import DIRECTIONS, ControlSection, DeviceSection, InputSection
from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.core.errors import DeviceError, UsageError
from teleop.core.operator_input import Command
from teleop.inputs.hid.backend import DeviceInfo, HidBackend, described
from teleop.inputs.hid.claims import Claims
from teleop.inputs.hid.device import undescribed
from teleop.inputs.hid.learn import Found, Watch, is_hat, still
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.pads import MULTI_AXIS, Chosen
from teleop.inputs.hid.reader import HidReader, Plugged
from teleop.inputs.hid.selection import wanted
from teleop.inputs.hid.state import HidState, Sample

SWITCH = 2.0  # s: a button that is pressed for longer is a switch that is on
MORE = 1.0  # s in which a device that cannot be read is tried again


class LearnedDevice:
    """One of them; `info` is its identity. `known` is what a shipped mapping says of how its controls count."""

    def __init__(self, info: DeviceInfo, backend: HidBackend, now: Callable[[], float], polled: bool) -> None:
        self.info, self._backend, self._now, self._polled = info, backend, now, polled
        self._section = InputSection(
            device=DeviceSection(
                vendor=info.vendor_id,
                product=info.product_id,
                name=info.name or None,
                serial=info.serial or None,
                port=info.port or None,
                interface=info.interface if info.interface >= 0 else None,
            )
        )
        self.known: Mapping[str, ControlSection] = {}
        self.hats: Sequence[str] = ()
        self._reader: HidReader | None = None
        self._watch: Watch | None = None
        self._before: Mapping[str, Sample] = {}
        self._at_rest: Mapping[str, Sample] = {}  # also from before it was opened again: it may report only changes
        self._quiet = self._unchanged = 0.0  # since when nothing moves, and no value changes, s
        self._seen = False

    def open(self, claims: Claims) -> None:
        self._reader = HidReader(self._section, self._backend, self._now, claims, self._mapped)
        self._seen = False
        if not self._polled:
            self._reader.start()

    def close(self) -> None:
        if self._reader is not None:
            self._reader.close()

    @property
    def plugged(self) -> Plugged | None:
        return self._reader and self._reader.plugged

    @property
    def refused(self) -> str:
        return self._reader.refused if self._reader else ""

    @property
    def is_lost(self) -> bool:
        """Whether it was there and is gone."""
        return self._seen and self.plugged is None

    def note(self, now: float) -> str:
        """What is wrong with its reports, "" for nothing."""
        text = undescribed(self.plugged, now) if self.plugged else self.refused
        return f"{described(self.info)}: {text}" if text and self.plugged else text

    def poll(self, now: float) -> None:
        if self._polled and self._reader:
            self._reader.poll(now)
        self._seen = self._seen or self.plugged is not None

    def rest(self, now: float) -> None:
        """Count from now on how long nothing moves."""
        self._before, self._quiet, self._unchanged = self._values, now, now

    def rested(self, now: float, quiet: float) -> bool:
        """Whether nothing has moved for `quiet` s; a button that stays pressed for long is a switch and rests."""
        values = self._values
        for _ in self.plugged.state.changes() if self.plugged else ():
            pass  # what is counted meanwhile is no answer
        if not still(self._before, values):
            self._quiet = now
        if not still(self._before, values, switches=True):
            self._unchanged = now
        self._before = values
        return now - self._quiet >= quiet or now - self._unchanged >= max(quiet, SWITCH)

    def watch(self, smooth: bool) -> None:
        """Watch its controls from where they are now; see `Watch`."""
        self._at_rest = {**self._at_rest, **self._values}
        self._watch = Watch(self._at_rest, smooth, self.known)

    def see(self, now: float) -> Found | None:
        if self.plugged is None or self._watch is None:
            return None
        return self._watch.see(self._values, self.plugged.state.changes(), now)

    def settled(self, found: Found) -> Found:
        return found if self._watch is None else self._watch.settled(found, self._values)

    def was_released(self, found: Found) -> bool:
        return self._watch is not None and self._watch.was_released(found, self._values)

    @property
    def _values(self) -> Mapping[str, Sample]:
        return self.plugged.state.values if self.plugged else {}

    def _mapped(self, chosen: Chosen, state: HidState, info: DeviceInfo) -> Mapped:
        """Every control, so that all are read: each wheel's counts, and a press of a hat's direction at its first."""
        self.info = info  # of two that are alike the one that this reader has
        self.known = {name: each for name, each in chosen.controls.items() if each.value_type is not None}
        if state.purpose == MULTI_AXIS:  # a puck is where it is held, whatever its descriptor says
            puck = ControlSection(axis=Axis.PAN, value_type="absolute")
            self.known = {**dict.fromkeys(state.relative, puck), **self.known}
        moved, pressed = ControlSection(axis=Axis.PAN), ControlSection(press=Command.STOP)
        hats = [name for name in state.names if is_hat(name, state.names)]
        self.hats = hats
        directions = {f"{hat} {direction}" for hat in hats for direction in DIRECTIONS}
        sections = {name: pressed if name in directions else self.known.get(name, moved) for name in state.names}
        return Mapped(sections, relative=state.relative)


class LearnedDevices:
    """All devices that may be meant. Raises UsageError when there is none."""

    def __init__(self, profile: Profile, backend: HidBackend, now: Callable[[], float], polled: bool) -> None:
        infos = _meant(profile, backend.enumerate())
        if not infos:
            raise UsageError(_none(profile))
        self._now = now
        self._begin = now()
        self.each = [LearnedDevice(info, backend, now, polled) for info in infos]

    def open(self) -> None:
        """Read them from now on, until they are closed; may be done again after that."""
        claims, self._begin = Claims(), self._now()
        for device in self.each:
            device.open(claims)

    def poll(self, now: float) -> None:
        for device in self.each:
            device.poll(now)

    def check(self, used: Sequence[int], now: float) -> None:
        """Raises DeviceError when one that has answered is unplugged, when none is left or none can be read."""
        lost = [device for index, device in enumerate(self.each) if device.is_lost and index in used]
        if all(device.is_lost for device in self.each):
            lost = self.each
        if lost:
            raise DeviceError(f"{described(lost[0].info)}: unplugged; nothing was written")
        refused = [device.refused for device in self.each if device.plugged is None and device.refused]
        if len(refused) == len(self.each) and now - self._begin > MORE:
            raise DeviceError(refused[0])

    @property
    def are_read(self) -> bool:
        """Whether every one of them is open."""
        return all(device.plugged for device in self.each)

    @property
    def names(self) -> str:
        return ", ".join(dict.fromkeys(described(device.info) for device in self.each))

    def notes(self, now: float) -> Iterator[str]:
        yield from filter(None, (device.note(now) for device in self.each))

    def rest(self, now: float) -> None:
        for device in self.each:
            device.rest(now)

    def rested(self, now: float, quiet: float) -> bool:
        """Whether nothing has moved on any for `quiet` s; False before one is read."""
        rested = [device.rested(now, quiet) for device in self.each if device.plugged]
        return bool(rested) and all(rested)

    def close(self) -> None:
        for device in self.each:
            device.close()


def _meant(profile: Profile, found: Sequence[DeviceInfo]) -> Sequence[DeviceInfo]:
    """Those that the profile names, where each of its inputs names one; else every joystick too."""
    sections = [section.device for section in profile.inputs]
    named = [info for section in sections if not section.any for info in wanted(section, found, None)]
    if not sections or any(section.any for section in sections):
        named += wanted(DeviceSection(), found, None)
    return list({info.path: info for info in named}.values())


def _none(profile: Profile) -> str:
    named = [str(section.device) for section in profile.inputs if not section.device.any]
    if profile.inputs and len(named) == len(profile.inputs):
        cure = "plug it in, or give a profile without its entry of inputs"
        return f"--learn: no device of the profile is plugged in ({', '.join(named)}): {cure}"
    return "--learn: no joystick found: plug one in; `teleop devices` lists the devices"
