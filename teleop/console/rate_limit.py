"""How often each client may ask: buckets that fill with time. Their number is bounded too."""

from __future__ import annotations

import ipaddress
from collections import OrderedDict
from collections.abc import Callable

from teleop.gateway.bucket import Bucket

MOST_CLIENTS = 1000  # buckets: those of the clients that asked last


class RateLimit:
    """A bucket for each client, by its address."""

    def __init__(self, rate: float, burst: float, clock: Callable[[], float]) -> None:
        self._rate, self._burst, self._clock = rate, burst, clock
        self._buckets: OrderedDict[str, Bucket] = OrderedDict()

    def take(self, address: str) -> bool:
        """Count one more of this client; False where that is too many."""
        return self._bucket(address).take(self._clock())

    def _bucket(self, address: str) -> Bucket:
        key = client_key(address)
        found = self._buckets.get(key)
        if found is None:
            found = self._buckets[key] = Bucket(self._rate, self._burst, self._burst, self._clock())
        self._buckets.move_to_end(key)
        if len(self._buckets) > MOST_CLIENTS:
            self._buckets.popitem(last=False)
        return found


def client_key(address: str) -> str:
    """The address; of IPv6 its network, because one computer has 2**64 of them."""
    try:
        found = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    return address if found.version == 4 else str(ipaddress.ip_network((found, 64), strict=False))
