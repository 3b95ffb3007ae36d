"""AES-256-ECB over the data of a frame (docs/protocol-facts.md): optional, off unless a key is given.

The data are filled up to whole blocks of 16 bytes, aligned data by a whole block; the header says by how many bytes,
not by which, so whoever wants a frame's own bytes back has to keep the filling. Nothing tells a wrong key: what comes
out of it is noise, which no message class describes. The library is an extra, imported when there is a key.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from teleop.core.errors import UsageError
from teleop.dji.frame import Frame

KEY_SIZE: Final = 32  # bytes
BLOCK: Final = 16  # bytes
_AES: Final = 1  # the kind of encryption, in bits 7..5 of the header's byte 4
_FILLING: Final = 0x1F  # its bits 4..0, the number of filling bytes


class CipherError(UsageError):
    """A key that is none, or nothing here that could use it."""


class Deciphered(NamedTuple):
    """A frame whose data are in the clear, and the bytes that had filled them up."""

    frame: Frame
    filling: bytes


class Cipher:
    """Encrypts and decrypts with one `key` of 32 bytes, which it never shows. Raises CipherError."""

    def __init__(self, key: bytes) -> None:
        if len(key) != KEY_SIZE:
            raise CipherError(f"a key has {KEY_SIZE} bytes, {2 * KEY_SIZE} hexadecimal digits, not {2 * len(key)}")
        try:
            from cryptography.hazmat.primitives.ciphers import Cipher as Library
            from cryptography.hazmat.primitives.ciphers import algorithms, modes
        except ImportError:
            raise CipherError("encryption needs the package cryptography: pip install 'rs-teleop[aes]'") from None
        self._aes = Library(algorithms.AES256(key), modes.ECB())

    def encrypt(self, data: bytes, filling: bytes | None = None) -> tuple[bytes, int]:
        """The data as they go into a frame, and its byte 4; nothing is encrypted where there are none.

        Raises CipherError for a `filling` that does not make whole blocks; without one it is zeros.
        """
        if not data and not filling:
            return b"", 0
        if filling is None:
            filling = bytes(BLOCK - len(data) % BLOCK)
        if len(filling) > _FILLING or (len(data) + len(filling)) % BLOCK:
            raise CipherError(f"{len(filling)} bytes do not fill {len(data)} up to blocks of {BLOCK}")
        encryptor = self._aes.encryptor()
        return encryptor.update(data + filling) + encryptor.finalize(), _AES << 5 | len(filling)

    def decrypt(self, frame: Frame) -> Deciphered | None:
        """An encrypted frame in the clear, its byte 4 zero; None where it is not one that can be. Never raises."""
        count = frame.encryption & _FILLING
        if frame.encryption >> 5 != _AES or not frame.data or len(frame.data) % BLOCK or count > len(frame.data):
            return None
        decryptor = self._aes.decryptor()
        plain = decryptor.update(frame.data) + decryptor.finalize()
        end = len(plain) - count
        return Deciphered(frame._replace(data=plain[:end], encryption=0), plain[end:])


def key_from_hex(text: str, place: str) -> bytes:
    """The key written in `text`, which came from `place`. Raises CipherError, whose text has nothing of the key."""
    try:
        key = bytes.fromhex(text.strip())
    except ValueError:
        key = b""
    if len(key) != KEY_SIZE:
        raise CipherError(f"{place}: a key is {2 * KEY_SIZE} hexadecimal digits")
    return key
