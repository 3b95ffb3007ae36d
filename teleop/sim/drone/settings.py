"""How real drones differ from one another, or may: the settings of a simulated one."""

from __future__ import annotations

from dataclasses import dataclass

VIRTUAL_RC_TIMEOUT = 1.0  # s without sticks after which virtual RC ends: Virtual RC page, note 1
MOVEMENT_TIMEOUT = 0.5  # s for which a movement command is obeyed; the real time is not known


@dataclass(frozen=True)
class DroneSettings:
    """Times are seconds. Signs are 1 or -1: how it broadcasts against the documents.

    `asks_twice`: obtain and release are answered by 3 or 4 first and confirmed when they are sent again, as
    OPENProtocol.md 3.1.9 says of 01 00 ("sent twice, the first ACK will be fail"). `broadcasts_before_activation`: it
    broadcasts, and takes 00 10, before activation (OSDK issue 145). `answer_delay` is how late acknowledgements come.
    """

    asks_twice: bool = True
    broadcasts_before_activation: bool = True
    answer_delay: float = 0.0
    virtual_rc_timeout: float = VIRTUAL_RC_TIMEOUT
    movement_timeout: float = MOVEMENT_TIMEOUT
    attitude_signs: tuple[int, int, int] = (1, 1, 1)  # of roll, pitch and yaw
    rate_signs: tuple[int, int, int] = (1, 1, 1)
    climb_sign: int = 1


M100 = DroneSettings()
"""As far as it is known."""
