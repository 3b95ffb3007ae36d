"""`teleop send`: one command to a rig's gimbal, camera or focus motor, and what it answers; for a drone, send_drone.

Everything here comes from the catalogue: the words, the help, the checks. A message is checked before any port opens,
so that a typing error never costs a half-done exchange. A lost reply does not mean a lost command, so whether to ask
again depends on what is asked: a question or a setting may be repeated, a photo, a toggle or a relative turn may not.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Annotated, Any

from cyclopts import Parameter
from cyclopts.validators import Number

from teleop.cli.codec.format_message import in_units
from teleop.cli.options import DEFAULTS, Options, whole
from teleop.cli.send.drone import send_drone
from teleop.cli.send.help import print_help
from teleop.cli.send.one_shot import opened, tell
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.clock import SystemClock
from teleop.core.errors import DeviceError
from teleop.core.interfaces import Clock, Link
from teleop.dji.command_parser import fields_of
from teleop.dji.frame import FrameReader
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.command_table import find
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import REPLY_TIMEOUT, Received, Session
from teleop.dji.gimbal.unnamed_axes import unnamed
from teleop.dji.json_record import Record, Transcriber, describe
from teleop.dji.message import FieldError, Message
from teleop.sim.link import Device

POLL_PERIOD = 0.001  # s between looks for the reply; a gimbal answers within 5 ms
RETRIES = 2  # where asking again does no harm
ONCE: Mapping[type[Message], Callable[[Any], bool]] = {
    gimbal.Position: lambda position: not position.absolute,
    gimbal.Orient: lambda orient: orient.orientation == gimbal.Orientation.TOGGLE,
    gimbal.Calibrate: lambda calibrate: calibrate.start,
    gimbal.ActiveTrack: lambda _track: True,
    camera.Command: lambda command: command.command == camera.CameraCommand.SHUTTER,
    camera.ShortCommand: lambda command: command.command == camera.CameraCommand.SHUTTER,
    focus.Calibrate: lambda calibrate: calibrate.action != focus.CalibrationAction.STOP,
}
"""What must not be done twice because its reply was lost."""

NOT_DONE: Mapping[tuple[str, str], str] = {
    ("execution", "failed"): "it failed",
    ("kind", "none"): "the angles are not ready",
}
"""Fields of a reply that say no although the return code is ok."""

TAKEN_OVER = (
    "speed control stays taken over; to release it: teleop send gimbal speed yaw=0 roll=0 pitch=0 take_over=false"
)


def send(
    *words: Annotated[
        str,
        Parameter(
            metavar="COMMAND",
            help="gimbal, camera, focus or drone, a command and field=value ...; or plain words, as recenter.",
        ),
    ],
    retries: Annotated[
        int | None,
        Parameter(
            metavar="N",
            help="Retries without a reply: 2, and 0 for what must not be done twice.",
            validator=Number(gte=0),
            converter=whole,
            show_default=False,
        ),
    ] = None,
    show_help: Annotated[
        bool,
        Parameter(
            name=("--help", "-h"),
            help="List every command, or those that begin with the words.",
            negative=(),
            show_default=False,
        ),
    ] = False,
    i_understand: Annotated[
        bool,
        Parameter(help="Send what can make a drone fly or fall.", negative=(), show_default=False),
    ] = False,
    options: Options = DEFAULTS,
) -> int:
    """Send one command to the gimbal, the camera, the focus motor or the drone, and print the reply."""
    if show_help:
        print_help(words)
        return 0
    if words and words[0].lower() == "drone":
        if retries is not None:
            raise DocumentError(["--retries is for the gimbal only: the drone's protocol sets its own"])
        return send_drone(words, options, i_understand)
    if i_understand:
        raise DocumentError(["--i-understand is for what makes a drone fly: teleop send drone ..."])
    profile = options.profile()
    message = asked_for(words)
    url = url_of(profile, message.name.partition(".")[0])
    tries = 1 + (default_retries(message) if retries is None else retries)
    clock = SystemClock()
    with opened(url, clock, _simulated) as link:
        record = stream(link, message) if not message.has_reply else ask(link, url, message, clock, tries)
    tell(message.name, record, refusal(record), readable(message.name, record), options.json)
    if isinstance(message, gimbal.Speed | gimbal.Joystick) and (left := unnamed(fields_of(words))):
        print(f"{message.name}: {' and '.join(left)} not named: sent as 0", file=sys.stderr)
    if note := mount_note(profile, message):
        print(note, file=sys.stderr)
    if isinstance(message, gimbal.Speed) and message.take_over:
        print(TAKEN_OVER, file=sys.stderr)
    return 0


def asked_for(words: Sequence[str]) -> Message:
    """The message that the words ask for, fit to be sent. Raises DocumentError."""
    if not words:
        raise DocumentError(["name a command; teleop send --help lists all"])
    try:
        message = find(words)
        message.check()
    except FieldError as error:
        raise DocumentError([str(error)]) from None
    return message


def url_of(profile: Profile, device: str) -> str:
    """Where the rig has its gimbal, camera or focus motor. Raises DocumentError when it has none."""
    for sink in profile.sinks:
        if sink.type == device:
            return profile.links[sink.link]
    raise DocumentError([f"{profile.name} has no {device}: its sinks are {', '.join(s.type for s in profile.sinks)}"])


def mount_note(profile: Profile, message: Message) -> str:
    """What the yaw of a command or its reply means on a rig whose mount is turned; "" where that is no question."""
    mounts = [section.mount.yaw for section in profile.sinks if isinstance(section, GimbalSection)]
    if not any(mounts) or not isinstance(message, gimbal.Position | gimbal.Angles):
        return ""
    return f"{message.name}: yaw is the gimbal's own; the mount of {profile.name} has pan 0 at yaw {mounts[0]:g}"


def default_retries(message: Message) -> int:
    """How often `message` is sent again when no reply comes, unless the operator says otherwise."""
    return 0 if ONCE.get(type(message), lambda _message: False)(message) else RETRIES


def stream(link: Link, message: Message) -> Record:
    """Send a message that has no reply, once; its own record. Raises LinkError."""
    frame = Session().command(message)
    link.send(frame)
    [sent] = FrameReader().feed(frame, 0.0)
    return Transcriber(R_SDK).record(sent)


def ask(link: Link, url: str, message: Message, clock: Clock, tries: int) -> Record:
    """The record of the reply to `message`, sent up to `tries` times. Raises LinkError, or DeviceError without one."""
    session = Session()
    for _ in range(tries):
        frame, _ = session.request(message, clock.now())
        link.send(frame)
        if received := _reply(session, link, clock):
            return describe(R_SDK, received.frame, R_SDK.decode(received.frame, message.set_and_id))
    often = "" if tries == 1 else f", asked {tries} times"
    raise DeviceError(
        f"{url}: no reply to {message.name} within {REPLY_TIMEOUT * 1000:.0f} ms{often}: is it on, is the cable in?"
    )


def _reply(session: Session, link: Link, clock: Clock) -> Received | None:
    """The reply to the open request, None when it is overdue; pushes and others' replies are passed over."""
    while True:
        now = clock.now()
        for received in session.receive(link.receive(), now):
            if received.request is not None:
                return received
        if session.overdue(now):
            return None
        clock.sleep_until(now + POLL_PERIOD)


def refusal(record: Record) -> str:
    """Why the device did not obey the command; "" when it did."""
    if not record["reply"]:
        return ""
    fields = record["fields"]
    code = fields.get("return_code", "missing")
    if code != "ok":
        return f"return code {code}"
    words = ((name, value) for name, value in fields.items() if isinstance(value, str))
    return next((NOT_DONE[each] for each in words if each in NOT_DONE), "")


def _simulated() -> Device:
    from teleop.sim.gimbal.device import SimulatedGimbal

    return SimulatedGimbal()


def readable(name: str, record: Record) -> Iterator[str]:
    """Lines for people on how the command `name` went: a field a line."""
    if not record["reply"]:
        yield f"{name}: sent; this command has no reply"
        return
    yield f"{name}: ok"
    fields = {field: text for field, text in in_units(record).items() if field != "return_code"}
    width = max(map(len, fields), default=0)
    yield from (f"  {field:{width}}  {text}" for field, text in fields.items())
