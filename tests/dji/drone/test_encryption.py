"""Encrypted frames against published ones, and the ways in which there can be no key."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.drone.encryption import Cipher, CipherError, key_from_hex
from teleop.dji.frame import Frame, FrameReader

ENCRYPTED = [
    vector
    for vector in json.loads((Path(__file__).parents[2] / "data" / "onboard.json").read_text())["vectors"]
    if vector["enc"]
]
KEY = bytes(range(32))


@pytest.mark.parametrize("vector", ENCRYPTED, ids=lambda vector: vector["name"])
def test_published_frames(vector: dict[str, str]) -> None:
    (frame,) = FrameReader().feed(bytes.fromhex(vector["hex"]), 0.0)
    assert isinstance(frame, Frame)
    cipher = Cipher(key_from_hex(vector["key"], "test"))
    deciphered = cipher.decrypt(frame)
    assert deciphered is not None
    assert (deciphered.frame.data.hex(), len(deciphered.filling)) == (vector["data"], vector["pad"])
    data, encryption = cipher.encrypt(deciphered.frame.data, deciphered.filling)
    assert frame._replace(data=data, encryption=encryption).encode().hex() == vector["hex"]


@given(st.binary(min_size=1, max_size=100))
def test_whole_blocks_get_another_one(data: bytes) -> None:
    encrypted, encryption = Cipher(KEY).encrypt(data)
    assert (len(encrypted) % 16, encryption >> 5) == (0, 1)
    assert encryption & 0x1F == len(encrypted) - len(data) == 16 - len(data) % 16
    deciphered = Cipher(KEY).decrypt(Frame(encrypted, 2, 7, encryption))
    assert deciphered == (Frame(data, 2, 7), bytes(len(encrypted) - len(data)))


@given(st.binary(max_size=64), st.integers(0, 255))
def test_what_cannot_be_decrypted_is_none_and_nothing_else_is_lost(data: bytes, encryption: int) -> None:
    cipher, frame = Cipher(KEY), Frame(data, 0, 0, encryption)
    deciphered = cipher.decrypt(frame)
    if encryption >> 5 != 1 or not data or len(data) % 16:
        assert deciphered is None
    elif deciphered is not None:
        assert cipher.encrypt(deciphered.frame.data, deciphered.filling) == (data, encryption)


def test_filling_that_does_not_fill_is_refused() -> None:
    with pytest.raises(CipherError, match="2 bytes do not fill 3 up to blocks of 16"):
        Cipher(KEY).encrypt(b"abc", b"de")


@pytest.mark.parametrize("text", ["", "zz" * 32, "00" * 31, "00" * 33, "1234" * 8])
def test_a_key_that_is_none_is_not_repeated(text: str) -> None:
    with pytest.raises(CipherError) as raised:
        key_from_hex(text, "drone.yaml: key")
    assert str(raised.value) == "drone.yaml: key: a key is 64 hexadecimal digits"


def test_a_cipher_shows_no_key() -> None:
    assert KEY.hex() not in repr(Cipher(KEY)) + repr(vars(Cipher(KEY)))


def test_without_the_library_one_line_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("cryptography", "cryptography.hazmat.primitives.ciphers"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(CipherError) as raised:
        Cipher(KEY)
    assert str(raised.value) == "encryption needs the package cryptography: pip install 'rs-teleop[aes]'"
