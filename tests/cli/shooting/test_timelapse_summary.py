"""A timelapse in a line."""

from __future__ import annotations

import pytest

from teleop.app.planning import plan_file
from teleop.cli.shooting.timelapse_summary import clock, facts, summary
from teleop.config.profile import load_profile


@pytest.mark.parametrize(
    ("seconds", "shown"), [(12.5, "12.5 s"), (59.96, "60.0 s"), (245, "4 min 5 s"), (7380, "2 h 3 min")]
)
def test_a_time_is_as_exact_as_it_is_useful(seconds, shown):
    assert clock(seconds) == shown


def test_the_line_has_frames_interval_time_and_clip():
    timelapse = plan_file("day-to-night", load_profile("sim")).timelapse
    assert timelapse is not None
    line, found = summary(timelapse), facts(timelapse)
    assert line.startswith(f"{found['frames']} frames")
    assert "of shooting" in line
    assert f"{timelapse.clip:.2f} s of clip" in line
    assert "each shot with Enter" in summary(timelapse, by_hand=True)
