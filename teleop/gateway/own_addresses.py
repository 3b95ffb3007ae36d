"""The addresses of this computer, on all its networks."""

from __future__ import annotations

import ipaddress
from collections.abc import Iterator

ANY = ("0.0.0.0", "::")

Interface = ipaddress.IPv4Interface | ipaddress.IPv6Interface


def own_interfaces() -> Iterator[Interface]:
    """This computer's addresses, each with its network."""
    import ifaddr

    for adapter in ifaddr.get_adapters():
        for each in adapter.ips:
            text = each.ip if isinstance(each.ip, str) else each.ip[0]
            yield ipaddress.ip_interface(f"{text}/{each.network_prefix}")


def addresses_of(host: str) -> list[str]:
    """Where others reach what listens at `host`: for every address (0.0.0.0, ::) those of this computer."""
    if host not in ANY:
        return [host]
    found = [
        str(number)
        for number in (each.ip for each in own_interfaces())
        if not number.is_loopback and (number.version == 4 or (host == "::" and not number.is_link_local))
    ]
    return sorted(found, key=lambda text: ":" in text)
