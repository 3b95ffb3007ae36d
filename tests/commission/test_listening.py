"""The first steps: what was on the bus before anything was sent, and which bit rate that says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from commission_bench import CommissionBench

from teleop.commission.findings import Verdict
from teleop.commission.gimbal.listening import Listen, Replies
from teleop.commission.page import GO, Stage
from teleop.commission.step import Wait
from teleop.links import parse

SLCAN = parse("slcan:/dev/ttyACM0")


class Others(CommissionBench):
    """A bench on a bus with others on it: `heard` in each turn."""

    def heard(self, **counts: int) -> None:
        wire: Any = self.made.bench.connection._link
        wire.with_own_id = getattr(wire, "with_own_id", 0) + counts.get("host", 0)
        wire.foreign[0x530] += counts.get("foreign", 0)
        wire.counts["error frames"] += counts.get("errors", 0)

    def facts(self, step: Listen | Replies, **counts: int) -> dict[str, Any]:
        script, now = step.script(self.made.findings), self.clock.now
        try:
            while True:
                asked = next(script)
                assert isinstance(asked, Wait)
                end = now() + asked.seconds
                while now() < end - 1e-6:
                    self.clock.sleep_until(now() + 0.01)
                    self.heard(**counts)
                    self.made.bench.poll(now())
        except StopIteration as over:
            return {fact.key: fact for fact in over.value}


@pytest.fixture
def bench(tmp_path: Path) -> Others:
    return Others(tmp_path / "out.yaml")


@pytest.mark.parametrize(
    ("url", "heard", "verdict", "how"),
    [
        ("slcan:/dev/ttyACM0", {"foreign": 4}, Verdict.DOCUMENTED, "frames arrived at it before anything was sent"),
        ("slcan:/dev/ttyACM0", {}, Verdict.NOT_SEEN, "the bus was silent"),
        ("slcan:/dev/ttyACM0", {"errors": 1}, Verdict.DIFFERENT, "only errors at 1000000: another bit rate"),
        ("slcan:/dev/ttyACM0@500000", {"foreign": 4}, Verdict.DIFFERENT, "frames arrived at it"),
        ("udp_multicast:239.74.163.2", {"foreign": 4}, Verdict.NOT_SEEN, "the bus is a network"),
        ("sim:", {}, Verdict.NOT_SEEN, "the gimbal is simulated"),
    ],
)
def test_listening_says_whether_the_bit_rate_is_right(
    url: str, heard: dict[str, int], verdict: Verdict, how: str, bench: Others
) -> None:
    fact = bench.facts(Listen(bench.made.bench, parse(url)), **heard)["adapter.bitrate"]
    assert fact.verdict is verdict
    assert how in fact.how
    assert not bench.gimbal.counts.total()


def test_a_silent_bus_says_its_bit_rate_by_the_first_reply(bench: Others) -> None:
    bench.made.bench.quiet = False
    fact = bench.facts(Replies(bench.made.bench, SLCAN))["adapter.bitrate"]
    assert (fact.found, fact.verdict, fact.how) == (1000000, Verdict.DOCUMENTED, "replies arrive at it")


def test_errors_and_another_host_are_counted_before_anything_is_sent(bench: Others) -> None:
    facts = bench.facts(Listen(bench.made.bench, SLCAN), host=1, errors=2, foreign=3)
    assert 95 <= facts["bus.other_host"].found <= 105
    assert facts["bus.other_host"].verdict is Verdict.DIFFERENT
    assert 190 <= facts["bus.first_errors"].found <= 210
    assert 285 <= facts["bus.foreign"].found <= 315
    assert not bench.gimbal.counts.total()


def test_what_is_different_is_shown_before_the_next_step_begins(bench: Others) -> None:
    while bench.runner.stage is not Stage.SHOWN:
        bench.heard(host=1)
        bench.turn()
    assert bench.runner.page.key == "listen"
    assert bench.runner.page.keys[GO] == "next"
    assert not bench.gimbal.counts.total()
    bench.turn(GO)
    while bench.runner.page.key != "ready":
        bench.turn()
