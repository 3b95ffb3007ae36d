"""The numbers that mean something on the drone, by the words that people and JSON use for them.

Names are the appendix's where it has any (Appendix.md); values are those of docs/protocol-facts.md.
"""

from __future__ import annotations

from enum import IntEnum


class Code(IntEnum):
    """What any acknowledgement may say."""

    OK = 0
    KEY_ERROR = 0xFF00
    NOT_ACTIVATED = 0xFF01
    NO_RIGHTS = 0xFF02


class ActivationCode(IntEnum):
    """What became of an activation (00 01)."""

    OK = 0
    BAD_PARAMETERS = 1
    BAD_ENCODING = 2
    NEW_DEVICE = 3
    NO_APP = 4
    NO_INTERNET = 5
    REFUSED = 6
    WRONG_LEVEL = 7
    WRONG_VERSION = 8
    KEY_ERROR = 0xFF00
    NOT_ACTIVATED = 0xFF01
    NO_RIGHTS = 0xFF02


class ControlCode(IntEnum):
    """What became of asking for control (01 00); while OBTAINING or RELEASING it has to be asked again."""

    NOT_IN_F_MODE = 0
    RELEASED = 1
    OBTAINED = 2
    OBTAINING = 3
    RELEASING = 4
    IOC = 0xC9
    KEY_ERROR = 0xFF00
    NOT_ACTIVATED = 0xFF01
    NO_RIGHTS = 0xFF02


class TaskCode(IntEnum):
    """The answer to a task (01 01): STARTED is the only success (OPENProtocol.md 3.1.9; dji_error.cpp of v3.3.1)."""

    FAILED = 1
    STARTED = 2
    KEY_ERROR = 0xFF00
    NOT_ACTIVATED = 0xFF01
    NO_RIGHTS = 0xFF02


class TaskResultCode(IntEnum):
    """How a task went (01 02): OPENProtocol.md 3.1.9, "Request Switch Result"."""

    WRONG_NUMBER = 1
    IN_PROGRESS = 3
    FAILED = 4
    SUCCEEDED = 5
    KEY_ERROR = 0xFF00
    NOT_ACTIVATED = 0xFF01
    NO_RIGHTS = 0xFF02


class ArmCode(IntEnum):
    """What became of arming or disarming (01 05)."""

    OK = 0
    NEED_CONTROL = 1
    ALREADY = 2
    IN_THE_AIR = 3
    KEY_ERROR = 0xFF00
    NOT_ACTIVATED = 0xFF01
    NO_RIGHTS = 0xFF02


class ShortArmCode(IntEnum):
    """ArmCode where there is a byte for it."""

    OK = 0
    NEED_CONTROL = 1
    ALREADY = 2
    IN_THE_AIR = 3


class Rate(IntEnum):
    """How often a part of the broadcast comes; HOLD leaves it as it is (00 10)."""

    OFF = 0
    HZ_1 = 1
    HZ_10 = 2
    HZ_50 = 3
    HZ_100 = 4
    HOLD = 5


class ControlOrder(IntEnum):
    """01 00."""

    RELEASE = 0
    OBTAIN = 1


class ArmOrder(IntEnum):
    """01 05."""

    DISARM = 0
    ARM = 1


class TaskKind(IntEnum):
    """01 01."""

    RETURN_HOME = 1
    TAKE_OFF = 4
    LAND = 6


class Event(IntEnum):
    """02 01."""

    CONTROL_LOST = 4


class FlightStatus(IntEnum):
    """STANDBY comes 2 s after FINISH_LANDING, IN_AIR as soon as the drone leaves the ground."""

    STANDBY = 1
    TAKE_OFF = 2
    IN_AIR = 3
    LANDING = 4
    FINISH_LANDING = 5


class ControlDevice(IntEnum):
    """Who controls the drone."""

    REMOTE_CONTROLLER = 0
    MOBILE_DEVICE = 1
    ONBOARD_DEVICE = 2


class RcMode(IntEnum):
    """The mode switch as broadcast; as a channel it is ModeChannel."""

    P = -8000
    A = 0
    F = 8000


class RcGear(IntEnum):
    """The gear switch as broadcast; as a channel it is GearChannel."""

    UP = -10000
    DOWN = -4545


class ModeChannel(IntEnum):
    """The mode switch as a channel of the virtual RC."""

    P = 1552
    A = 1024
    F = 496


class GearChannel(IntEnum):
    """The gear switch as a channel of the virtual RC."""

    UP = 1684
    DOWN = 1324


class CurrentMode(IntEnum):
    """What the drone's controller is doing ("current api control mode"), spelt as there."""

    ATTI_STOP = 0
    HORIZ_ANG_VERT_VEL_YAW_ANG = 1
    HORIZ_ANG_VERT_VEL_YAW_RATE = 2
    HORIZ_VEL_VERT_VEL_YAW_ANG = 3
    HORIZ_VEL_VERT_VEL_YAW_RATE = 4
    HORIZ_POS_VERT_VEL_YAW_ANG = 5
    HORIZ_POS_VERT_VEL_YAW_RATE = 6
    HORIZ_ANG_VERT_POS_YAW_ANG = 7
    HORIZ_ANG_VERT_POS_YAW_RATE = 8
    HORIZ_VEL_VERT_POS_YAW_ANG = 9
    HORIZ_VEL_VERT_POS_YAW_RATE = 10
    HORIZ_POS_VERT_POS_YAW_ANG = 11
    HORIZ_POS_VERT_POS_YAW_RATE = 12
    HORIZ_ANG_VERT_THR_YAW_ANG = 13
    HORIZ_ANG_VERT_THR_YAW_RATE = 14
    HORIZ_VEL_VERT_THR_YAW_ANG = 15
    HORIZ_VEL_VERT_THR_YAW_RATE = 16
    HORIZ_POS_VERT_THR_YAW_ANG = 17
    HORIZ_POS_VERT_THR_YAW_RATE = 18
    GPS_ATII_CTRL_CL_YAW_RATE = 97
    GPS_ATTI_CTRL_YAW_RATE = 98
    ATTI_CTRL_YAW_RATE = 99
    ATTI_CTRL_STOP = 100
