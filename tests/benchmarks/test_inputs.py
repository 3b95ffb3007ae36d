"""The figures of issue 14: `pytest tests/benchmarks/test_inputs.py --benchmark-enable -s -n 0` prints them.

Four pads that report 250 times a second each beside a loop at its period. What their readers compute is measured in
their own threads, as a share of the time that passed; the loop's lateness with them and without them in turn, so that
the machine drops out. Nothing is asserted about time: without `--benchmark-enable` the runs are short.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from time import clock_gettime, monotonic, pthread_getcpuclockid, sleep

import pytest
from fake_hid import JOYSTICK, FakeBackend, FakeDevice, real
from live_bench import percentile
from waiting import wait_until

from teleop.config.inputs_section import InputSection
from teleop.core.clock import SystemClock
from teleop.core.timing import PERIOD
from teleop.inputs.hid.device import HidInput, open_inputs

F310 = real("Logitech F310")
RATE, PADS = 250, 4  # reports a second of each
REPORTS = [bytes([0x7F + step % 8, 0x7F, 0x7F, 0x7F, 8, 0, 0, 0]) for step in range(16)]


class Metronome(FakeDevice):
    """Reports on time by itself, without a thread that would be measured too."""

    due, sent = 0.0, 0

    def read(self, timeout: float) -> bytes:
        now = monotonic()
        self.due = self.due or now
        if (wait := self.due - now) > 0:
            sleep(min(wait, timeout))
            if wait > timeout:
                return b""
        self.due += 1 / RATE
        self.sent += 1
        return REPORTS[self.sent % len(REPORTS)]


@contextmanager
def four_pads() -> Iterator[tuple[Sequence[HidInput], Sequence[Metronome]]]:
    pads = [
        Metronome(bytes.fromhex(F310["descriptor"]), (0x46D, 0xC216), f"Pad {n}", JOYSTICK, b"%d" % n, f"S{n}")
        for n in range(PADS)
    ]
    sections = [InputSection.model_validate({"device": {"name": f"Pad {n}"}}) for n in range(PADS)]
    with open_inputs(sections, monotonic, FakeBackend(*pads)) as inputs:
        wait_until(lambda: all(pad.sent for pad in pads), "reports")
        yield inputs, pads


def computed() -> float:
    """CPU time of the threads that read devices, s."""
    readers = [thread for thread in threading.enumerate() if thread.name.startswith("hid ")]
    return sum(clock_gettime(pthread_getcpuclockid(thread.ident)) for thread in readers if thread.ident)


def lateness(inputs: Sequence[HidInput], seconds: float) -> list[float]:
    """How late a loop wakes that does what the control loop does with these inputs."""
    clock, late = SystemClock(), []
    due = clock.now()
    for _ in range(round(seconds / PERIOD)):
        due += PERIOD
        clock.sleep_until(due)
        late.append(clock.now() - due)
        for each in inputs:
            each.read(clock.now())
    return late


@pytest.mark.skipif(sys.platform != "linux", reason="the CPU time of a thread is read by pthread_getcpuclockid")
def test_four_pads_cost_less_than_a_twentieth_of_a_core_and_the_loop_does_not_feel_them(
    request: pytest.FixtureRequest,
) -> None:
    rounds, seconds = (8, 3.0) if request.config.getoption("--benchmark-enable") else (1, 0.2)
    sys.setswitchinterval(0.0005)  # as a run sets it
    alone: list[list[float]] = []
    beside: list[list[float]] = []
    shares: list[float] = []
    reports = 0
    for _ in range(rounds):
        alone.append(lateness([], seconds))
        with ExitStack() as stack:
            inputs, pads = stack.enter_context(four_pads())
            before, begin, sent = computed(), monotonic(), sum(pad.sent for pad in pads)
            beside.append(lateness(inputs, seconds))
            passed = monotonic() - begin
            shares.append((computed() - before) / passed)
            reports += sum(pad.sent for pad in pads) - sent
    assert reports > 0.3 * rounds * seconds * RATE * PADS, "they were read"
    print(f"\n{reports / (rounds * seconds):.0f} reports/s: {sorted(shares)[len(shares) // 2]:.1%} of a core (median)")
    for name, late in (("without", alone), ("with", beside)):
        p99 = sorted(percentile(each, 0.99) * 1e3 for each in late)
        print(f"loop's lateness at p99 {name} them: best {p99[0]:.2f}, median {p99[len(p99) // 2]:.2f} ms")
