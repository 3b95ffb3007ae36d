"""A HID device in an operator's hand, as an Input: what it says, and whether that is still true.

Three troubles lock it: unplugged, silent for 0.2 s, and frozen, the very same report for 10 s while something is
deflected and not at the end of its range. A device that reports only changes is silent by nature: at rest that is no
trouble, and while it is deflected it is asked. One that repeats itself more rarely is silent only when a repetition is
missing. Which kind a device is, its reports show (`Cadence`) unless the profile says it.

Reading here never waits: a thread of the reader's does all that may.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace

from teleop.config.enable_rules import enable_trouble
from teleop.config.inputs_section import DIRECTIONS, ActionSection, ControlSection, InputSection
from teleop.config.operator_settings import DEAD_ZONE, EXPO
from teleop.config.pad_file import load_pad
from teleop.core.operator_input import Command, Held
from teleop.inputs.evdev.backend import AllDevices, missing_package
from teleop.inputs.hid.backend import DeviceInfo, HidBackend, Unit, described, identified, unit
from teleop.inputs.hid.cadence import SILENT
from teleop.inputs.hid.claims import Claims
from teleop.inputs.hid.descriptor.identity import MULTI_AXIS
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.pads import Chosen, may_stop, shipped
from teleop.inputs.hid.reader import HidReader, Plugged
from teleop.inputs.hid.state import HidState

RUN_COMMANDS = {Command.STOP, Command.CLEAR, Command.PAUSE, Command.GO, Command.QUIT}  # of a run that moves by itself


class HidInput:
    """The device that `section` stands for, once `start`ed or entered.

    With `stop_only` no control counts but those that stop a run and go on with it, so its sticks cannot trouble it.
    `dead_zone` and `expo` are those of controls that have none of their own, None for the defaults of a stick.
    Raises DocumentError when the section's pad cannot be used.
    """

    def __init__(
        self,
        section: InputSection,
        backend: HidBackend,
        now: Callable[[], float],
        *,
        claims: Claims | None = None,
        dead_zone: float | None = None,
        expo: float | None = None,
        stop_only: bool = False,
        polled: bool = False,
    ) -> None:
        if section.pad:
            load_pad(section.pad)
        self._section, self._stop_only, self._polled = section, stop_only, polled
        self._dead_zone = DEAD_ZONE if dead_zone is None else dead_zone
        self._expo = EXPO if expo is None else expo
        self._reader = HidReader(section, backend, now, claims or Claims(), self._mapped)
        self._plugged: Plugged | None = None  # the one that was read last
        self._centers: dict[Unit, Mapping[str, float]] = {}
        self._has_stop = may_stop(section)
        self._misnamed = ""  # why its enable cannot be one
        self._judged: set[str] = set()  # the sticks already reported as not centered

    @property
    def name(self) -> str:
        """What the profile calls it, else what it calls itself, else what is looked for."""
        last = self._reader.last
        return self._section.name or (described(last) if last else str(self._section.device))

    @property
    def mapped(self) -> Mapped | None:
        """Its mapping as `read` uses it, while the device is there."""
        return self._plugged and self._plugged.mapped

    @property
    def is_lost(self) -> bool:
        """Whether it was there and is gone."""
        return self._reader.last is not None and self._reader.plugged is None

    def start(self) -> None:
        if not self._polled:
            self._reader.start()

    def close(self) -> None:
        self._reader.close()

    def __enter__(self) -> HidInput:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def read(self, now: float) -> Held:
        if self._polled:
            self._reader.poll(now)
        held = self._read(now)
        return replace(held, stop=self._stop_trouble(now))

    def _read(self, now: float) -> Held:
        plugged = self._reader.plugged
        notes: list[str] = []
        if plugged is not self._plugged:
            if self._plugged is not None:
                self._keep_centers(self._plugged)
            last_words = self._plugged and self._look(self._plugged, now)
            self._plugged, self._judged, self._misnamed = plugged, set(), self._enable_trouble(plugged)
            if plugged is not None and (self._reader.is_chosen or self._is_spare(plugged)):
                notes.append(f"{self._section.name or self._section.device}: using {identified(plugged.info)}")
            if plugged is not None and plugged.missing and not plugged.chosen.guessed:
                notes.append(f"{self.name}: no control {', '.join(plugged.missing)}: its mapping is ignored")
            if last_words and last_words.presses:  # a stop on the way out still is one
                return Held(presses=last_words.presses, enabled=self._off, trouble=self._absent, notes=notes)
        if plugged is None:
            return Held(enabled=self._off, trouble=self._absent)
        held = self._look(plugged, now)
        notes += self._judge(plugged)
        if trouble := self._trouble(plugged, held, now):
            return Held(presses=held.presses, enabled=self._off, trouble=f"{self.name}: {trouble}", notes=notes)
        return replace(held, notes=notes)

    def _stop_trouble(self, now: float) -> str | None:
        """`Held.stop`: of a device that is gone as it was while it was there, None before it has been."""
        plugged = self._plugged
        if plugged is None:
            known = self._has_stop and (self._reader.last is not None or self._reader.refused)
            return self._absent if known else None
        stops, state = plugged.mapped.stops, plugged.state
        self._has_stop = bool(stops)
        if not stops:
            return None
        if stops <= set(plugged.missing):
            return f"{self.name}: no control {', '.join(sorted(stops))}"
        if text := undescribed(plugged, now):
            return f"{self.name}: {text}"
        if not plugged.on_change and now - state.last > state.cadence.patience:
            return f"{self.name}: no report for {state.cadence.patience:g} s"
        return ""

    @property
    def _off(self) -> bool | None:
        return False if self._section.enable else None

    @property
    def _absent(self) -> str:
        if self._reader.refused:
            return f"{self.name}: {self._reader.refused}"
        return f"{self.name}: unplugged" if self._reader.last else f"{self.name}: not plugged in"

    def _enable_trouble(self, plugged: Plugged | None) -> str:
        if plugged is None or self._stop_only:
            return ""
        return enable_trouble(self._section.enable, plugged.state.names, plugged.chosen.controls)

    def _mapped(self, chosen: Chosen, state: HidState, info: DeviceInfo) -> Mapped:
        enable = self._section.enable
        if self._stop_only:
            return Mapped(_run_controls(chosen.controls), relative=state.relative)
        return Mapped(
            chosen.controls,
            enable,
            state.relative,
            self._dead_zone,
            self._expo,
            guessed=chosen.guessed,
            centers=self._known_centers(info),
            puck=state.purpose == MULTI_AXIS,
        )

    def _known_centers(self, info: DeviceInfo) -> Mapping[str, float]:
        """Those from before the device was unplugged; of another unit nothing is known."""
        last = self._plugged  # the control thread may not have seen yet that it was unplugged
        if last is not None and unit(last.info) == unit(info):
            return last.mapped.centers
        return self._centers.get(unit(info), {})

    def _keep_centers(self, plugged: Plugged) -> None:
        self._centers[unit(plugged.info)] = dict(plugged.mapped.centers)

    def _is_spare(self, plugged: Plugged) -> bool:
        """Whether another device was used before."""
        return bool(self._centers) and unit(plugged.info) not in self._centers

    @staticmethod
    def _look(plugged: Plugged, now: float) -> Held:
        return plugged.mapped.read(plugged.state.values, plugged.state.changes(), now)

    def _trouble(self, plugged: Plugged, held: Held, now: float) -> str:
        state = plugged.state
        if self._misnamed:
            return self._misnamed
        deflected = held.deflected
        if text := undescribed(plugged, now):
            return text
        if not plugged.mapped.names & state.values.keys():
            return "no report yet"
        if plugged.mapped.finding:
            return "finding its center: release the sticks"
        patience = state.cadence.patience
        if now - state.last > patience and (deflected or not plugged.on_change):
            return f"no report for {patience:g} s"
        if deflected and state.is_overdue(plugged.mapped.deflected, now):
            return "its reports of a stick that is deflected have ended"
        if plugged.mapped.is_unrested:
            return "center its sticks"
        unchanged = now - state.differed > plugged.chosen.stuck_timeout
        if unchanged and plugged.mapped.is_inside and not state.cadence.has_heartbeat:
            return f"reports unchanged for {plugged.chosen.stuck_timeout:g} s; stuck_timeout in the profile changes it"
        return ""

    def _judge(self, plugged: Plugged) -> Iterator[str]:
        """One message for each stick that was not centered."""
        found = set() if plugged.mapped.finding else set(plugged.mapped.uncentered) - self._judged
        self._judged |= found
        names = ", ".join(sorted(found))
        if own := ", ".join(sorted(found & self._section.controls.keys())):
            yield f"{self.name}: {own} was not centered; a trigger or a throttle needs rest: low or high"
        elif plugged.chosen.guessed and found & {"X", "Y"}:
            yield f"{self.name}: {names} was not centered and is ignored until it is: release it"


def undescribed(plugged: Plugged, now: float) -> str:
    """Why only reports come that nothing can be read of: on Bluetooth a program has switched the pad to longer ones.

    Once its calibration has been read a DualSense sends 0x31, a DualShock 0x11. Beside readable reports such a one is
    no trouble, nor is a vendor's own beside the silence of a device that reports changes.
    """
    state = plugged.state
    if state.opaque is None or now - state.last <= SILENT or now - state.opaque[1] > SILENT:
        return ""
    number = state.opaque[0]
    if plugged.on_change and state.values and state.is_described(number):
        return ""
    text = f"sends report {number:#04x}, which its descriptor does not describe"
    if install := missing_package():
        return f"{text}: connect it by cable, or read its event device: {install}"
    return f"{text}: connect it by cable, or turn it off and on with no other program using it"


def _run_controls(controls: Mapping[str, ControlSection]) -> dict[str, ControlSection]:
    """Those that stop a run that moves by itself, and go on with it."""
    kept = {}
    for name, control in controls.items():
        update: dict[str, ActionSection | None] = {key: _run_part(getattr(control, key)) for key in DIRECTIONS}
        if (part := _run_part(control)) or any(update.values()):
            update |= {} if part else dict.fromkeys(("press", "hold", "axis"))
            kept[name] = control.model_copy(update=update)
    return kept


def _run_part(action: ActionSection | None) -> ActionSection | None:
    return action if action is not None and {action.press, action.hold} & RUN_COMMANDS else None


@contextmanager
def open_inputs(
    sections: Sequence[InputSection],
    now: Callable[[], float],
    backend: HidBackend | None = None,
    *,
    dead_zone: float | None = None,
    expo: float | None = None,
    stop_only: bool = False,
    polled: bool = False,
) -> Iterator[list[HidInput]]:
    """The devices of a profile, started, in its order; without sections any joystick.

    `polled`: on the virtual clock, from a backend of recordings. Raises DeviceError when no device can be read here at
    all, DocumentError when a pad cannot be used.
    """
    devices, sections = backend or AllDevices(), sections or [InputSection()]
    claims = Claims(sections, exchangeable=stop_only)
    shipped()  # read now: once the loop runs nothing shall keep it waiting
    with ExitStack() as stack:
        inputs = [
            HidInput(
                *(section, devices, now),
                claims=claims,
                dead_zone=dead_zone,
                expo=expo,
                stop_only=stop_only,
                polled=polled,
            )
            for section in sections
        ]
        yield [stack.enter_context(each) for each in inputs]
