"""The options of commands that speak the drone's protocol without a rig: whose broadcast, and which key."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from teleop.core.errors import UsageError
from teleop.dji.drone.encryption import Cipher, CipherError, key_from_hex
from teleop.dji.json_record import MakeCipher

Model = Annotated[
    Literal["m100", "a3"],
    Parameter(help="Whose layout the broadcast has, which no frame says: a3 is the M600's, too."),
]
KeyFile = Annotated[
    Path | None,
    Parameter(
        metavar="FILE",
        help="File with the key of encrypted frames, 64 hexadecimal digits; without it, TELEOP_DJI_APP_KEY or the key "
        "in ~/.config/teleop/dji.yaml.",
        show_default=False,
    ),
]


def cipher_of(file: Path | None) -> MakeCipher | None:
    """A function that gives the cipher once something is encrypted; None without a key. Raises UsageError."""
    key = _read(file) if file is not None else _kept()
    return None if key is None else cache(lambda: Cipher(key))


def _read(file: Path) -> bytes:
    try:
        text = file.read_text(encoding="ascii")
    except OSError as error:
        raise UsageError(f"{file}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise CipherError(f"{file}: a key is 64 hexadecimal digits") from None
    return key_from_hex(text, str(file))


def _kept() -> bytes | None:
    from teleop.config.credentials import load_credentials

    return load_credentials().key
