"""Why there is no rig at an endpoint, as the operator reads it, and as the operator at a rig does."""

from __future__ import annotations

import asyncio
import socket
import ssl
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Thread
from types import SimpleNamespace

import pytest
from fleet_bench import free_port

from teleop.config.exchange.zenoh import ZenohSection
from teleop.exchange.zenoh import reaching, unfit
from teleop.studio.credentials import Credentials, load
from teleop.studio.diagnosis import why_not
from teleop.studio.keys import KeyFolder

FLEET = "both sides need certificates that one `teleop fleet keys` folder has made"


def made(folder: Path) -> tuple[Credentials, ssl.SSLContext]:
    """anna's credentials of a new fleet, and the TLS of its rig."""
    keys = KeyFolder(folder)
    anna, _ = load(str(keys.add("anna", "operate", serves=False))), keys.add("cam-a", "rig", serves=True)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(folder / "cam-a.pem", folder / "cam-a.key")
    context.load_verify_locations(folder / "ca.pem")
    context.verify_mode = ssl.CERT_REQUIRED
    return anna, context


@contextmanager
def listening(context: ssl.SSLContext | None) -> Iterator[str]:
    """Where one connection is taken, by TLS or without."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def take() -> None:
            with suppress(OSError), server.accept()[0] as plain:
                if context is None:
                    plain.sendall(b"SSH-2.0-x\r\n")
                    plain.recv(9999)
                else:
                    with context.wrap_socket(plain, server_side=True) as protected:
                        protected.recv(1)

        thread = Thread(target=take, daemon=True)
        thread.start()
        yield f"tls/127.0.0.1:{server.getsockname()[1]}"
        thread.join(30)


def test_the_reason_is_one_that_the_operator_can_act_on(tmp_path: Path):
    anna, rig = made(tmp_path / "keys")
    foreign, _ = made(tmp_path / "foreign")
    with listening(rig) as endpoint:
        assert why_not(endpoint, foreign) == f"its certificate is of another fleet: {FLEET}"
    half = SimpleNamespace(name="anna", context=lambda: mixed(tmp_path))
    with listening(rig) as endpoint:
        assert why_not(endpoint, half) == f"it does not take the certificate of anna: {FLEET}"  # type: ignore[arg-type]
    with listening(rig) as endpoint:
        assert why_not(endpoint, anna) == ""
    rig.load_cert_chain(tmp_path / "keys" / "anna.pem", tmp_path / "keys" / "anna.key")
    with listening(rig) as endpoint:
        assert why_not(endpoint, anna) == "its certificate is an operator's: a rig and a router need their own"
    with listening(None) as endpoint:
        assert why_not(endpoint, anna) == "it speaks no TLS: something else listens there"
    with listening(None) as endpoint:
        assert why_not(f"tcp{endpoint[3:]}", None) == "something else listens there, or it needs tls/ and --credentials"
    assert why_not(f"tls/127.0.0.1:{free_port()}", anna).startswith("nothing listens there")
    assert why_not("tls/no.invalid:7447", anna) == "there is no computer no.invalid on this network"


def test_a_rig_needs_a_rig_s_credentials_of_its_own_name(tmp_path: Path):
    keys = KeyFolder(tmp_path)
    file, anna = keys.add("cam-a", "rig", serves=True), keys.add("anna", "operate", serves=False)
    assert unfit("cam-a", load(str(file))) == ""
    assert unfit("cam-b", load(str(file))) == "is of cam-a, and the entry is called cam-b: both must have one name"
    assert unfit("anna", load(str(anna))).startswith("its access list does not have anna: make it with")
    keys.members["cam-a"] = "watch"
    keys.write_access()
    assert unfit("cam-a", load(str(file))).startswith("its access list has cam-a as `watch`: make it with")


def mixed(folder: Path) -> ssl.SSLContext:
    """Knows the fleet's authority, and shows a foreign certificate."""
    context = ssl.create_default_context(cafile=folder / "keys" / "ca.pem")
    context.check_hostname = False
    context.load_cert_chain(folder / "foreign" / "anna.pem", folder / "foreign" / "anna.key")
    return context


def test_a_rig_says_when_it_does_not_reach_its_router_and_when_it_does(monkeypatch: pytest.MonkeyPatch):
    router = f"tcp/127.0.0.1:{free_port()}"
    section = ZenohSection(type="zenoh", name="cam-a", connect=[router])
    linked: list[str] = []
    lines: list[str] = []

    def notify(line: str) -> None:
        lines.append(line)
        linked.append("router")
        if len(lines) == 2:
            raise asyncio.CancelledError

    session = SimpleNamespace(info=SimpleNamespace(routers_zid=lambda: linked, peers_zid=list))
    monkeypatch.setattr(reaching, "LOOK", 0.001)
    monkeypatch.setattr(reaching, "PATIENCE", 0.003)
    with pytest.raises(asyncio.CancelledError):
        asyncio.run(reaching.tell_reached(section, SimpleNamespace(notify=notify), session, None))  # type: ignore[arg-type]
    assert lines == [
        f"zenoh: {router} is not reached: nothing listens there: is it started, and the port right?; it is tried on",
        f"zenoh: {router}: reached",
    ]
