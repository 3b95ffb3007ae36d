"""Where timecode comes in: a MIDI port or sound. A thread keeps what is heard; the event loop understands it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from time import monotonic
from typing import Protocol

from teleop.config.exchange.timecode import TimecodeSection
from teleop.exchange.timecode.ltc import LtcDecoder
from teleop.exchange.timecode.mtc import QUARTER, MtcDecoder
from teleop.exchange.timecode.sound import SampleClock, Sound
from teleop.exchange.timecode.tracker import Tracker
from teleop.links.midi_ports import MidiPort

MOST = 4096  # messages, or blocks of sound, that wait


class TimecodeInput(Protocol):
    """Open until it is closed."""

    def understand(self, tracker: Tracker) -> None:
        """Tell the tracker of what has come since the last time."""
        ...

    def trouble(self) -> str:
        """Why nothing more can come, "" while it can; may block."""
        ...

    def close(self) -> None: ...


class MtcInput:
    """Raises DeviceError where there is no such port."""

    def __init__(self, section: TimecodeSection) -> None:
        self._decoder = MtcDecoder(section.rate)
        self._heard: deque[tuple[float, Sequence[int]]] = deque(maxlen=MOST)
        self._port = MidiPort(section.port, "", section.api, section.virtual, self._hear, listens_only=True)

    def _hear(self, data: Sequence[int]) -> None:
        if data and data[0] == QUARTER:
            self._heard.append((monotonic(), data))

    def understand(self, tracker: Tracker) -> None:
        while self._heard:
            now, data = self._heard.popleft()
            tracker.hear(now)
            if (found := self._decoder.take(data, now)) is not None:
                tracker.take(found, now)

    def trouble(self) -> str:
        return "" if self._port.is_there else "the port is gone"

    def close(self) -> None:
        self._port.close()


class LtcInput:
    """Raises DeviceError where there is no such sound, UsageError without libltc."""

    def __init__(self, section: TimecodeSection) -> None:
        assert section.rate is not None
        assert section.device is not None
        self._decoder, self._clock = LtcDecoder(section.samples, section.rate), SampleClock(section.samples)
        self._heard: deque[tuple[float, bytes]] = deque(maxlen=MOST)
        self._half = b""  # a sample of which only a byte has come
        self._sound = Sound(section.device, section.samples, lambda data, now: self._heard.append((now, data)))

    def understand(self, tracker: Tracker) -> None:
        while self._heard:
            now, data = self._heard.popleft()
            block = self._half + data
            whole = len(block) // 2 * 2
            block, self._half = block[:whole], block[whole:]
            self._clock.add(len(block) // 2, now)
            tracker.offset = self._clock.offset
            for found in self._decoder.take(block):
                tracker.take(found, now)

    def trouble(self) -> str:
        return self._sound.ended

    def close(self) -> None:
        self._sound.close()
        self._decoder.close()


Opener = Callable[[TimecodeSection], TimecodeInput]
INPUTS: dict[str, Opener] = {"mtc": MtcInput, "ltc": LtcInput}
