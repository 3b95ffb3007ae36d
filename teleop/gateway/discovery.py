"""Rigs on this network by mDNS: what others can reach is announced as `_teleop._tcp`, and found by browsing.

The TXT record has `rig` (its name), `tls` ("1" or "0"), with a console `api` (the path that describes its HTTP
interface), and in a fleet `zenoh`: where operators connect, as in `tls/192.168.1.20:7447`, one after the other.
"""

from __future__ import annotations

import asyncio
import secrets
import socket
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import asdict, dataclass, field
from typing import Any, NamedTuple, Self

from teleop.config.exchange.address import Address
from teleop.config.exchange.endpoint import endpoint
from teleop.core.errors import TeleopError
from teleop.gateway.own_addresses import ANY, addresses_of

SERVICE = "_teleop._tcp.local."
API = "/api"
ZENOH = "zenoh"  # the key of what a fleet connects to
LONGEST_NAME = 57  # bytes of a label less those of the number that tells two of a name apart
LONGEST_TEXT = 200  # bytes of a value in the TXT record
QUIET = 1.3  # s to listen for others of a name: what was told is not told again within 1 s (RFC 6762, 6)
MOST_OF_A_NAME = 100
SRV, INTERNET = 33, 1  # a type and a class of DNS
ANSWERS = 1.0  # s that one rig has to say where it is


@dataclass(frozen=True)
class Announcement:
    """What is announced: `host` is where it listens, a number; `more` are further keys of the TXT record.

    Without a `console` the port is that of the fleet.
    """

    rig: str
    host: str
    port: int
    tls: bool = False
    more: Mapping[str, str] = field(default_factory=dict)
    console: bool = True

    def as_settings(self) -> dict[str, Any]:
        return asdict(self)

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> Self:
        return cls(**settings)


class Found(NamedTuple):
    """A rig as it is announced. `name` is its own on the network: the rig's, with a number where two have the same."""

    name: str
    rig: str
    addresses: Sequence[str]
    port: int
    tls: bool
    text: Mapping[str, str]

    @property
    def url(self) -> str:
        """Of its console, at its first address; "" without one."""
        if "api" not in self.text:
            return ""
        host = self.addresses[0] if self.addresses else ""
        return f"http{'s' if self.tls else ''}://{Address(host, self.port)}"

    @property
    def endpoints(self) -> list[str]:
        """Where a fleet connects to it; what makes no sense is left out."""
        return [text for text in self.text.get(ZENOH, "").split() if _is_endpoint(text)]


@asynccontextmanager
async def announced(what: Announcement) -> AsyncIterator[str]:
    """It is announced within, and taken back at the end; its name there. Raises TeleopError where it cannot be."""
    addresses = addresses_of(what.host)
    if not addresses:
        raise TeleopError("this computer has no address on a network yet")
    network = _network(addresses)
    try:
        info = await _registered(network, what, addresses)
        yield info.name.removesuffix(f".{SERVICE}")
    finally:
        await network.async_close()  # with the goodbye of what is announced by then


async def _registered(network: Any, what: Announcement, addresses: Sequence[str]) -> Any:
    """The service, once its name is its own: with the next number where another one has it, or takes it meanwhile."""
    from zeroconf import Error, NonUniqueNameException
    from zeroconf.asyncio import AsyncServiceInfo

    host = _label(socket.gethostname().partition(".")[0])[:30]
    server = f"teleop-{host}-{what.port}-{secrets.token_hex(3)}.local."  # no other responder's name for this computer
    label, text = _label(what.rig), _text(what, addresses)
    browser = _browser(network, lambda **_: None)  # hears of the names that there are
    await asyncio.sleep(QUIET)
    try:
        for number in range(2, MOST_OF_A_NAME):
            facts = {"port": what.port, "properties": text, "server": server, "parsed_addresses": addresses}
            info = AsyncServiceInfo(SERVICE, f"{label}.{SERVICE}", **facts)
            with suppress(NonUniqueNameException):
                await (await network.async_register_service(info))
                await asyncio.sleep(QUIET)
                if not _rival(network, info):
                    return info
                network.zeroconf.registry.async_remove(info)  # without a goodbye, which would be the other one's too
            label = f"{_label(what.rig)}-{number}"
    except (Error, OSError, TimeoutError) as error:
        raise TeleopError(f"no mDNS on this network: {error!r}") from None
    finally:
        await browser.async_cancel()
    raise TeleopError(f"there are {MOST_OF_A_NAME} rigs called {what.rig} on this network")


