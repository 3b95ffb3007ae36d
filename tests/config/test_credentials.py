"""The app id and key are found where they may stand, and shown nowhere."""

from __future__ import annotations

import traceback
from pathlib import Path

import pytest

from teleop.config.credentials import Credentials, default_file, load_credentials
from teleop.config.documents.document import DocumentError
from teleop.dji.drone.messages import Activate

ID, KEY = 1030093, "00112233445566778899aabbccddeeff0123456789abcdeffedcba9876543210"


@pytest.fixture(autouse=True)
def _own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    for name in ("TELEOP_DJI_APP_ID", "TELEOP_DJI_APP_KEY"):
        monkeypatch.delenv(name, raising=False)


def test_without_credentials_the_error_names_both_places(tmp_path: Path) -> None:
    found = load_credentials()
    assert (found.app_id, found.key, found.cipher) == (None, None, None)
    with pytest.raises(DocumentError) as raised:
        found.activation()
    assert str(raised.value) == (
        f"the drone needs the app id that DJI gave you: in TELEOP_DJI_APP_ID, or app_id in {tmp_path}/teleop/dji.yaml"
    )


def test_the_environment_goes_before_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "teleop").mkdir()
    (tmp_path / "teleop" / "dji.yaml").write_text(f'app_id: 7\nkey: "{KEY}"\n')
    assert load_credentials().app_id == 7
    monkeypatch.setenv("TELEOP_DJI_APP_ID", str(ID))
    found = load_credentials()
    assert (found.app_id, found.key) == (ID, bytes.fromhex(KEY))
    assert found.activation() == Activate(ID)
    assert found.cipher is not None
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", "ff" * 32)
    assert load_credentials().key == b"\xff" * 32


def test_a_file_that_is_given_is_the_only_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(f"app_id: {ID}\n")
    monkeypatch.setenv("TELEOP_DJI_APP_KEY", KEY)
    monkeypatch.setenv("TELEOP_DJI_APP_ID", "7")
    found = load_credentials(file)
    assert (found.app_id, found.key) == (ID, None)


def test_where_it_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", "/home/somebody")
    monkeypatch.delenv("XDG_CONFIG_HOME")
    assert default_file() == Path("/home/somebody/.config/teleop/dji.yaml")
    monkeypatch.setenv("XDG_CONFIG_HOME", "relative")
    assert default_file() == Path("/home/somebody/.config/teleop/dji.yaml")


@pytest.mark.parametrize(
    ("text", "problems"),
    [
        ("app_id: 5ec2e7\n", ["1:9: app_id must be a whole number, 0..4294967295"]),
        ("app_id: 4294967296\n", ["1:9: app_id must be a whole number, 0..4294967295"]),
        ("app_id: true\n", ["1:9: app_id must be a whole number, 0..4294967295"]),
        ("key: 5ec2e7\n", ["1:6: key must be 64 hexadecimal digits, in quotes"]),
        (f"key: {'1' * 64}\n", ["1:6: key must be 64 hexadecimal digits, in quotes"]),
        (
            "app_id: x\nkey: [5ec2e7]\nsecret: 5ec2e7\n",
            [
                "1:9: app_id must be a whole number, 0..4294967295",
                "2:6: key must be 64 hexadecimal digits, in quotes",
                "3:1: unknown key `secret`; the keys are app_id and key",
            ],
        ),
        ("5ec2e7\n", ["1:1: must have app_id: and key:, or one of them"]),
        ("key: '5ec2e7\n", ["2:1: not YAML: found unexpected end of stream"]),
    ],
)
def test_errors_of_the_file_say_where_and_not_what(text: str, problems: list[str], tmp_path: Path) -> None:
    file = tmp_path / "dji.yaml"
    file.write_text(text)
    with pytest.raises(DocumentError) as raised:
        load_credentials(file)
    assert raised.value.problems == [f"{file}:{problem}" for problem in problems]
    assert "5ec2e7" not in "".join(traceback.format_exception(raised.value))


@pytest.mark.parametrize(
    ("name", "text", "error"),
    [
        ("TELEOP_DJI_APP_ID", "5ec2e7", "TELEOP_DJI_APP_ID must be a whole number, 0..4294967295"),
        ("TELEOP_DJI_APP_ID", "99999999999", "TELEOP_DJI_APP_ID must be a whole number, 0..4294967295"),
        ("TELEOP_DJI_APP_ID", "-1", "TELEOP_DJI_APP_ID must be a whole number, 0..4294967295"),
        ("TELEOP_DJI_APP_KEY", "5ec2e7", "TELEOP_DJI_APP_KEY: a key is 64 hexadecimal digits"),
    ],
)
def test_errors_of_the_environment(name: str, text: str, error: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(name, text)
    with pytest.raises(DocumentError) as raised:
        load_credentials()
    assert str(raised.value) == error
    assert text not in "".join(traceback.format_exception(raised.value))


def test_nothing_that_is_printed_has_a_secret_in_it() -> None:
    found = Credentials("somewhere", ID, bytes.fromhex(KEY))
    shown = repr(found) + str(found) + repr(found.activation()) + repr(found.cipher) + f"{found!r:>90}"
    for secret in (str(ID), hex(ID)[2:], KEY, repr(bytes.fromhex(KEY))):
        assert secret not in shown
