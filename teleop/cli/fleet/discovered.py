"""The endpoints of rigs that announce themselves by mDNS."""

from __future__ import annotations

import ipaddress
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from teleop.core.errors import TeleopError, UsageError

if TYPE_CHECKING:
    from teleop.gateway.discovery import Found

NAME_THEM = "name them with --connect, as in --connect tls/192.168.1.20:7447"
NONE = f"no rig was found by mDNS: {NAME_THEM}"
MISSING = f"without the package zeroconf no rig is found by mDNS (pip install 'rs-teleop[fleet]'): {NAME_THEM}"


def discovered(tls: bool) -> list[str]:
    """One for each rig that can be reached with credentials, or without. Raises UsageError where there are none."""
    import asyncio

    from teleop.gateway.discovery import browse

    try:
        found = [each for each in asyncio.run(browse()) if each.endpoints]
    except ImportError:
        raise UsageError(MISSING) from None
    except TeleopError as error:
        raise UsageError(f"{error}: {NAME_THEM}") from None
    if not found:
        raise UsageError(NONE)
    chosen = [best(each, "tls/" if tls else "tcp/", own_networks()) for each in found]
    if usable := sorted({each for each in chosen if each}):
        return usable
    names = ", ".join(sorted({each.rig for each in found})[:20])
    raise UsageError(f"found by mDNS: {names}: needs --credentials, made by `teleop fleet keys`")


Network = ipaddress.IPv4Network | ipaddress.IPv6Network


def best(rig: Found, begins: str, networks: Sequence[Network]) -> str:
    """Its endpoint in one of these networks, else its first one; "" for none that begins so."""
    from teleop.config.exchange.endpoint import endpoint

    usable = [text for text in rig.endpoints if text.startswith(begins)]
    for text in usable:
        with suppress(ValueError):
            address = ipaddress.ip_address(endpoint(text).address.host)
            if any(address in network for network in networks):
                return text
    return usable[0] if usable else ""


def own_networks() -> list[Network]:
    from teleop.gateway.discovery import own_addresses

    return [ipaddress.ip_network(f"{text}/{prefix}", strict=False) for text, prefix in own_addresses()]
