"""The parts of the drone's broadcast, each as its own message class without a command: Appendix.md "Flight Data".

Some parts are raw or fused (filtered) data, whichever DJI Assistant is set to; nothing on the wire says which. Where
that changes the unit, the unit names both; the docstring says it for every part that it concerns.
"""

from __future__ import annotations

from typing import Annotated

from teleop.dji.drone.enums import ControlDevice, CurrentMode, RcGear, RcMode
from teleop.dji.fields import I16, I32, U8, U32, Bits, Flag, Reserved
from teleop.dji.float_fields import F32, F64
from teleop.dji.message import Message, message

number = Annotated[float, F32()]
metres = Annotated[float, F32(unit="m")]
metres_per_second = Annotated[float, F32(unit="m/s")]
centimetres_per_second = Annotated[float, F32(unit="cm/s")]
acceleration = Annotated[float, F32(unit="m/s2 if fused, g if raw")]
radians_per_second = Annotated[float, F32(unit="rad/s")]
radians = Annotated[float, F64(unit="rad")]
degrees = Annotated[float, F32(unit="deg")]
magnetic = Annotated[int, I16()]
channel = Annotated[int, I16(low=-10000, high=10000)]
date = Annotated[int, U32(unit="yymmdd")]
time_of_day = Annotated[int, U32(unit="hhmmss")]


@message("time", 0, 0)
class Time(Message):
    """The drone's clock, twice; `sync` is the flag of the synchronisation signal."""

    ticks: Annotated[int, U32(unit="1/400 s")]
    nanoseconds: Annotated[int, U32(unit="ns")]
    sync: Annotated[int, U8()]


@message("quaternion", 0, 0)
class Quaternion(Message):
    """Attitude, from the ground frame (north, east, down) to the body frame."""

    q0: number
    q1: number
    q2: number
    q3: number


@message("acceleration", 0, 0)
class Acceleration(Message):
    """Linear acceleration: raw (accelerometer, body frame, g) or fused (body or ground frame, m/s2)."""

    x: acceleration
    y: acceleration
    z: acceleration


@message("velocity", 0, 0)
class Velocity(Message):
    """Linear velocity in the ground frame: north, east and UP are positive.

    The ground frame's z is down elsewhere; the maker's take-off sample (takeoffConverged, 3.1.9) waits for z > 0.25,
    and so says OSDK-ROS issue 25 (docs/protocol-facts.md).
    """

    x: metres_per_second
    y: metres_per_second
    z: metres_per_second
    valid: Annotated[bool, Flag(first=0)] = True
    reserved: Annotated[int, Reserved()] = 0


@message("angular_rate", 0, 0)
class AngularRate(Message):
    """Angular velocity in the body frame: raw (gyroscopes) or fused."""

    x: radians_per_second
    y: radians_per_second
    z: radians_per_second


@message("position", 0, 0)
class Position(Message):
    """Where the drone is; `health` is the GPS's, 5 the best.

    Altitude is raw (barometer) or fused (with inertia). Height above ground is raw (ultrasound, valid within 3 m) or
    fused (with barometer and inertia, which are all there is above 3 m and drift indoors).
    """

    # Latitude first: docs/protocol-facts.md.
    latitude: radians
    longitude: radians
    altitude: metres
    height: metres
    health: Annotated[int, U8(low=0, high=5)]


@message("gps", 0, 0)
class Gps(Message):
    """The GPS receiver's own words (A3 and M600)."""

    date: date
    time: time_of_day
    longitude: Annotated[float, I32(scale=10_000_000, unit="deg")]
    latitude: Annotated[float, I32(scale=10_000_000, unit="deg")]
    above_sea: Annotated[int, I32(unit="mm")]
    north: centimetres_per_second
    east: centimetres_per_second
    down: centimetres_per_second


@message("rtk", 0, 0)
class Rtk(Message):
    """The RTK receiver's own words (A3 and M600); `yaw` is of the antennas' baseline, from south."""

    date: date
    time: time_of_day
    longitude: Annotated[float, F64(unit="deg")]
    latitude: Annotated[float, F64(unit="deg")]
    above_sea: metres
    north: centimetres_per_second
    east: centimetres_per_second
    down: centimetres_per_second
    yaw: Annotated[int, I16(unit="deg")]
    position_flag: Annotated[int, U8()]
    yaw_flag: Annotated[int, U8()]


@message("magnetometer", 0, 0)
class Magnetometer(Message):
    """The magnetic field, in no unit that the appendix names."""

    x: magnetic
    y: magnetic
    z: magnetic


@message("rc", 0, 0)
class Rc(Message):
    """The remote controller: left and down are -10000. Not in the order of the virtual RC's channels."""

    roll: channel
    pitch: channel
    yaw: channel
    throttle: channel
    mode: Annotated[int, I16(words=RcMode)]
    gear: Annotated[int, I16(words=RcGear)]


@message("gimbal", 0, 0)
class Gimbal(Message):
    """The drone's gimbal in the ground frame, and which of its axes are at their limits."""

    roll: degrees
    pitch: degrees
    yaw: degrees
    pitch_limited: Annotated[bool, Flag(first=0)] = False
    roll_limited: Annotated[bool, Flag(first=1)] = False
    yaw_limited: Annotated[bool, Flag(first=2)] = False
    reserved: Annotated[int, Reserved()] = 0


@message("control", 0, 0)
class ControlSource(Message):
    """What controls the drone, and whether the virtual RC is on; off unless asked for."""

    mode: Annotated[int, U8(words=CurrentMode)]
    device: Annotated[int, Bits(first=0, width=3, words=ControlDevice)]
    requested: Annotated[bool, Flag(first=3)] = False
    virtual_rc: Annotated[bool, Flag(first=4)] = False
    reserved: Annotated[int, Reserved()] = 0
