"""The thread that finds one device, reads it until it is unplugged, and finds it again.

Everything that may take its time is done here: listing what is plugged in, opening, reading, asking. The control
thread sees a `Plugged` or None, and asks that for what it holds. Several readers share their `Claims`, so that two do
not take the same device.

Between two openings there is always a pause. One that opens and then fails at its first read (EIO) was never there:
it is not handed over, the next device is tried, and the pause grows with each round that found nothing else.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence

from teleop.config.inputs_section import DeviceSection, InputSection
from teleop.inputs.hid.backend import DeviceInfo, HidBackend, HidDevice, described
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.pads import STICKS, Chosen, choose, fits, pad_for
from teleop.inputs.hid.state import HidState

LOOK_EVERY = 1.0  # s between two looks for a device that is missing
LOOKS_APART = 8  # times as far apart as that, at most, while the only device there cannot be read
WAIT = 0.05  # s for a report, after which the thread looks whether it is to end
ASK_AFTER = 0.1  # s without a report until one is asked for: ten times a second
_UNASKED = 64  # bytes: the longest report of a full-speed USB device, where a descriptor has none
_OTHER_HANDS = frozenset({(0x01, 0x02), (0x01, 0x06), (0x01, 0x07)})  # mouse, keyboard, keypad


class Claims:
    """Which devices are taken, by their paths."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._taken: set[bytes] = set()

    def take(self, path: bytes) -> bool:
        with self._lock:
            free = path not in self._taken
            self._taken.add(path)
            return free

    def give_back(self, path: bytes) -> None:
        with self._lock:
            self._taken.discard(path)


class Plugged:
    """A device from its plugging in to its unplugging: what it is, what it does, what it has said."""

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
        return self.chosen.reports == "on-change" or (self.chosen.reports == "auto" and not self.state.steady)

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
    """`plugged` is the device while it is there; `refused` why one that is there cannot be used, "" otherwise."""

    def __init__(
        self,
        section: InputSection,
        backend: HidBackend,
        now: Callable[[], float],
        claims: Claims,
        mapped: Callable[[Chosen, HidState], Mapped],
    ) -> None:
        self._section, self._backend, self._now, self._claims, self._mapped = section, backend, now, claims, mapped
        self.plugged: Plugged | None = None
        self.last: DeviceInfo | None = None  # the device that was there, which is taken again before any other
        self._stayed: frozenset[bytes] | None = None  # what was plugged in when it was unplugged, and still is
        self.refused = ""
        self._refusal = ""  # what `refused` will be after this round
        self._broken = False  # whether a device of this round opened and could not be read
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"hid {section.device}", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """Returns when the thread has ended, or is stuck in a driver; a daemon, it then keeps nobody from leaving."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(2 * WAIT + LOOK_EVERY)

    def _run(self) -> None:
        apart = 1  # times LOOK_EVERY
        try:
            while not self._stop.is_set():
                self._broken = False
                self._serve()
                apart = min(2 * apart, LOOKS_APART) if self._broken else 1
                self._stop.wait(apart * LOOK_EVERY)
        except Exception as fault:  # noqa: BLE001 - a thread that ends unseen would leave a device that never reports
            self.refused = f"its reader failed: {fault or type(fault).__name__}"
        finally:
            self.plugged = None

    def _serve(self) -> None:
        """Find the device and read it until it is gone."""
        try:
            found = self._backend.enumerate()
        except OSError as error:
            self.refused = f"devices cannot be listed: {error}"
            return
        self._refusal = ""
        if self.last is not None:
            there = frozenset(info.path for info in found)
            self._stayed = there if self._stayed is None else self._stayed & there
        any(self._try(info) for info in wanted(self._section.device, found, self.last, self._stayed or ()))
        self.refused = self._refusal  # only now: while it is tried again, nothing has changed

    def _try(self, info: DeviceInfo) -> bool:
        """Read this device until it is gone, unless another reader has it; whether it could be read."""
        if self._stop.is_set() or not self._claims.take(info.path):
            return False
        try:
            return self._open(info)
        finally:
            self._claims.give_back(info.path)

    def _open(self, info: DeviceInfo) -> bool:
        try:
            device = self._backend.open(info.path)
        except OSError as error:
            self._refusal = f"{described(info)} cannot be opened ({error}): check its udev rule: teleop doctor"
            return False
        try:
            state = HidState(parse_descriptor(device.get_report_descriptor()))
            chosen = choose(self._section, info, state.names)
            if chosen.unreadable:
                self._refusal = f"{described(info)} cannot be used: {chosen.unreadable}"
                return False
            plugged = Plugged(info, state, chosen, self._mapped(chosen, state))
            report = device.read(WAIT)
            self.plugged, self.last, self._stayed, self.refused, self._broken = plugged, info, None, "", False
            self._read(device, plugged, report)
        except OSError as error:  # unplugged, unless it was never there
            if self.plugged is None:
                self._broken = True
                self._refusal = f"{described(info)} opens, but cannot be read ({error}): unplug it and plug it in again"
            return self.plugged is not None
        finally:
            self.plugged = None
            device.close()
        return True

    def _read(self, device: HidDevice, plugged: Plugged, report: bytes) -> None:
        """From the first report on until it is unplugged, which is an OSError, or until the end."""
        while not self._stop.is_set():
            if report:
                plugged.state.take(report, self._now())
            else:
                plugged.ask(device, self._now)
            report = device.read(WAIT)


def wanted(
    device: DeviceSection, found: Sequence[DeviceInfo], last: DeviceInfo | None, stayed: Collection[bytes] = ()
) -> Sequence[DeviceInfo]:
    """The devices that `device` may stand for, the best first.

    After an unplugging that is the `last` one, then its like, then a spare that somebody has plugged in since: another
    model that had been there all along (`stayed`, by path) was not meant. A keyboard or a mouse is taken only where its
    ids are asked for, anything else that is no joystick and no known pad where its name is.
    """
    fitting = [info for info in found if fits(device, info) and (device.vendor is not None or _for_hands(device, info))]
    if last is not None:
        fitting = [info for info in fitting if _alike(info, last) or info.path not in stayed]

    def rank(info: DeviceInfo) -> tuple[bool, bool, bool, bool, bytes]:
        usage = (info.usage_page, info.usage)
        other = last is not None and not _alike(info, last)
        serial = last.serial if last is not None else ""
        return other, info.serial != serial, usage not in STICKS, usage in _OTHER_HANDS, info.path

    return sorted(fitting, key=rank)


def _alike(one: DeviceInfo, two: DeviceInfo) -> bool:
    return (one.vendor_id, one.product_id) == (two.vendor_id, two.product_id)


def _for_hands(device: DeviceSection, info: DeviceInfo) -> bool:
    usage = (info.usage_page, info.usage)
    if usage in STICKS or pad_for(info):
        return usage not in _OTHER_HANDS
    return not device.any and info.usage_page != 0 and usage not in _OTHER_HANDS  # 0: the system does not say
