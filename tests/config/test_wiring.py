"""How a gimbal's angles are wired to the operator's axes."""

from hypothesis import given
from hypothesis import strategies as st

from teleop.config.wiring import Wiring
from teleop.core.axes import Axis

angles = st.floats(-180, 180)
wirings = st.builds(
    Wiring,
    st.permutations([Axis.PAN, Axis.ROLL, Axis.TILT]),
    st.dictionaries(st.sampled_from([Axis.PAN, Axis.ROLL, Axis.TILT]), st.sampled_from([1, -1])),
)


def test_straight_is_pan_to_yaw_and_tilt_to_pitch() -> None:
    values = {Axis.PAN: 1.0, Axis.TILT: 2.0, Axis.ROLL: 3.0}
    assert Wiring().to_gimbal(values) == (1.0, 3.0, 2.0)
    assert Wiring().from_gimbal(1.0, 3.0, 2.0) == values
    assert Wiring().undriven({Axis.TILT: 2.0}) == (True, True, False)


def test_the_documents_second_mapping_turns_the_roll_with_the_sticks_x() -> None:
    wiring = Wiring((None, Axis.PAN, Axis.TILT), {Axis.PAN: -1})
    assert wiring.to_gimbal({Axis.PAN: 10.0, Axis.TILT: 5.0}) == (0.0, -10.0, 5.0)
    assert wiring.from_gimbal(99.0, -10.0, 5.0) == {Axis.PAN: 10.0, Axis.TILT: 5.0}
    assert wiring.undriven({Axis.PAN: 10.0, Axis.TILT: 5.0}) == (True, False, False)


@given(wirings, angles, angles, angles)
def test_there_and_back_is_the_identity(wiring: Wiring, yaw: float, roll: float, pitch: float) -> None:
    assert wiring.to_gimbal(wiring.from_gimbal(yaw, roll, pitch)) == (yaw, roll, pitch)


def test_speeds_and_reports_have_the_signs_of_positions_unless_given() -> None:
    values = {Axis.PAN: 1.0, Axis.TILT: 2.0, Axis.ROLL: 3.0}
    turned = Wiring(signs={Axis.ROLL: -1, Axis.TILT: -1})
    assert turned.to_gimbal(values) == turned.speeds_to_gimbal(values) == (1.0, -3.0, -2.0)
    assert turned.from_gimbal(1.0, -3.0, -2.0) == values
    own = Wiring(signs={Axis.ROLL: -1}, speed_signs={Axis.ROLL: 1, Axis.PAN: -1}, report_signs={Axis.TILT: -1})
    assert own.to_gimbal(values) == (1.0, -3.0, 2.0)
    assert own.speeds_to_gimbal(values) == (-1.0, 3.0, 2.0)
    assert own.from_gimbal(1.0, 3.0, 2.0) == {Axis.PAN: 1.0, Axis.TILT: -2.0, Axis.ROLL: -3.0}
