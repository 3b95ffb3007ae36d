"""The first steps: what is on the bus before anything is sent, whether the camera records, and how replies look."""

from __future__ import annotations

from statistics import fmean

from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.gimbal.base import GimbalStep
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.motion import answer, wait
from teleop.commission.runner import RefusedError
from teleop.commission.step import Script
from teleop.core.errors import DeviceError
from teleop.devices.connection import Connection
from teleop.dji.gimbal import camera
from teleop.links.can import HOST_ID
from teleop.links.url import R_SDK_BITRATE, LinkAddress

LISTENS = 1.0  # s
ASKS = 1.5  # s of questions for the angles
ERRORS = "error frames", "damage", "bus off", "refused"
NETWORKS = "udp_multicast", "virtual"
SHARE = 0.05  # of the replies that may get lost on a good bus

ADAPTER = Subject("adapter.kind", "Adapter")
BITRATE = Subject("adapter.bitrate", "Bit rate of the bus", R_SDK_BITRATE, "bit/s")
FOREIGN = Subject("bus.foreign", "CAN frames of other ids", None, "per s")
OTHER_HOST = Subject("bus.other_host", "Commands of another program or device", 0)
FIRST_ERRORS = Subject("bus.first_errors", "Error frames and damage before anything was sent", 0)
ERROR_FRAMES = Subject("bus.errors", "Error frames and damage", 0)
TERMINATION = Subject("bus.termination", "Termination of the bus", "no sign of a fault")
RECORDING = Subject("camera.recording", "The camera records at the beginning", False)
COMMAND = Subject("reply.command", "Replies have command set and id", True)
TYPED = Subject("reply.type", "Replies with angles have their type", True)
ANSWERED = Subject("reply.angles", "Questions for the angles are answered", True)
LOST = Subject("reply.lost", "Share of the questions without an answer", 0.0)
REPLY_TIME = Subject("reply.time", "Time until a reply", None, "s")


class Listen(GimbalStep):
    """Hears the bus for a second, and sends nothing."""

    key, title, automatic = "listen", "Listening to the bus", True
    about = ("Nothing is sent for 1 s: the bus is listened to.",)
    subjects = (ADAPTER, BITRATE, FOREIGN, OTHER_HOST, FIRST_ERRORS)

    def __init__(self, bench: GimbalBench, address: LinkAddress) -> None:
        super().__init__(bench)
        self._address = address

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        connection = self.bench.connection
        foreign, others, errors = connection.foreign, connection.with_own_id, errors_of(connection)
        yield from wait(self.bench, LISTENS, "listening")
        foreign, others, errors = (
            connection.foreign - foreign,
            connection.with_own_id - others,
            errors_of(connection) - errors,
        )
        how = f"counted for {LISTENS:g} s, before anything was sent"
        return [
            ADAPTER.found(self._address.interface, "the link of the rig; it could be opened"),
            self._bitrate(foreign + others + connection.session.counts.frames_in, errors),
            FOREIGN.found(round(foreign / LISTENS), how),
            OTHER_HOST.found(others, f"frames with the host's id {HOST_ID:#x}, {how}"),
            FIRST_ERRORS.found(errors, how),
        ]

    def _bitrate(self, heard: int, errors: int) -> Fact:
        """By listening: frames arrive whole only at the bit rate of the bus."""
        if why := no_bitrate(self._address):
            return BITRATE.not_seen(why)
        if heard:
            return BITRATE.found(self._address.bitrate, f"{heard} frames arrived at it before anything was sent")
        if errors:
            return BITRATE.found(None, f"only errors at {self._address.bitrate}: another bit rate, or no termination")
        return BITRATE.not_seen("the bus was silent: the first reply says it")


class CameraIdle(GimbalStep):
    """Refuses to begin while the camera records."""

    key, title, automatic = "camera-idle", "Does the camera record?", True
    about = ("The camera is asked whether it records. Nothing moves.",)
    subjects = (RECORDING,)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        bench.quiet = False
        yield from wait(bench, 0.1, "asking")
        reply = yield from answer(bench, camera.Status())
        if isinstance(reply, camera.StatusReply) and reply.state == camera.CameraState.RECORDING:
            raise RefusedError("the camera is recording: stop the recording, then run teleop commission again")
        if not isinstance(reply, camera.StatusReply):
            return [RECORDING.not_seen("the camera does not answer")]
        return [RECORDING.found(False, f"status {int(reply.state)} (0D 01)")]


class Replies(GimbalStep):
    """Asks for the angles again and again, and looks at the replies."""

    key, title, automatic = "replies", "How the gimbal answers", True
    about = ("The gimbal is asked for its angles. Nothing moves.",)
    subjects = (ANSWERED, COMMAND, TYPED, LOST, REPLY_TIME, ERROR_FRAMES, TERMINATION)

    def __init__(self, bench: GimbalBench, address: LinkAddress) -> None:
        super().__init__(bench)
        self._address = address

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        before = errors_of(bench.connection)
        replied, lost = bench.replied, bench.lost
        yield from wait(bench, ASKS, "asking")
        replied, lost = bench.replied - replied, bench.lost - lost
        asked = replied + lost
        lost = lost / asked if asked else 1.0
        how = f"{replied} replies to {asked} questions"
        facts = [ANSWERED.found(replied > 0, how), LOST.found(round(lost, 3), how, within=SHARE)]
        if replied:
            variant = "by the length of the reply (0E 02)"
            facts += [COMMAND.found(not bench.bare, variant), TYPED.found(not bench.legacy, variant)]
            facts.append(REPLY_TIME.found(round(fmean(bench.reply_times), 3), "question to reply, in steps of 10 ms"))
        else:
            facts += [
                each.not_seen("questions for the angles are not answered") for each in (COMMAND, TYPED, REPLY_TIME)
            ]
        if replied and not no_bitrate(self._address):
            facts.append(BITRATE.found(self._address.bitrate, "replies arrive at it"))
        errors = errors_of(bench.connection) - before
        suspect = errors > 0 or (replied > 0 and lost > SHARE)
        facts.append(ERROR_FRAMES.found(errors, f"counted by the link in {ASKS:g} s"))
        facts.append(
            TERMINATION.found(
                "suspected missing: 120 ohm across CANH and CANL" if suspect else "no sign of a fault",
                f"{errors} errors on the bus, {100 * lost:.0f} % of the replies lost",
            )
        )
        if not replied and not bench.reads and bench.connection.session.counts.frames_in == 0:
            raise DeviceError("the gimbal does not answer: is it on, and is AD_COM pulled to ground?")
        return facts


def errors_of(connection: Connection) -> int:
    """Error frames and damage that the link has counted so far."""
    return sum(connection.counts.get(name, 0) for name in ERRORS)


def no_bitrate(address: LinkAddress) -> str:
    """Why a link has no bit rate, "" for one that has."""
    if address.kind != "can":
        return "the gimbal is simulated: there is no bus"
    return "the bus is a network: it has no bit rate" if address.interface in NETWORKS else ""
