"""What a simulator did not obey: counted all, kept the newest, named as a client's author knows it."""

from __future__ import annotations

from teleop.dji.drone import messages as drone
from teleop.dji.frame import Damage
from teleop.dji.message import Opaque
from teleop.sim.refusals import Refusal, Refusals, Why, command_name


def test_each_is_taken_once_and_counted_for_ever() -> None:
    refusals = Refusals()
    refusals.add(1.0, "drone.move", Why.NO_CONTROL)
    refusals.add(2.0, "drone.move", Why.NO_CONTROL)
    refusals.add(3.0, "drone.move", Why.RANGE, "x must be -10..10 m/s, not 11")
    assert refusals.take()[-1] == Refusal(3.0, "drone.move", Why.RANGE, "x must be -10..10 m/s, not 11")
    assert refusals.take() == []
    assert refusals.counts == {("drone.move", Why.NO_CONTROL): 2, ("drone.move", Why.RANGE): 1}
    assert refusals.total == 3


def test_of_those_that_nobody_takes_the_newest_256_are_kept() -> None:
    refusals = Refusals()
    for number in range(300):
        refusals.add(float(number), "drone.move", Why.MODE)
    kept = refusals.take()
    assert (len(kept), kept[0].time, kept[-1].time) == (256, 44.0, 299.0)
    assert refusals.total == 300


def test_damage_shows_its_first_24_bytes() -> None:
    refusals = Refusals()
    refusals.add_damage(0.0, Damage("wrong CRC-16", bytes(24)))
    refusals.add_damage(0.0, Damage("wrong CRC-16", bytes(25)))
    whole, cut = (each.detail for each in refusals.take())
    assert whole == "wrong CRC-16: " + "00" * 24
    assert cut == whole + "..."


def test_an_unknown_command_is_named_by_its_set_and_id() -> None:
    assert command_name(drone.Version()) == "drone.version"
    assert command_name(Opaque(b"\x01\x7f", b"\0")) == "0x017f"
    assert command_name(Opaque(b"", b"\0")) == "data"
