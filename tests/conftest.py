"""What holds for every test, however the tests were started.

Examples are chosen by Hypothesis from the test itself, the same in every run: a newcomer's run never fails by luck.
`tests/random.sh` looks for new ones (--hypothesis-profile random); what it finds becomes an @example. No example is
judged by the time it took: the machine may be shared, and timings are benchmarks.

A test that sends a signal starts its program as a terminal would. A child inherits which signals are ignored, and
`teleop` keeps to it; SIGHUP and SIGQUIT may be ignored here because the tests run in the background (nohup, a CI
runner), or because a test before has called what ends with ignoring them.

nanobind, on which ruckig is built, prints a page of "leaked" objects when the interpreter ends while a traceback of a
failed test still holds a solver. Its switch is for C++ only (`nb::set_leak_warnings`) and ruckig does not export it, so
the processes of the tests close stderr as the last thing they do. pytest's own report is complete by then.
"""

import atexit
import itertools
import os
import signal
from collections.abc import Iterator, Sequence

import pytest
from hypothesis import HealthCheck, settings
from slow import NAMES, name_of


def _close_stderr() -> None:
    """Nothing that the C runtime prints after Python's own exit handlers is seen."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)


atexit.register(_close_stderr)  # handlers run in reverse order: this one, registered before any test, comes last

settings.register_profile(
    "same", deadline=None, derandomize=True, database=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.register_profile("random", deadline=None, print_blob=True, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("same")


# A stall of the computer ends a run in real time, as it has to: the test has another try. Any other failure fails. Only
# slow tests have such runs, and a mark at every test would double the time of the quick ones.
STALLS = pytest.mark.flaky(reruns=2, only_rerun="the computer stalled")


def pytest_collection_modifyitems(items: Sequence[pytest.Item]) -> None:
    """Mark what takes long, as measured: tests/slow.txt."""
    for item in items:
        if name_of(item.nodeid) in NAMES:
            item.add_marker(pytest.mark.slow)
            if item.get_closest_marker("flaky") is None:
                item.add_marker(STALLS)


@pytest.fixture(autouse=True)
def _signals_as_on_a_terminal() -> None:
    for number in (signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_DFL)


_numbers = itertools.count()


@pytest.fixture(autouse=True, scope="session")
def _state_of_these_tests(tmp_path_factory: pytest.TempPathFactory) -> None:
    """For fixtures of a module, which are made before `_state_of_its_own`: nothing of the user's is read or written."""
    os.environ["XDG_STATE_HOME"] = str(tmp_path_factory.getbasetemp() / "state")


@pytest.fixture(autouse=True)
def _state_of_its_own(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """No test learns from another one, or from runs of the user's, how an axis answers. The folder is not made."""
    before = os.environ.get("XDG_STATE_HOME")
    os.environ["XDG_STATE_HOME"] = str(tmp_path_factory.getbasetemp() / "state" / str(next(_numbers)))
    yield
    if before is None:
        os.environ.pop("XDG_STATE_HOME", None)
    else:
        os.environ["XDG_STATE_HOME"] = before
