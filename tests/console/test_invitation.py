"""How somebody gets to the console: addresses, tokens, the QR code, and TLS."""

from __future__ import annotations

import json
import os
import ssl
import subprocess
import sys
from pathlib import Path

import pytest
import segno

from teleop.config.exchange.address import is_loopback
from teleop.console.certificate import with_tls
from teleop.console.invitation import as_json, fingerprint, invitation, qr_lines, reachable_host, url
from teleop.console.settings import ConsoleSettings, listen, parse_bind, with_tokens
from teleop.core.errors import DeviceError, UsageError

EVERYWHERE = ConsoleSettings("0.0.0.0", 8470)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("127.0.0.1:0", ("127.0.0.1", 0)),
        ("0.0.0.0:9000", ("0.0.0.0", 9000)),
        (":9000", ("127.0.0.1", 9000)),
        ("192.168.1.7", ("192.168.1.7", 8470)),
        ("[::1]:9000", ("::1", 9000)),
        ("[::1]", ("::1", 8470)),
    ],
)
def test_an_address_is_host_and_port(text, found):
    assert parse_bind(text) == found


@pytest.mark.parametrize("text", ["a:b", "1.2.3.4:99999", "1.2.3.4:-1", "1.2.3.4:"])
def test_a_wrong_address_is_refused_with_an_example(text):
    with pytest.raises(UsageError, match=r"as in 127\.0\.0\.1:8470"):
        parse_bind(text)


def test_loopback_needs_no_token_and_every_other_address_does():
    assert with_tokens(ConsoleSettings()).is_open
    settings = with_tokens(EVERYWHERE)
    assert len(settings.token) >= 22
    assert len(settings.watch_token) >= 22
    assert settings.token != settings.watch_token
    assert with_tokens(ConsoleSettings(token="mine")).token == "mine"
    assert with_tokens(ConsoleSettings(token="mine")).watch_token
    assert not is_loopback("0.0.0.0")
    assert not is_loopback("rig.example")


def test_the_token_is_behind_the_hash_where_no_request_has_it():
    settings = with_tokens(ConsoleSettings(port=9000, token="mine"))
    assert url(settings) == "http://127.0.0.1:9000/login#mine"
    assert url(settings, "watch").endswith(f"/login#{settings.watch_token}")
    assert as_json(settings)["token"] == "mine"
    assert as_json(ConsoleSettings()) == {
        "url": "http://127.0.0.1:8470/",
        "token": None,
        "watch_url": "http://127.0.0.1:8470/",
        "watch_token": None,
    }


def test_the_terminal_shows_a_qr_code_that_fits_it_where_a_phone_can_reach():
    settings = with_tokens(EVERYWHERE)
    lines = [*invitation(settings).lines, *invitation(settings).code]
    assert any(settings.token in line for line in lines)
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 80
    assert not any("█" in line for line in invitation(ConsoleSettings()).lines)


def test_the_qr_code_is_that_of_the_text():
    lines = qr_lines("http://192.168.1.7:8470/login#abc")
    rows = [row for line in lines for row in ([c in "█▀" for c in line], [c in "█▄" for c in line])]
    matrix = segno.make("http://192.168.1.7:8470/login#abc", error="l", micro=False).matrix
    size = len(matrix)
    assert [[not light for light in row[2 : 2 + size]] for row in rows[2 : 2 + size]] == [
        [bool(dark) for dark in row] for row in matrix
    ]


def test_a_host_that_is_every_interface_is_shown_as_one_that_can_be_reached():
    assert reachable_host("192.168.1.7") == "192.168.1.7"
    assert reachable_host("0.0.0.0") != "0.0.0.0"


def test_port_0_picks_one_and_settings_pass_through_json():
    listener, settings = listen(ConsoleSettings(port=0))
    with listener:
        assert settings.port == listener.getsockname()[1] != 0
        assert ConsoleSettings.from_json(settings.as_json()) == settings
        with pytest.raises(DeviceError, match="choose another port"):
            listen(settings)


def test_a_certificate_is_made_once_kept_for_its_owner_and_good_for_tls():
    settings = with_tls(ConsoleSettings("127.0.0.1"))
    again = with_tls(ConsoleSettings("127.0.0.1"))
    assert settings.certificate == again.certificate
    assert fingerprint(settings.certificate) == fingerprint(again.certificate)
    for file in (settings.certificate, settings.key):
        assert os.stat(file).st_mode & 0o077 == 0
    trusting = ssl.create_default_context(cafile=settings.certificate)
    assert trusting.cert_store_stats()["x509"] == 1
    assert url(settings).startswith("https://")


def test_a_certificate_for_another_address_is_made_anew():
    first = fingerprint(with_tls(ConsoleSettings("127.0.0.1")).certificate)
    assert fingerprint(with_tls(ConsoleSettings("192.0.2.9")).certificate) != first


def test_files_that_are_no_certificate_are_refused(tmp_path):
    junk = tmp_path / "c.pem"
    junk.write_text("junk")
    with pytest.raises(UsageError, match="no certificate with this key"):
        with_tls(ConsoleSettings(), junk, junk)


def test_what_starts_the_gateway_imports_no_server():
    code = "import sys, json, teleop.console.invitation, teleop.console.settings; print(json.dumps(list(sys.modules)))"
    loaded = json.loads(subprocess.check_output([sys.executable, "-c", code], cwd=Path(__file__).parents[2]))
    assert not {"starlette", "uvicorn", "websockets", "asyncio", "segno", "cryptography", "numpy"} & set(loaded)
