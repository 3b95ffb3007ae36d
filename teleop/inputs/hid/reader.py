"""The thread that finds one device, reads it until it is unplugged, and finds it again.

Everything that may take its time is done here: listing what is plugged in, opening, reading, asking. The control
thread sees a `Plugged` or None, and asks that for its values. Several readers share their `Claims`, so that two do not
take the same device. What waits is kept apart from what is done between the waits (`Steps`), so that recorded devices
are read by the same code on the virtual clock.

Between two openings there is always a pause. One that opens and then fails at its first read (EIO) was never there:
it is not handed over, the next device is tried, and the pause grows with each round that found nothing else.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from teleop.config.inputs_section import InputSection
from teleop.inputs.evdev.backend import missing_package
from teleop.inputs.hid.backend import DeviceInfo, HidBackend, HidDevice, MissingPackageError, described
from teleop.inputs.hid.claims import Claims
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.pads import Chosen, choose
from teleop.inputs.hid.selection import together, wanted
from teleop.inputs.hid.state import HidState
from teleop.inputs.hid.steps import Pause, PolledSteps, Read, Steps

LOOK_EVERY = 1.0  # s between two looks for a device that is missing
LOOKS_APART = 8  # times as far apart as that, at most, while the only device there cannot be read
WAIT = 0.05  # s for a report, after which the thread looks whether it is to end
ASK_AFTER = 0.1  # s without a report until one is asked for: ten times a second
_UNASKED = 64  # bytes: the longest report of a full-speed USB device, where a descriptor has none


class Plugged:
    """A device from its plugging in to its unplugging: its identity, its mapping, its reports."""

    def __init__(self, info: DeviceInfo, state: HidState, chosen: Chosen, mapped: Mapped) -> None:
        self.info, self.state, self.chosen, self.mapped = info, state, chosen, mapped
        self.missing = sorted(mapped.names - state.names)
        state.watched, state.counting = mapped.watched, mapped.counting
        self._ids = state.report_ids(mapped.names)
        state.vital = frozenset(self._ids)
        self._askable, self._asked = bool(self._ids), -float("inf")

    @property
    def on_change(self) -> bool:
        """Whether its silence is no fault, as long as it is at rest or answers when asked."""
        return self.chosen.reports == "on-change" or (self.chosen.reports == "auto" and not self.state.cadence.steady)

    def ask(self, device: HidDevice, now: Callable[[], float]) -> None:
        """Ask for its reports, if it has been quiet for a while and answers; one that once did not is left alone."""
        time = now()
        if not self._askable or not self.on_change or time - max(self.state.last, self._asked) < ASK_AFTER:
            return
        self._asked = time
        try:
            for number in self._ids:
                length = self.state.length(number) or _UNASKED
                answer = device.get_input_report(number, length)
                self._askable = self._askable and bool(answer)
                self.state.take(answer, now(), asked=True)
        except OSError:  # it does not answer, or it is gone, which the next read will say
            self._askable = False


class HidReader:
    """`plugged` is the device while it is there; `refused` why one that is there cannot be used, "" otherwise.

    It waits in a thread of its own once `start`ed. On a virtual clock it has none: `poll` does what is due by then.
    """

    def __init__(
        self,
        section: InputSection,
        backend: HidBackend,
        now: Callable[[], float],
        claims: Claims,
        mapped: Callable[[Chosen, HidState, DeviceInfo], Mapped],
    ) -> None:
        self._section, self._backend, self._now, self._claims, self._mapped = section, backend, now, claims, mapped
        self.plugged: Plugged | None = None
        self.last: DeviceInfo | None = None  # the device that was there, which is taken again before any other
        self.is_chosen = False  # whether another device, or another input, would have done
        self._stayed: frozenset[bytes] | None = None  # what was plugged in when it was unplugged, and still is
        self.refused = ""
        self._refusal = ""  # what `refused` will be after this round
        self._broken = False  # whether a device of this round opened and could not be read
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"hid {section.device}", daemon=True)
        self._polled: PolledSteps | None = None

    def start(self) -> None:
        self._thread.start()

    def poll(self, now: float) -> None:
        """Do all that is due by `now`, without waiting; only devices that know when they report are read so."""
        if self._polled is None:
            self._polled = PolledSteps(self._steps(), now)
            self._now = lambda: self._polled.time if self._polled else now
        self._polled.advance(now)

    def close(self) -> None:
        """Returns when the thread has ended, or is stuck in a driver; as a daemon it does not keep the program."""
        self._stop.set()
        if self._polled is not None:
            self._polled.close()
        if self._thread.is_alive():
            self._thread.join(2 * WAIT + LOOK_EVERY)

    def _run(self) -> None:
        steps = self._steps()
        try:
            request = next(steps)
            while not self._stop.is_set():
                try:
                    report = self._wait(request)
                except OSError as error:
                    request = steps.throw(error)
                else:
                    if not self._stop.is_set():
                        request = steps.send(report)
        except Exception as fault:  # noqa: BLE001 - a thread that ends unseen would leave a device that never reports
            self.refused = f"its reader failed: {fault or type(fault).__name__}"
        finally:
            steps.close()
            self.plugged = None

    def _wait(self, request: Pause | Read) -> bytes:
        if isinstance(request, Read):
            return request.device.read(request.seconds)
        self._stop.wait(request.seconds)
        return b""

    def _steps(self) -> Steps:
        apart = 1  # times LOOK_EVERY
        while True:
            self._broken = False
            yield from self._serve()
            apart = min(2 * apart, LOOKS_APART) if self._broken else 1
            yield Pause(apart * LOOK_EVERY)

    def _serve(self) -> Steps:
        """Find the device and read it until it is gone; whether there was one."""
        try:
            found = self._backend.enumerate()
        except OSError as error:
            self.refused = f"devices cannot be listed: {error}"
            return False
        self._refusal = ""
        if self.last is not None:
            there = frozenset(info.path for info in found)
            self._stayed = there if self._stayed is None else self._stayed & there
        fitting = wanted(self._section.device, found, self.last, self._stayed or ())
        groups = together([info for info in fitting if self._may_take(info, found)])
        self.is_chosen = len(groups) > 1 or any(self._claims.shared(self._section, group[0]) for group in groups)
        was_there = False
        for group in groups:
            was_there = was_there or (yield from self._try(group))
        self.refused = self._refusal  # only now: while it is tried again, nothing has changed
        return was_there

    def _may_take(self, info: DeviceInfo, found: Sequence[DeviceInfo]) -> bool:
        if self._claims.is_for_another(self._section, info):
            return False
        doubt = self._claims.doubt(self._section, info, found)
        self._refusal = doubt or self._refusal
        return not doubt and not self._claims.is_for_one_before(self._section, info)

    def _try(self, infos: Sequence[DeviceInfo]) -> Steps:
        """Read this device until it is gone, unless another reader has it; whether it could be read.

        Of a device with several interfaces the one that reports is read.
        """
        taken = [info for info in infos if self._claims.take(info.path, self._section)]
        opened: list[tuple[HidDevice, Plugged]] = []
        try:
            opened += [one for info in taken if (one := self._open(info))]
            return (yield from self._first_to_report(opened)) if opened else False
        finally:
            self.plugged = None
            for device, _plugged in opened:
                device.close()
            for info in taken:
                self._claims.release(info.path)

    def _open(self, info: DeviceInfo) -> tuple[HidDevice, Plugged] | None:
        device: HidDevice | None = None
        try:
            device = self._backend.open(info.path)
            descriptor = device.get_report_descriptor()
        except MissingPackageError as error:
            self._refusal = f"{described(info)} {error}"
            return None
        except OSError as error:
            if device is None:
                self._refusal = f"{described(info)} cannot be opened ({error}): check its udev rule: teleop doctor"
            else:
                device.close()
                self._fail(info, error)
            return None
        state = HidState(parse_descriptor(descriptor))
        chosen = choose(self._section, _as_guessed(info, state), state.guessable)
        if unusable := _unusable(chosen):
            self._refusal = f"{described(info)} cannot be used: {unusable}"
            device.close()
            return None
        return device, Plugged(info, state, chosen, self._mapped(chosen, state, info))

    def _fail(self, info: DeviceInfo, error: OSError) -> None:
        self._broken = True
        self._refusal = f"{described(info)} opens, but cannot be read ({error}): unplug it and plug it in again"

    def _first_to_report(self, opened: list[tuple[HidDevice, Plugged]]) -> Steps:
        """Wait until one of these interfaces has reported a control of the mapping, and read that one."""
        trying = list(opened)
        while trying:
            for each in list(trying):
                device, plugged = each
                try:
                    report = yield Read(device, WAIT / len(trying))
                    if self.plugged is None:
                        self._hand_over(plugged)
                    if report and len(trying) > 1:
                        plugged.state.take(report, self._now())
                    if len(trying) == 1 or plugged.mapped.names & plugged.state.values.keys():
                        self._close_others(opened, device)
                        self._hand_over(plugged)
                        yield from self._read(device, plugged, b"" if len(trying) > 1 else report)
                except OSError as error:  # unplugged, unless it was never there
                    trying.remove(each)
                    if self.plugged is plugged:
                        return True
                    self._fail(plugged.info, error)
        return False

    def _hand_over(self, plugged: Plugged) -> None:
        self.plugged, self.last, self._stayed, self.refused, self._broken = plugged, plugged.info, None, "", False
        self._claims.remember(self._section, plugged.info)

    def _close_others(self, opened: list[tuple[HidDevice, Plugged]], device: HidDevice) -> None:
        """Leave the other interfaces to other inputs."""
        for other, plugged in [each for each in opened if each[0] is not device]:
            other.close()
            self._claims.release(plugged.info.path)
        opened[:] = [each for each in opened if each[0] is device]

    def _read(self, device: HidDevice, plugged: Plugged, report: bytes) -> Steps:
        """From the first report on until it is unplugged, which is an OSError."""
        while True:
            if report:
                plugged.state.take(report, self._now())
            else:
                plugged.ask(device, self._now)
            report = yield Read(device, WAIT)


def _as_guessed(info: DeviceInfo, state: HidState) -> DeviceInfo:
    """The device, for the collection that a guess is made for: the system lists one that it is for by chance."""
    page, usage = state.purpose
    return info._replace(usage_page=page, usage=usage) if page else info


def _unusable(chosen: Chosen) -> str:
    """Why the device does nothing with this mapping, and the cure; "" where it does something."""
    if chosen.unreadable:
        install = missing_package()
        return f"{chosen.unreadable}; read its event device: {install}" if install else chosen.unreadable
    if chosen.guessed and not chosen.controls:
        return "it has no stick or button to guess a mapping for; teleop live --learn makes one"
    return ""
