"""The sockets of an exchange are open before the rig is, and a run that cannot listen says which entry and why."""

from __future__ import annotations

import os
import socket

import pytest

from teleop.config.exchange.address import is_allowed
from teleop.config.profile import checked_profile, load_profile
from teleop.config.resources import find
from teleop.core.errors import DeviceError
from teleop.exchange.opening import opened


def with_exchange(entries: str):
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    return checked_profile(f"{text}\nexchange:\n{entries}", "test.yaml")


def test_a_listener_is_bound_and_told_to_the_gateway():
    with opened(with_exchange("  - {type: osc, listen: '127.0.0.1:0'}\n")) as exchange:
        assert len(exchange.passed) == 1
        with socket.socket(fileno=os.dup(exchange.passed[0])) as there:
            assert there.type == socket.SOCK_DGRAM
            assert exchange.greeting == f"exchange: osc at 127.0.0.1:{there.getsockname()[1]}"


def test_a_port_that_is_taken_is_refused_with_the_entry():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        profile = with_exchange(f"  - {{type: osc, listen: '127.0.0.1:{port}'}}\n")
        refused = rf"exchange\[0\] \(osc\): listen 127.0.0.1:{port}: cannot listen"
        with pytest.raises(DeviceError, match=refused), opened(profile):
            pass


def test_a_rig_without_exchange_opens_nothing():
    with opened(load_profile("sim")) as exchange:
        assert not exchange.settings


@pytest.mark.parametrize(
    ("peer", "allow", "taken"),
    [
        ("127.0.0.1", [], True),
        ("::1", [], True),
        ("::ffff:127.0.0.1", [], True),
        ("192.168.1.20", [], False),
        ("192.168.1.20", ["192.168.1.20"], True),
        ("192.168.1.21", ["192.168.1.20"], False),
        ("::ffff:192.168.1.20", ["192.168.1.0/24"], True),
        ("fe80::1%eth0", ["fe80::/10"], True),
    ],
)
def test_commands_are_taken_from_this_computer_and_from_whom_the_entry_allows(peer, allow, taken):
    assert is_allowed(peer, allow) is taken
