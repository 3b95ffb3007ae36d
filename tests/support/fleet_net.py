"""A studio's network on this machine: hosts as namespaces, joined to one switch by veth cables that can be cut."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import pytest

NET = "10.87.20"


class Host:
    """`run` is what a command line begins with to run here."""

    def __init__(self, namespace: str, number: int, switch: str) -> None:
        self.namespace, self.address, self._switch = namespace, f"{NET}.{number}", switch
        self.run = ["ip", "netns", "exec", namespace]
        self._port = f"p{number}"

    @staticmethod
    @contextmanager
    def inside_of(namespace: str) -> Iterator[None]:
        """Sockets that this thread opens are on that host, and stay there."""
        home = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
        there = os.open(f"/var/run/netns/{namespace}", os.O_RDONLY)
        libc = ctypes.CDLL(None)
        try:
            assert libc.setns(there, 0) == 0
            yield
        finally:
            assert libc.setns(home, 0) == 0, "the test is stuck on another host"
            os.close(home)
            os.close(there)

    def cut(self) -> None:
        """Unplug the cable at the switch: nothing gets through, and nobody is told."""
        ip("-n", self._switch, "link", "set", self._port, "nomaster")

    def mend(self) -> None:
        ip("-n", self._switch, "link", "set", self._port, "master", "sw0")


def ip(*words: str) -> None:
    done = subprocess.run(["ip", *words], capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip(f"ip {' '.join(words)}: {done.stderr.strip()}")


@contextmanager
def studio(names: Sequence[str]) -> Iterator[dict[str, Host]]:
    """A host for each name; skips the test where this machine allows no network namespaces."""
    if shutil.which("ip") is None:
        pytest.skip("no `ip` command (Debian: iproute2)")
    tag = f"tf{os.getpid()}"
    switch, made = f"{tag}-sw", []
    try:
        ip("netns", "add", switch)
        made.append(switch)
        ip("-n", switch, "link", "add", "sw0", "type", "bridge")
        ip("-n", switch, "link", "set", "sw0", "up")
        hosts = {}
        for number, name in enumerate(names, 1):
            namespace = f"{tag}-{name}"
            ip("netns", "add", namespace)
            made.append(namespace)
            ip("-n", namespace, "link", "add", "eth0", "type", "veth", "peer", "name", f"p{number}", "netns", switch)
            ip("-n", namespace, "address", "add", f"{NET}.{number}/24", "dev", "eth0")
            for device in ("lo", "eth0"):
                ip("-n", namespace, "link", "set", device, "up")
            ip("-n", namespace, "route", "add", "239.0.0.0/8", "dev", "lo")  # each host has buses of its own
            ip("-n", switch, "link", "set", f"p{number}", "master", "sw0")
            ip("-n", switch, "link", "set", f"p{number}", "up")
            hosts[name] = Host(namespace, number, switch)
        yield hosts
    finally:
        for namespace in reversed(made):
            subprocess.run(["ip", "netns", "delete", namespace], check=False)
