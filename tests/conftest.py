"""Hypothesis never judges by the time an example took: this machine is shared, and timings are benchmarks."""

from hypothesis import HealthCheck, settings

settings.register_profile("untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("untimed")
