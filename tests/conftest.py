"""What holds for every test, however the tests were started.

Hypothesis never judges by the time an example took: this machine is shared, and timings are benchmarks. And a test that
sends a signal starts its program as a terminal would. A child inherits which signals are ignored, and `teleop` keeps to
it; SIGHUP and SIGQUIT may be ignored here because the tests run in the background (nohup, a CI runner), or because a
test before has called what ends with ignoring them.
"""

import signal

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")


@pytest.fixture(autouse=True)
def _signals_as_on_a_terminal() -> None:
    for number in (signal.SIGHUP, signal.SIGQUIT):
        signal.signal(number, signal.SIG_DFL)