def _rival(network: Any, info: Any) -> bool:
    """Whether another one has taken the same name at the same time, and is to keep it."""
    from zeroconf import current_time_millis

    now = current_time_millis()
    found = network.zeroconf.cache.get_all_by_details(info.name, SRV, INTERNET)
    return any(each.server < info.server and not each.is_expired(now) for each in found)


async def browse(seconds: float = 1.5, interfaces: Sequence[str] = ()) -> list[Found]:
    """The rigs that answer within so many s, by name; on all networks, unless `interfaces` are given.

    Raises TeleopError where there is no mDNS.
    """
    from zeroconf import ServiceStateChange

    network = _network(interfaces)
    names: dict[str, None] = {}

    def changed(zeroconf: Any, service_type: str, name: str, state_change: Any) -> None:  # noqa: ARG001
        if state_change is ServiceStateChange.Removed:
            names.pop(name, None)
        else:
            names[name] = None

    try:
        browser = _browser(network, changed)
        await asyncio.sleep(seconds)
        await browser.async_cancel()
        found = await asyncio.gather(*(_asked(network, name) for name in names))
    finally:
        await network.async_close()
    return sorted(each for each in found if each is not None)


async def _asked(network: Any, name: str) -> Found | None:
    """What is announced by that name; None for one that has left, or says nothing that makes sense."""
    from zeroconf import DNSQuestionType
    from zeroconf.asyncio import AsyncServiceInfo

    info = AsyncServiceInfo(SERVICE, name)
    if not await info.async_request(network.zeroconf, ANSWERS * 1000, DNSQuestionType.QM) or not info.port:
        return None
    text = {
        key.decode(errors="replace"): (value or b"").decode(errors="replace") for key, value in info.properties.items()
    }
    label = name.removesuffix(f".{SERVICE}")
    return Found(label, text.get("rig", label), info.parsed_addresses(), info.port, text.get("tls") == "1", text)


def _browser(network: Any, changed: Callable[..., None]) -> Any:
    """Asks all at once and aloud: an answer to one asker alone reaches only one of the programs on a computer."""
    from zeroconf import DNSQuestionType
    from zeroconf.asyncio import AsyncServiceBrowser

    return AsyncServiceBrowser(network.zeroconf, SERVICE, handlers=[changed], question_type=DNSQuestionType.QM)


def _network(addresses: Sequence[str]) -> Any:
    """mDNS on the networks of these addresses, IPv4's by preference; on all of them for none. Raises TeleopError."""
    from zeroconf import InterfaceChoice, IPVersion
    from zeroconf.asyncio import AsyncZeroconf

    chosen = [each for each in addresses if ":" not in each] or list(addresses)
    version = IPVersion.V6Only if chosen and ":" in chosen[0] else IPVersion.V4Only
    try:
        return AsyncZeroconf(interfaces=chosen or InterfaceChoice.All, ip_version=version)
    except OSError as error:
        raise TeleopError(f"no mDNS on this network: {error.strerror or error}") from None


def _text(what: Announcement, addresses: Sequence[str]) -> dict[str, str]:
    own = {"rig": what.rig, "tls": "1" if what.tls else "0", **({"api": API} if what.console else {})}
    more = {**what.more}
    if ZENOH in more:
        more[ZENOH] = _reached(more[ZENOH], addresses)
    return {key: _cut(value, LONGEST_TEXT) for key, value in {**more, **own}.items()}


def _reached(listen: str, addresses: Sequence[str]) -> str:
    """Endpoints that others connect to, as many as fit, for one that listens at every address of this computer."""
    found = endpoint(listen)
    if found.address.host not in ANY:
        return listen
    whole = ""
    for each in addresses:
        longer = f"{whole} {found.protocol}/{Address(each, found.address.port)}".strip()
        if len(longer) <= LONGEST_TEXT:
            whole = longer
    return whole


def _is_endpoint(text: str) -> bool:
    try:
        return endpoint(text).address.port != 0
    except ValueError:
        return False


def _label(name: str) -> str:
    """A name as one label: printable, without the point that would part it, and not too long."""
    plain = "".join(each if each.isprintable() and each != "." else "-" for each in name).strip()
    return _cut(plain, LONGEST_NAME) or "rig"


def _cut(text: str, most: int) -> str:
    return text.encode()[:most].decode(errors="ignore")
