from teleop.core.clock import VirtualClock
from teleop.core.interfaces import Link
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.link import SimLink


def test_a_device_in_this_process_lives_by_the_clock_of_its_link() -> None:
    clock, host = VirtualClock(100.0), Session()
    link: Link = SimLink(SimulatedGimbal(), clock.now)
    link.send(host.command(gimbal.Position(40.0, 0.0, 0.0, time_for_action=4.0)))
    clock.sleep_until(101.0)
    frame, _ = host.request(gimbal.Angles(), clock.now())
    link.send(frame)
    replies = [received.message for received in host.receive(link.receive(), clock.now())]
    assert replies[1] == gimbal.AnglesReply(0, gimbal.AngleKind.ATTITUDE, 10.0, 0.0, 0.0)
    assert link.receive() == b""
