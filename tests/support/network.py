"""A network namespace of this test's own: multicast and vcan without touching the host's network.

The namespace is the calling thread's, and a socket keeps the one it was opened in, so tests run in this process.
"""

import ctypes
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

_CLONE_NEWNET = 0x40000000  # sched.h


@contextmanager
def own_network(*commands: str) -> Iterator[None]:
    """A fresh namespace after these `ip` commands; skips the test where the machine does not allow it."""
    if shutil.which("ip") is None:
        pytest.skip("no `ip` command (Debian: iproute2) to set up a network namespace")
    libc = ctypes.CDLL(None, use_errno=True)
    home = os.open("/proc/thread-self/ns/net", os.O_RDONLY)
    try:
        if libc.unshare(_CLONE_NEWNET):
            pytest.skip(f"a network namespace is not permitted here: {os.strerror(ctypes.get_errno())}")
        try:
            for command in commands:
                done = subprocess.run(["ip", *command.split()], capture_output=True, text=True, check=False)
                if done.returncode:
                    pytest.skip(f"ip {command}: {done.stderr.strip()}")
            yield
        finally:
            assert libc.setns(home, _CLONE_NEWNET) == 0, "the test is stuck in its network namespace"
    finally:
        os.close(home)
