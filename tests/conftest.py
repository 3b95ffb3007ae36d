"""What holds for every test, however the tests were started.

Hypothesis never judges by the time an example took: this machine is shared, and timings are benchmarks. And a test that
sends a signal starts its program as a terminal would: whoever starts the tests in the background (nohup, a CI runner)
has SIGHUP and SIGQUIT ignored, every child inherits that, and `teleop` keeps to it.
"""

import signal

from hypothesis import HealthCheck, settings

settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")

for number in (signal.SIGHUP, signal.SIGQUIT):
    signal.signal(number, signal.SIG_DFL)
