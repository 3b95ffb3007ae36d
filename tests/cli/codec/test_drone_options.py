"""Where the key of encrypted frames comes from."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.cli.codec.drone_options import cipher_of
from teleop.core.errors import UsageError
from teleop.dji.drone.encryption import Cipher, CipherError
from teleop.dji.json_record import MakeCipher

KEY, OTHER = "0f" * 32, "a5" * 32
DATA = b"sixteen bytes it"


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    for name in ("TELEOP_DJI_APP_ID", "TELEOP_DJI_APP_KEY"):
        monkeypatch.delenv(name, raising=False)


def encrypted(make: MakeCipher | None) -> bytes:
    assert make is not None
    return make().encrypt(DATA)[0]


def by(key: str) -> bytes:
    return Cipher(bytes.fromhex(key)).encrypt(DATA)[0]


def test_without_a_key_there_is_no_cipher() -> None:
    assert cipher_of(None) is None


def test_a_file_that_is_given_goes_before_the_key_that_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", KEY)
    (tmp_path / "key").write_text(f"{OTHER.upper()}\n")
    assert encrypted(cipher_of(None)) == by(KEY)
    assert encrypted(cipher_of(tmp_path / "key")) == by(OTHER)


def test_the_cipher_is_made_when_it_is_needed_and_once(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[bytes] = []
    monkeypatch.setattr("teleop.cli.codec.drone_options.Cipher", made.append)
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", KEY)
    make = cipher_of(None)
    assert make is not None
    assert made == []
    make()
    make()
    assert made == [bytes.fromhex(KEY)]


def test_a_file_that_cannot_be_read_is_said_in_a_line(tmp_path: Path) -> None:
    with pytest.raises(UsageError) as caught:
        cipher_of(tmp_path / "none")
    assert str(caught.value) == f"{tmp_path}/none: No such file or directory"


@pytest.mark.parametrize("content", [b"", b"\xff" * 64, b"0f" * 31, b"0g" * 32])
def test_a_file_without_a_key_is_named_and_nothing_of_it_is_shown(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "key").write_bytes(content)
    with pytest.raises(CipherError) as caught:
        cipher_of(tmp_path / "key")
    assert str(caught.value) == f"{tmp_path}/key: a key is 64 hexadecimal digits"
