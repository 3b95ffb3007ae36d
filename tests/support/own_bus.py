"""A CAN bus by multicast that no other worker of the tests is on: the tests of one file run on two at once."""

from __future__ import annotations

import os


def own_bus(number: int) -> str:
    """The URL of bus `number` of this worker."""
    worker = int(os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw"))
    return f"udp_multicast:239.74.{163 + worker}.{number}"
