"""What is settled before a plan is played."""

from __future__ import annotations

import pytest

from teleop.app.clocks import clock_for, real_links
from teleop.app.planning import plan_content
from teleop.app.play import attended, devices_in_use, waits
from teleop.config.profile import load_profile
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.errors import UsageError

KEYS = [{"at": 0, "pan": 0}, {"at": 2, "pan": 10}]


@pytest.fixture
def waiting():
    return plan_content({"keyframes": KEYS, "cues": [{"at": 0, "wait": "operator"}]}, load_profile("sim"))


def test_a_sequence_waits_only_for_an_operator_who_is_there(waiting):
    assert waits(waiting.sequence) == [0]
    assert attended("a.yaml", waiting.sequence, keys=True, virtual=False) is waiting.sequence
    assert waits(attended("a.yaml", waiting.sequence, keys=False, virtual=True)) == []
    with pytest.raises(UsageError, match=r"a\.yaml waits for the operator at 0 s: run it on a terminal"):
        attended("a.yaml", waiting.sequence, keys=False, virtual=False)


def test_only_the_links_of_devices_in_use_are_opened():
    plan = plan_content({"keyframes": KEYS}, load_profile("m100"))
    assert list(devices_in_use(plan, shoots=False).links) == ["gimbal"]


def test_real_links_run_in_real_time():
    assert real_links(load_profile("sim")) == []
    assert real_links(load_profile("sim", {"gimbal": "socketcan:can0"})) == ["gimbal=socketcan:can0"]
    assert isinstance(clock_for(True), VirtualClock)
    assert isinstance(clock_for(False), SystemClock)
