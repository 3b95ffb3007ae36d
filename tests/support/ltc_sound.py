"""LTC as libltc itself encodes it, for its decoder and ours: 16-bit samples of one channel."""

from __future__ import annotations

import array
import ctypes
from ctypes.util import find_library

NAME = "libltc.so.11"
STANDARD = {24: 3, 25: 1, 30: 0}  # LTC_TV_FILM_24, LTC_TV_625_50, LTC_TV_525_60


class _Time(ctypes.Structure):
    _fields_ = (
        ("zone", ctypes.c_char * 6),
        *((name, ctypes.c_ubyte) for name in ("years", "months", "days", "hours", "mins", "secs", "frame")),
    )


def is_installed() -> bool:
    try:
        ctypes.CDLL(NAME)
    except OSError:
        return find_library("ltc") is not None
    return True


def encoded(
    label: tuple[int, int, int, int],
    frames: int,
    fps: float,
    drop: bool = False,
    samples: int = 48000,
    back: bool = False,
) -> bytes:
    """So many frames from a label on; `back`: each and all of them backwards."""
    library = ctypes.CDLL(NAME)
    library.ltc_encoder_create.restype = ctypes.c_void_p
    library.ltc_encoder_create.argtypes = ctypes.c_double, ctypes.c_double, ctypes.c_int, ctypes.c_int
    for name in ("encode_frame", "encode_reversed_frame", "inc_timecode", "dec_timecode", "free"):
        getattr(library, f"ltc_encoder_{name}").argtypes = (ctypes.c_void_p,)
    library.ltc_encoder_set_timecode.argtypes = ctypes.c_void_p, ctypes.POINTER(_Time)
    library.ltc_encoder_copy_buffer.argtypes = ctypes.c_void_p, ctypes.c_void_p
    library.ltc_frame_increment.restype = ctypes.c_int
    whole = round(fps)
    encoder = library.ltc_encoder_create(samples, 30000 / 1001 if drop else fps, STANDARD[whole], 0)
    hours, minutes, seconds, number = label
    library.ltc_encoder_set_timecode(encoder, ctypes.byref(_Time(b"+0000", 0, 0, 0, hours, minutes, seconds, number)))
    buffer = (ctypes.c_ubyte * 65536)()
    sound = array.array("h")
    for _ in range(frames):
        (library.ltc_encoder_encode_reversed_frame if back else library.ltc_encoder_encode_frame)(encoder)
        count = library.ltc_encoder_copy_buffer(encoder, buffer)
        sound.extend((each - 128) * 256 for each in buffer[:count])
        (library.ltc_encoder_dec_timecode if back else library.ltc_encoder_inc_timecode)(encoder)
    library.ltc_encoder_free(encoder)
    return sound.tobytes()
