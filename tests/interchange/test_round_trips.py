"""What is written and read again is the same: angles within 1e-6, times, rates and cues exactly."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_motions import CUES, NTSC, content, made_motion
from scipy.interpolate import CubicSpline

from teleop.core.axes import Axis
from teleop.interchange import chan, rotation
from teleop.interchange.motion import CAMERA, Motion
from teleop.interchange.table import BY_NAME, Hints

ORDER = ["pan", "tilt", "roll", "focus"]
HINTS = {
    "chan": Hints(NTSC, "ZXY"),
    "csv": Hints(NTSC),
    "arcm": Hints(NTSC),
    "raw": Hints(NTSC, columns=ORDER),
    "kuper": Hints(NTSC),
    "usd": Hints(),
    "blender": Hints(),
    "otio": Hints(),
}
BY_TIME = [name for name, form in BY_NAME.items() if form.by_time]


def there_and_back(name: str, motion: Motion) -> Motion:
    raw = content(name, motion)
    return BY_NAME[name].load().read(raw, f"file{BY_NAME[name].endings[0]}", HINTS[name])


@pytest.mark.parametrize("name", BY_NAME)
@pytest.mark.parametrize("rate", [NTSC, Fraction(25)])
def test_angles_are_within_a_millionth_of_a_degree(name: str, rate: Fraction, monkeypatch: pytest.MonkeyPatch) -> None:
    motion = made_motion(rate=rate)
    if HINTS[name].rate:
        monkeypatch.setitem(HINTS, name, Hints(rate, HINTS[name].rotation_order, HINTS[name].columns))
    found = there_and_back(name, motion)
    assert found.rate == rate
    assert np.abs(found.times - motion.times).max() < 1e-8
    carried = [axis for axis in motion.axes if axis in BY_NAME[name].carries]
    assert list(found.positions) == carried
    for axis in carried:
        assert np.abs(found.positions[axis] - motion.positions[axis]).max() < 1e-6


@pytest.mark.parametrize("name", BY_TIME)
def test_readings_keep_the_times_of_the_recording(name: str) -> None:
    motion = made_motion(40, by_time=True)
    assert not motion.by_frame
    found = there_and_back(name, motion)
    if name == "arcm":  # its curves are read frame by frame: a frame lies on the curve through the readings
        expected = {axis: CubicSpline(motion.times, column)(found.times) for axis, column in motion.positions.items()}
        assert max(np.abs(found.positions[axis] - expected[axis])[2:-2].max() for axis in CAMERA) < 0.05
        return
    assert np.abs(found.times - motion.times).max() < 1e-8
    assert all(np.abs(found.positions[axis] - motion.positions[axis]).max() < 1e-6 for axis in found.positions)


def test_cues_come_back_at_their_times() -> None:
    found = there_and_back("otio", made_motion())
    assert [(cue.at, dict(cue.content)) for cue in found.cues] == [(cue.at, dict(cue.content)) for cue in CUES]


@pytest.mark.parametrize("order", rotation.ORDERS)
def test_a_chan_of_any_rotation_order_is_the_same_attitude(order: str) -> None:
    """Whatever order a program writes, pan, tilt and roll come of it; the judge is scipy."""
    from scipy.spatial.transform import Rotation

    motion = made_motion(60, focus=False)
    pan, tilt, roll = (motion.positions[axis] for axis in CAMERA)
    head = Rotation.from_euler("zxy", np.array([-roll, tilt, -pan]).T, degrees=True)
    turns = head.as_euler(order.lower(), degrees=True)
    x, y, z = (turns[:, order.index(letter)] for letter in "XYZ")
    lines = "".join(f"{n} 0 0 0 {a:.12f} {b:.12f} {c:.12f}\n" for n, (a, b, c) in enumerate(zip(x, y, z, strict=True)))
    start = (float(pan[0]), float(tilt[0]), float(roll[0]))
    found = chan.read(lines.encode(), "a.chan", Hints(NTSC, order, start=start))
    if order == rotation.HEAD:  # angles are taken as they are, and unwrapped later
        found = Motion("", found.times, {axis: np.unwrap(c, period=360) for axis, c in found.positions.items()})
    for axis in CAMERA:
        off = found.positions[axis] - motion.positions[axis]
        assert np.abs(off - 360 * np.round(off / 360)).max() < 1e-6


@settings(max_examples=200, deadline=None)
@given(st.tuples(*[st.floats(-400, 400)] * 3))
def test_any_attitude_comes_back_as_itself(angles: tuple[float, float, float]) -> None:
    pan, tilt, roll = (np.array([each]) for each in angles)
    matrices = rotation.head_matrices(pan, tilt, roll)
    found = np.array(rotation.head_angles(matrices, angles))[:, 0]
    again = rotation.head_matrices(*found[:, None])
    assert np.abs(again - matrices).max() < 1e-9
    if abs(np.cos(np.radians(angles[1]))) > 1e-3:
        assert np.abs(found - angles).max() < 1e-6


def test_a_head_that_looks_straight_up_keeps_its_roll() -> None:
    pan, tilt, roll = np.array([10.0, 10, 10]), np.array([80.0, 90, 100]), np.array([5.0, 5, 5])
    found = rotation.head_angles(rotation.head_matrices(pan, tilt, roll), (10, 80, 5))
    assert np.abs(np.array(found) - [pan, tilt, roll]).max() < 1e-6


@pytest.mark.parametrize("matrix", [np.diag([1.0, 1, -1]), np.zeros((3, 3)), np.full((3, 3), np.nan), np.ones((3, 3))])
def test_what_is_no_rotation_is_refused(matrix: np.ndarray) -> None:
    with pytest.raises(ValueError, match="in row 1"):
        rotation.pure(matrix[None])


def test_a_scaled_camera_is_read() -> None:
    motion = made_motion(5)
    matrices = rotation.head_matrices(*(motion.positions[axis] for axis in CAMERA))
    assert np.abs(rotation.pure(matrices * [[1.0, 2.0, 3.0]]) - matrices).max() < 1e-12
    assert motion.axes[3] is Axis.FOCUS
