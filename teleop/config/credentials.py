"""The drone's app id and key: secrets, which stand in the environment or in a file of their own, and nowhere else.

Not on a command line, which every user of the machine can read, nor in a profile, which is shared. Neither repr nor
error shows any of them, so that no log, take or traceback can; hence checks of our own: pydantic quotes what it
refuses.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Final

from teleop.config.documents.document import Document, DocumentError
from teleop.config.documents.yaml_loader import read_document
from teleop.config.folders import config_folder
from teleop.dji.drone.encryption import Cipher, CipherError, key_from_hex
from teleop.dji.drone.messages import Activate

APP_ID: Final = "TELEOP_DJI_APP_ID"
APP_KEY: Final = "TELEOP_DJI_APP_KEY"
_LARGEST: Final = 0xFFFFFFFF
_ID: Final = f"must be a whole number, 0..{_LARGEST}"
_KEY: Final = "must be 64 hexadecimal digits, in quotes"


@dataclass(frozen=True)
class Credentials:
    """The developer's app id and key from DJI; None without. `place` is where a missing one could be put."""

    place: str
    app_id: int | None = field(default=None, repr=False)
    key: bytes | None = field(default=None, repr=False)

    def activation(self) -> Activate:
        """The message that activates the drone. Raises DocumentError without an app id."""
        if self.app_id is None:
            raise DocumentError(
                [f"the drone needs the app id that DJI gave you: in {APP_ID}, or app_id in {self.place}"]
            )
        return Activate(self.app_id)

    @cached_property
    def cipher(self) -> Cipher | None:
        """What encrypts and decrypts, None without a key. Raises CipherError where the library for it is missing."""
        return None if self.key is None else Cipher(self.key)


def default_file() -> Path:
    """Where the credentials are kept, unless they are in the environment. Raises UsageError without a home."""
    return config_folder(f"give the app id in {APP_ID}, or set XDG_CONFIG_HOME") / "dji.yaml"


def load_credentials(file: Path | None = None) -> Credentials:
    """Those in `file` if it is given; else of the environment and, for what is not there, of the default file.

    Raises DocumentError for what cannot be used, without saying what it was.
    """
    if file is not None:
        return _read(file)
    home = default_file()
    kept = _read(home) if home.is_file() else Credentials(str(home))
    return Credentials(str(home), _environment_id(kept.app_id), _environment_key(kept.key))


def app_cipher(encrypted: bool) -> Cipher | None:
    """What encrypts, by the app's key; raises DocumentError where there is none."""
    if not encrypted:
        return None
    credentials = load_credentials()
    if credentials.cipher is None:
        raise DocumentError([f"encrypted: true needs the app's key: in {APP_KEY}, or key in {credentials.place}"])
    return credentials.cipher


def _environment_id(otherwise: int | None) -> int | None:
    text = os.environ.get(APP_ID, "").strip()
    if not text:
        return otherwise
    if not (text.isascii() and text.isdigit() and len(text) <= 10 and int(text) <= _LARGEST):
        raise DocumentError([f"{APP_ID} {_ID}"])
    return int(text)


def _environment_key(otherwise: bytes | None) -> bytes | None:
    text = os.environ.get(APP_KEY, "").strip()
    if not text:
        return otherwise
    try:
        return key_from_hex(text, APP_KEY)
    except CipherError as error:
        raise DocumentError([str(error)]) from None


def _read(file: Path) -> Credentials:
    document = read_document(file)
    if problems := [*document.flawed(), *_problems(document)]:
        raise DocumentError(problems)
    key = document.data.get("key")
    return Credentials(str(file), document.data.get("app_id"), None if key is None else bytes.fromhex(key))


def _problems(document: Document) -> Iterator[str]:
    data = document.data
    if not isinstance(data, dict):
        yield document.problem((), "must have app_id: and key:, or one of them")
        return
    for name, value in data.items():
        if name == "app_id":
            if value is not None and (type(value) is not int or not 0 <= value <= _LARGEST):
                yield document.problem((name,), _ID)
        elif name == "key":
            if value is not None and not _is_key(value):
                yield document.problem((name,), _KEY)
        else:
            yield document.key_problem((name,), f"unknown key `{name}`; the keys are app_id and key")


def _is_key(value: object) -> bool:
    try:
        return isinstance(value, str) and bool(key_from_hex(value, "key"))
    except CipherError:
        return False
