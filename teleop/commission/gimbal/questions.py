"""Steps that only ask: whether the gimbal is ready, what it is and knows, and what it is set to."""

from __future__ import annotations

from collections.abc import Mapping

from teleop.commission.findings import Fact, Findings, Subject
from teleop.commission.gimbal.base import GimbalStep
from teleop.commission.gimbal.motion import answer
from teleop.commission.gimbal.places import ANGLES
from teleop.commission.step import Question, Script
from teleop.core.errors import DeviceError
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message

READY = Subject("gimbal.ready", "Balanced and unlocked, by the operator", True)
VERSION = Subject("gimbal.version", "Firmware version")
MODEL = Subject("gimbal.model", "Model, by the operator")
MODELS = {"1": "RS 2", "2": "RS 3 Pro", "3": "RS 4", "4": "RS 4 Pro", "5": "RS 5", "o": "another"}
_ASKED: Mapping[str, tuple[str, Message]] = {
    "limits": ("limits (0E 04)", gimbal.Limits()),
    "stiffness": ("stiffness (0E 06)", gimbal.Stiffness()),
    "parameters": ("user parameters (0E 0B)", gimbal.Parameters((0x22, 0x23))),
    "focus": ("focus motor (0E 12)", focus.Get()),
    "camera": ("camera (0D 01)", camera.Status()),
}
"""By key: what it is called, and the question."""
CAPABILITIES = {key: Subject(f"answers.{key}", f"Answers for {name}", True) for key, (name, _) in _ASKED.items()}
_NAMEABLE = {"pitch_max": 145, "pitch_min": 55, "yaw_max": 179, "yaw_min": 179, "roll_max": 30, "roll_min": 30}
LIMITS = {
    key: Subject(f"limits.{key}", f"Limit of the gimbal: {key.replace('_', ' ')}", most, "deg")
    for key, most in _NAMEABLE.items()
}
STIFFNESS = {key: Subject(f"stiffness.{key}", f"Stiffness of {key}", None, "%") for key in ANGLES}


class Ready(GimbalStep):
    """Asks for a balanced, unlocked gimbal."""

    key, title = "ready", "Before anything moves"
    about = (
        "Put the gimbal on its tripod with the camera on it, and balance it.",
        "Unlock the three axis locks, and switch it on: its motors hold the camera.",
        "Leave 10 cm around it. Keep a hand near its power button.",
        "Nothing moves on this page.",
    )
    subjects = (READY,)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        choices = {"y": "yes", "n": "no"}
        if (yield Question("Is the gimbal balanced, unlocked and on?", choices)) != "y":
            raise DeviceError("balance and unlock the gimbal first, then repeat this step")
        if self.bench.reads and self.bench.begin is None:
            self.bench.mark_begin()
        return [READY.found(True, "the operator answered yes")]


class Identity(GimbalStep):
    """Version, model and what it answers at all."""

    key, title = "identity", "Version, model and capabilities"
    about = (
        "The gimbal is asked for its version, its limits, its stiffness, its user",
        "parameters, its focus motor and its camera. Nothing moves.",
    )
    subjects = (VERSION, MODEL, *CAPABILITIES.values())

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        reply = yield from answer(self.bench, gimbal.Version())
        facts = [
            VERSION.found(reply.version, "asked (0E 09)")
            if isinstance(reply, gimbal.VersionReply)
            else VERSION.not_seen("it does not answer (0E 09)")
        ]
        for key, (_, question) in _ASKED.items():
            facts.append(self._capability(CAPABILITIES[key], (yield from answer(self.bench, question))))
        chosen = yield Question("Which model is it?", MODELS)
        return [*facts, MODEL.found(MODELS[chosen], "the protocol does not say: the operator did")]

    def _capability(self, subject: Subject, reply: Message | None) -> Fact:
        if reply is None:
            return subject.found(False, "no answer")
        code = getattr(reply, "return_code", 0)
        return subject.found(not code, f"return code {int(code):#04x}")


class Settings(GimbalStep):
    """Limits and stiffness as the gimbal has them."""

    key, title = "settings", "Limits and stiffness of the gimbal"
    about = ("The gimbal is asked for its own limits and the stiffness of its motors.", "Nothing moves.")
    subjects = (*LIMITS.values(), *STIFFNESS.values())

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        limits = yield from answer(self.bench, gimbal.Limits())
        stiffness = yield from answer(self.bench, gimbal.Stiffness())
        facts = []
        for subjects, reply, kind in (
            (LIMITS, limits, gimbal.LimitsReply),
            (STIFFNESS, stiffness, gimbal.StiffnessReply),
        ):
            for name, subject in subjects.items():
                value = getattr(reply, name) if isinstance(reply, kind) and not reply.return_code else None
                how = "asked (0E 04)" if subjects is LIMITS else "asked (0E 06)"
                facts.append(subject.not_seen("it does not answer") if value is None else subject.found(value, how))
        return facts
