"""Serial numbers, blanked in what is captured: the frame that has one is made anew, with zeros and right checks.

Where they are: in the reply to a question for the version, behind the version of a gimbal, as the id of a drone; in any
reply of a gimbal that is not known, as a run of capital letters and digits; the app's id and bundle of an activation
are secrets too. A frame lies in several CAN frames, so these are held back until the frame is whole, 0.1 s at most.
What is encrypted and what has other CAN ids is kept as it is.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterator

from teleop.captures.captured import Captured, Source
from teleop.dji.drone import messages as drone
from teleop.dji.frame import Frame, FrameReader
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import Opaque, Result
from teleop.links.can import GIMBAL_ID, HOST_ID

_NUMBER = re.compile(rb"(?=[A-Z]*[0-9])[0-9A-Z]{10,20}")  # as DJI's are: 10 to 20 capital letters and digits
_RECENT = 256  # requests whose replies may still come
_ID = slice(6, 17)  # of the drone's reply to a question for its version: code, checksum, id
_NAME = b"SDK"  # how the name behind the id begins
_APP_ID, _BUNDLE = slice(2, 6), slice(14, 46)  # of an activation


class SerialNumbers:
    """Frames go in as they were heard, come out in the same order; `blanked` counts the numbers."""

    def __init__(self, source: Source) -> None:
        self.blanked = 0
        self._waiting: deque[tuple[Captured, _Stream | None, int]] = deque()
        self._asked: dict[int, bytes] = {}  # set and id by sequence number
        self._is_can, self._is_drone = source.kind == "can", source.device == "drone"
        self._streams: dict[int, _Stream] = {}

    def add(self, frame: Captured) -> None:
        """A frame that was captured; it comes out of `settled`."""
        stream = self._stream_of(frame)
        self._waiting.append((frame, stream, stream.end if stream else 0))
        if stream:
            self._blank(stream, stream.feed(frame))

    def settled(self, now: float) -> Iterator[Captured]:
        """Those in which nothing can be found any more at `now` (s since 1970)."""
        for stream in self._streams.values():
            self._blank(stream, stream.flush(now))
        while self._waiting:
            frame, stream, start = self._waiting[0]
            if stream is None:
                yield frame
            elif stream.is_settled(start + len(frame.data)):
                yield frame._replace(data=stream.taken(start, len(frame.data)))
            else:
                return
            self._waiting.popleft()

    def _stream_of(self, frame: Captured) -> _Stream | None:
        if frame.extended or frame.remote or frame.error or (self._is_can and frame.id not in (HOST_ID, GIMBAL_ID)):
            return None
        if frame.id not in self._streams:
            self._streams[frame.id] = _Stream(self._is_can)
        return self._streams[frame.id]

    def _blank(self, stream: _Stream, found: list[Frame]) -> None:
        for frame in found:
            blank = self._blank_drone(frame) if self._is_drone else self._blank_gimbal(frame)
            if blank != frame.data:
                self.blanked += 1
            stream.replace(frame, frame._replace(data=blank))

    def _blank_gimbal(self, frame: Frame) -> bytes:
        if not frame.is_reply:
            self._asked[frame.sequence] = frame.data[:2]
            if len(self._asked) > _RECENT:
                del self._asked[next(iter(self._asked))]
            return frame.data
        decoded = R_SDK.decode(frame, self._asked.get(frame.sequence, b""))
        message = decoded.message
        if isinstance(message, gimbal.VersionReply) and message.extra:
            return frame.data[: -len(message.extra)] + bytes(len(message.extra))
        if isinstance(message, Opaque | Result):
            return _NUMBER.sub(lambda match: bytes(len(match[0])), frame.data)
        return frame.data

    def _blank_drone(self, frame: Frame) -> bytes:
        data = bytearray(frame.data)
        if frame.is_encrypted:
            return frame.data
        if frame.is_reply and data[_ID.stop : _ID.stop + len(_NAME)] == _NAME:
            data[_ID] = bytes(_ID.stop - _ID.start)
        elif not frame.is_reply and data[:2] == drone.Activate.set_and_id:
            for secret in (_APP_ID, _BUNDLE):
                data[secret] = bytes(len(data[secret]))
        return bytes(data)


class _Stream:
    """The bytes of one sender that are still held back; positions count from the first that it ever sent."""

    def __init__(self, in_pieces: bool) -> None:
        self._reader = FrameReader(in_pieces=in_pieces)
        self._bytes = bytearray()
        self._begin = 0  # position of the first byte held
        self._searched = 0  # position up to which frames were found

    @property
    def end(self) -> int:
        return self._begin + len(self._bytes)

    def feed(self, frame: Captured) -> list[Frame]:
        self._bytes += frame.data
        return [found for found in self._reader.feed(frame.data, frame.time) if isinstance(found, Frame)]

    def flush(self, now: float) -> list[Frame]:
        return [found for found in self._reader.flush(now) if isinstance(found, Frame)]

    def replace(self, frame: Frame, blank: Frame) -> None:
        """Put `blank` where `frame` is, which is as long."""
        before = frame.encode()
        start = self._bytes.find(before, max(0, self._searched - self._begin))
        if start < 0:
            return
        if blank != frame:
            self._bytes[start : start + len(before)] = blank.encode()
        self._searched = self._begin + start + len(before)

    def is_settled(self, position: int) -> bool:
        return position <= self.end - self._reader.held

    def taken(self, start: int, size: int) -> bytes:
        """The bytes from `start` on, which are the first that are held."""
        data = bytes(self._bytes[:size])
        del self._bytes[:size]
        self._begin = start + size
        return data
