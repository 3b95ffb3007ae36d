"""LTC, which is timecode as sound, to readings: by libltc, where it is installed. Blocks of samples in, labels out."""

from __future__ import annotations

import ctypes
from contextlib import suppress
from ctypes.util import find_library
from typing import Any

from teleop.core.errors import UsageError
from teleop.exchange.timecode.reading import Fault, Reading

NAMES = ("libltc.so.11", "libltc.11.dylib", "libltc.dll")
QUEUE = 32  # frames that the library keeps for us
BITS = 80
MOST = 1 << 16  # samples in a block


class _Frame(ctypes.Structure):
    """`LTCFrameExt` of ltc.h."""

    _fields_ = (
        ("bits", ctypes.c_uint32 * 3),
        ("start", ctypes.c_longlong),
        ("end", ctypes.c_longlong),
        ("reverse", ctypes.c_int),
        ("tics", ctypes.c_float * BITS),
        ("least", ctypes.c_ubyte),
        ("most", ctypes.c_ubyte),
        ("volume", ctypes.c_double),
    )


def library() -> Any:
    """libltc. Raises UsageError where it is not installed."""
    for name in (*NAMES, find_library("ltc") or ""):
        if name:
            with suppress(OSError):
                return _declared(ctypes.CDLL(name))
    raise UsageError("LTC needs libltc: sudo apt install libltc11, or brew install libltc")


def _declared(found: Any) -> Any:
    found.ltc_decoder_create.restype = ctypes.c_void_p
    found.ltc_decoder_create.argtypes = ctypes.c_int, ctypes.c_int
    found.ltc_decoder_free.argtypes = (ctypes.c_void_p,)
    found.ltc_decoder_write_s16.argtypes = ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.c_longlong
    found.ltc_decoder_read.argtypes = ctypes.c_void_p, ctypes.POINTER(_Frame)
    return found


class LtcDecoder:
    """`samples` in a second, of `fps` frames in a second at the most usual speed. Close it."""

    def __init__(self, samples: int, fps: float) -> None:
        self._library, self._samples = library(), samples
        self._decoder = self._library.ltc_decoder_create(int(samples / fps), QUEUE)
        self._count = 0

    def take(self, block: bytes) -> list[Reading | Fault]:
        """What a block of 16-bit samples completes, timed by the samples: in s since the first one."""
        block = block[: len(block) // 2 * 2]
        found: list[Reading | Fault] = []
        for first in range(0, len(block), 2 * MOST):
            part = block[first : first + 2 * MOST]
            self._library.ltc_decoder_write_s16(self._decoder, part, len(part) // 2, self._count)
            self._count += len(part) // 2
            frame = _Frame()
            while self._library.ltc_decoder_read(self._decoder, ctypes.byref(frame)):
                found.append(_reading(frame, self._samples))
        return found

    def close(self) -> None:
        if self._decoder:
            self._library.ltc_decoder_free(self._decoder)
            self._decoder = None


def _reading(frame: _Frame, samples: int) -> Reading | Fault:
    if frame.reverse:
        return Fault("runs backwards")
    data = bytes(frame.bits)
    units = [data[place] & 15 for place in (6, 4, 2, 0)]
    tens = [data[place] & mask for place, mask in ((7, 3), (5, 7), (3, 7), (1, 3))]
    if any(unit > 9 for unit in units):
        return Fault("has a label that does not exist")
    hours, minutes, seconds, frames = (10 * ten + unit for ten, unit in zip(tens, units, strict=True))
    return Reading(frame.start / samples, (hours, minutes, seconds, frames), bool(data[1] & 4))
