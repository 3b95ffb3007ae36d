"""The first steps: propellers, what comes before anything is sent, version, activation and push frequencies."""

from __future__ import annotations

import re
from collections.abc import Mapping

from teleop.commission.drone.base import OFF, ActivatedStep, DroneStep, answer, check_on_ground, wait
from teleop.commission.drone.bench import RATES
from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.runner import RefusedError
from teleop.commission.step import Question, Script
from teleop.core.errors import DeviceError
from teleop.devices.drone.control_mode import word_of
from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast import Broadcast
from teleop.dji.drone.enums import Code, FlightStatus, Rate

WORD = "props-off"  # without a space, which stops
TRIES = 3  # of typing them
LISTENS = 1.0  # s
COUNTED = 3.0  # s over which the parts of the broadcast are counted
HERTZ: Mapping[Rate, float] = {Rate.HZ_1: 1.0, Rate.HZ_10: 10.0, Rate.HZ_50: 50.0, Rate.HZ_100: 100.0}

EARLY = Subject("broadcast.early", "It broadcasts before it is activated", True)
DAMAGE = Subject("link.damage", "Bytes on the link that make no frame", 0)
VERSION = Subject("drone.version", "Firmware, as it names itself")
CODE = Subject("version.code", "Code in the reply to the question for the version, before activation", "not activated")
ACTIVATED = Subject("drone.activated", "It takes the activation (00 01)", True)
FREQUENCIES = Subject("broadcast.frequencies", "It takes push frequencies (00 10)", True)
PARTS = [part for part in Broadcast.order if HERTZ.get(Rate(getattr(RATES, part)))]
RATE = {
    part: Subject(f"broadcast.rate.{part}", f"Rate of {part.replace('_', ' ')}", HERTZ[getattr(RATES, part)], "Hz")
    for part in PARTS
}
STATUS = Subject("broadcast.status", "Flight status on the ground", "standby")


class Propellers(DroneStep):
    """Nothing is sent to a drone before its operator has typed that the propellers are off."""

    key, title = "propellers", "Before anything is sent"
    about = (
        "Take all propellers off the drone, also if it is not to fly today.",
        "Put it on the ground or a table, with a charged battery.",
        "Switch its RC on, the mode switch in P.",
        "Nothing here can start the motors or take off. Nothing is sent on this page.",
    )
    subjects = (OFF,)

    def unfit(self, findings: Findings) -> str:  # noqa: ARG002
        return ""

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        for _ in range(TRIES):
            typed = yield Question(f"Are all propellers off? Then type {WORD}", word=True)
            if re.sub(r"[^a-z]", "", typed.lower()) == re.sub(r"[^a-z]", "", WORD):
                return [OFF.found(True, f"the operator typed {WORD}")]
        raise RefusedError(f"a drone is commissioned only after {WORD} is typed")


class ListenToDrone(DroneStep):
    """Hears the line for a second, and sends nothing."""

    key, title, automatic = "listen", "Listening to the drone", True
    about = ("Nothing is sent for 1 s: the line is listened to.",)
    subjects = (EARLY, DAMAGE)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        counts, damage = bench.counts.total(), bench.connection.session.counts.damage
        yield from wait(bench, LISTENS, "listening")
        came = bench.counts.total() - counts
        if bench.get("status") not in (None, FlightStatus.STANDBY):
            raise RefusedError("the drone reports that it flies: land it, then start again")
        how = f"{came} parts of the broadcast in {LISTENS:g} s, before anything was sent"
        broken = bench.connection.session.counts.damage - damage
        return [EARLY.found(came > 0, how), DAMAGE.found(broken, f"counted for {LISTENS:g} s", within=1)]


class Activation(DroneStep):
    """Asks for the version, and activates."""

    key, title = "activation", "Version and activation"
    about = (
        "The drone is asked for its version, then activated with your app id",
        "(TELEOP_DJI_APP_ID). 'Enable API control' must be on in DJI Assistant 2.",
        "Nothing moves.",
    )
    subjects = (VERSION, CODE, ACTIVATED)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        reply = yield from answer(bench, bench.ask_version())
        if not isinstance(reply, drone.VersionAck | drone.ShortVersionAck):
            raise DeviceError(
                "the drone does not answer: is it on, is the cable in, are its baud rate and wires right?"
            )
        bench.firmware, bench.serial = reply.version, getattr(reply, "id", "")
        facts = [VERSION.found(reply.version, "asked (00 00)")]
        known: dict[int, str] = {Code.NOT_ACTIVATED: "not activated", Code.OK: "ok"}
        facts.append(CODE.found(known.get(reply.code, f"{reply.code:#06x}"), "asked (00 00)"))
        activated = yield from answer(bench, bench.activate())
        if activated is None:
            raise DeviceError("the drone does not answer when asked to activate it")
        if code := getattr(activated, "code", None):
            facts.append(ACTIVATED.found(False, f"it answered: {word_of(code)}"))
            return facts
        bench.use_cipher()
        return [*facts, ACTIVATED.found(True, "asked (00 01)")]


class Frequencies(ActivatedStep):
    """Sets the push frequencies, and counts."""

    key, title = "frequencies", "What it broadcasts, and how often"
    about = ("The push frequencies are set, and what comes is counted for 3 s.", "Nothing moves.")
    subjects = (FREQUENCIES, *RATE.values(), STATUS)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        reply = yield from answer(bench, bench.set_rates())
        taken = reply is not None and not getattr(reply, "code", 1)
        facts: list[Fact] = [FREQUENCIES.found(taken, "asked (00 10)" if reply else "no answer to 00 10")]
        yield from wait(bench, 0.3)
        before, began = bench.counts.copy(), bench.now
        yield from wait(bench, COUNTED, "counting")
        seconds = bench.now - began
        for part, subject in RATE.items():
            count = bench.counts[part] - before[part]
            wanted = HERTZ[getattr(RATES, part)]
            how = f"counted for {COUNTED:g} s, asked for {wanted:g} Hz"
            rate = round(count / seconds, 1)
            facts.append(
                subject.found(rate, how, within=0.15 * wanted + 1 / COUNTED) if count else subject.not_seen(how)
            )
        status = bench.get("status")
        facts.append(
            STATUS.not_seen("no status came") if status is None else STATUS.found(word_of(status), "broadcast")
        )
        if status is not None:
            check_on_ground(bench)
        return facts
