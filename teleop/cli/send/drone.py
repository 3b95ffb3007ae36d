"""`teleop send drone`: one command to a rig's drone, and what it acknowledges.

What cannot make the drone fly is sent as it is. What can is refused with its reason unless the operator says
--i-understand, and what is safe only with a control loop behind it is refused always: see drone_catalogue.py. How
often a command is sent, and how long its acknowledgement may take, is the protocol's table, not an option.
"""

from __future__ import annotations

import secrets
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from teleop.cli.codec.format_message import in_units
from teleop.cli.options import Options
from teleop.cli.send.one_shot import opened, tell
from teleop.config.credentials import app_cipher, load_credentials
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.core.clock import SystemClock
from teleop.core.errors import DeviceError
from teleop.core.interfaces import Clock, Link
from teleop.dji.drone import messages as drone
from teleop.dji.drone.command_table import DRONE, hazard, never
from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.enums import ControlOrder
from teleop.dji.drone.onboard_sdk import M100
from teleop.dji.drone.session import ONCE, SENDS, OnboardSession
from teleop.dji.frame import FrameReader
from teleop.dji.json_record import Record, Transcriber, describe
from teleop.dji.message import STREAM, FieldError, Message
from teleop.dji.registry import Decoded
from teleop.links import parse
from teleop.sim.link import Device

POLL_PERIOD: Final = 0.001  # s between looks for the acknowledgement
CONTROL_TIMEOUT: Final = 3.0  # s in which control that is being obtained or released must be
IN_PROGRESS: Final = ("obtaining", "releasing")
DRONES: Final = ("virtual-rc", "flight")  # the types of a profile's sinks

HINTS: Final[Mapping[str, str]] = {
    "not_activated": "teleop send drone activate comes first",
    "not_in_f_mode": "the pilot's mode switch must be on F",
    "failed": "a task needs control (teleop send drone obtain control), a take-off also the motors off",
    "need_control": "teleop send drone obtain control comes first",
    "no_rights": "the app or the drone does not allow it, or control was not obtained",
    "new_device": "the app id was activated on another drone: confirm it in DJI's app",
    "no_internet": "the phone at the RC must be online the first time",
}
"""What to do about an acknowledgement that says no."""


def send_drone(words: Sequence[str], options: Options, understood: bool) -> int:
    """Send one command, print what comes of it; 0 when it was done.

    Raises DocumentError for what cannot or must not be sent, LinkError, and DeviceError for a refusal.
    """
    profile = options.profile()
    url = url_of(profile)
    simulated = parse(url).kind == "sim"
    message = asked_for(words, understood or simulated)
    if isinstance(message, drone.Activate) and not simulated:
        message = load_credentials().activation()
    cipher = app_cipher(bool(profile.encrypted))
    clock = SystemClock()
    with opened(url, clock, lambda: _simulated(clock, cipher)) as link:
        exchange = Exchange(link, url, clock, cipher)
        if simulated:  # it lives no longer than this command
            exchange.ask(drone.Activate(0))
        record = exchange.stream(message) if message.cmd_type == STREAM else exchange.ask(message)
    tell(message.name, record, refusal(message, record), readable(message.name, record), options.json)
    return 0


def asked_for(words: Sequence[str], understood: bool) -> Message:
    """The message that the words ask for, fit to be sent. Raises DocumentError."""
    if len(words) < 2:
        raise DocumentError(["name a command for the drone; teleop send drone --help lists all"])
    try:
        message = DRONE.find(words)
        message.check()
    except FieldError as error:
        raise DocumentError([str(error)]) from None
    if reason := never(message):
        raise DocumentError([f"{message.name} is not sent by itself: {reason}"])
    if (reason := hazard(message)) and not understood:
        raise DocumentError([f"{message.name}: {reason}; to send it all the same, give --i-understand"])
    return message


def url_of(profile: Profile) -> str:
    """Where the rig has its drone. Raises DocumentError when it has none."""
    for sink in profile.sinks:
        if sink.type in DRONES:
            return profile.links[sink.link]
    raise DocumentError([f"{profile.name} has no drone: --rig m100 has one, --rig sim-drone a simulated one"])


