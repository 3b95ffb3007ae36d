"""Times as written in a sequence."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.quantities import seconds


@pytest.mark.parametrize(
    ("written", "fps", "value"),
    [
        (4, None, 4.0),
        (0.25, None, 0.25),
        ("4s", None, 4.0),
        ("1m30s", None, 90.0),
        ("2h", None, 7200.0),
        ("1h0.5s", None, 3600.5),
        ("96f", 24, 4.0),
        ("00:00:04:00", 24, 4.0),
        ("01:00:00:12", 24, 3600.5),
        ("00:01:00:00", 23.976, 60 * 1.001),
        ("00:00:59;29", 29.97, 1799 * 1.001 / 30),
        ("00:01:00;02", 29.97, 1800 * 1.001 / 30),
        ("00:10:00;00", 29.97, 17982 * 1.001 / 30),
        ("01:00:00;00", 29.97, 107892 * 1.001 / 30),
        ("01:00:00;00", 59.94, 215784 * 1.001 / 60),
    ],
)
def test_every_way_to_write_a_time(written: object, fps: float | None, value: float) -> None:
    assert seconds(written, fps) == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize(
    ("written", "fps", "said"),
    [
        (-1, None, "must be 0 s or later"),
        (float("nan"), None, "must be 0 s or later"),
        (True, None, "must be a time"),
        (None, None, "must be a time"),
        ("", None, "must be a time"),
        ("soon", None, "must be a time"),
        ("-4s", None, "must be a time"),
        ("96f", None, "needs fps"),
        ("00:00:04:00", None, "needs fps"),
        ("00:00:04:24", 24, "has frame 24"),
        ("00:61:00:00", 24, "must be a time"),
        ("00:01:00;00", 29.97, "a number that drop-frame timecode leaves out; 00:01:00;02 is the next"),
        ("00:00:01;00", 25, "there is at 29.97 and 59.94 fps, not 25"),
        ("9" * 5000 + "s", None, "must be a time"),
        ("9" * 38 + "h", None, "must be at most 31 days"),
        (1e300, None, "must be at most 31 days"),
        (10**299, None, "must be at most 31 days"),
    ],
)
def test_what_is_no_time_is_said(written: object, fps: float | None, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        seconds(written, fps)


@given(st.integers(0, 10_000_000), st.sampled_from([24.0, 25.0, 30.0, 60.0]))
def test_timecode_and_frames_agree(frame: int, fps: float) -> None:
    whole, frames = divmod(frame, int(fps))
    code = f"{whole // 3600:02}:{whole // 60 % 60:02}:{whole % 60:02}:{frames:02}"
    assert seconds(code, fps) == pytest.approx(seconds(f"{frame}f", fps), rel=1e-12, abs=1e-12)