class Exchange:
    """Commands to one drone and what it acknowledges.

    It numbers from anywhere: a command with the numbers of the last one would be taken for its repetition. With
    `cipher` everything is encrypted but what comes before activation: version and activation themselves.
    """

    def __init__(self, link: Link, url: str, clock: Clock, cipher: Cipher | None = None) -> None:
        self._link, self._url, self._clock, self._cipher = link, url, clock, cipher
        self._session = OnboardSession(first_sequence=secrets.randbelow(0x10000))

    def stream(self, message: Message) -> Record:
        """Send a message that has no acknowledgement, once; its own record. Raises LinkError."""
        cipher = self._session.cipher = self._cipher
        frame = self._session.command(message)
        self._link.send(frame)
        [sent] = FrameReader().feed(frame, 0.0)
        return Transcriber(M100, None if cipher is None else lambda: cipher).record(sent)

    def ask(self, message: Message) -> Record:
        """The record of what the drone acknowledges, asked again while control changes hands.

        Raises LinkError, or DeviceError without an acknowledgement.
        """
        end = self._clock.now() + CONTROL_TIMEOUT
        while True:
            record = self._acknowledged(message)
            now = self._clock.now()
            if record["fields"].get("code") not in IN_PROGRESS or now > end:
                return record
            self._clock.sleep_until(now + SENDS[drone.Control].timeout)

    def _acknowledged(self, message: Message) -> Record:
        self._session.cipher = None if isinstance(message, drone.Version | drone.Activate) else self._cipher
        frame, _ = self._session.request(message, self._clock.now())
        self._link.send(frame)
        while True:
            now = self._clock.now()
            for received in self._session.receive(self._link.receive(), now):
                if received.request is not None:
                    return describe(M100, received.frame, Decoded(received.message, message.set_and_id))
            for again in self._session.due(now):
                self._link.send(again)
            if self._session.overdue(now):
                raise DeviceError(self._silence(message))
            self._clock.sleep_until(now + POLL_PERIOD)

    def _silence(self, message: Message) -> str:
        timeout, sends = SENDS.get(type(message), ONCE)
        often = f", sent {sends} times" if sends > 1 else ""
        return (
            f"{self._url}: no acknowledgement of {message.name} within {timeout * sends * 1000:.0f} ms{often}: "
            f"is it on, is the cable in, is Enable API control set in DJI Assistant 2?{self._doubt(message)}"
        )

    @staticmethod
    def _doubt(message: Message) -> str:
        """What no answer does not exclude."""
        return " It may have been done all the same." if hazard(message) else ""


def refusal(message: Message, record: Record) -> str:
    """Why the drone did not obey the command; "" when it did, or when only its version was asked for."""
    if not record["reply"] or isinstance(message, drone.Version):
        return ""
    code = record["fields"].get("code", "an acknowledgement of unknown meaning")
    match message:
        case drone.Control(order=ControlOrder.OBTAIN):
            done = code == "obtained"
        case drone.Control():
            done = code == "released"
        case drone.Arm():
            done = code in ("ok", "already")
        case drone.Task():
            done = code == "started"
        case drone.TaskResult():
            done = code in ("in_progress", "succeeded")
        case _:
            done = code == "ok"
    return "" if done else f"{code}: {HINTS[code]}" if code in HINTS else str(code)


def readable(name: str, record: Record) -> Iterator[str]:
    """Lines for people on how the command `name` went: a field a line."""
    if not record["reply"]:
        yield f"{name}: sent once, it is never acknowledged"
        return
    fields = in_units(record)
    yield f"{name}: {fields.pop('code', 'acknowledged')}"
    if "checksum" in fields:
        fields["checksum"] = f"0x{int(fields['checksum']):08X}"
    width = max(map(len, fields), default=0)
    yield from (f"  {field:{width}}  {text}" for field, text in fields.items())


def _simulated(clock: Clock, cipher: Cipher | None) -> Device:
    from teleop.sim.drone.device import SimulatedDrone

    return SimulatedDrone(now=clock.now(), cipher=cipher)
