"""What the gimbal does at a speed of its own: follow modes and recentering. Each asks separately."""

from __future__ import annotations

from teleop.commission.findings import Findings, Subject
from teleop.commission.gimbal.base import GimbalStep, answered
from teleop.commission.gimbal.motion import answer, home, wait
from teleop.commission.gimbal.places import gone
from teleop.commission.step import Question, Script, Wait
from teleop.config.wiring import half_turn
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import CenterAction, FollowMode

MODES = {"l": FollowMode.LOCK, "y": FollowMode.YAW, "s": FollowMode.SPORT}
NAMES = {"l": "lock", "y": "yaw", "s": "sport"}
FOLLOW = {key: Subject(f"follow.{name}", f"Follow mode {name} is taken (0E 0E)", True) for key, name in NAMES.items()}
FOLLOWED = Subject("follow.moved", "How far it turned when the mode changed", None, "deg")
RECENTERS = Subject("recenter.obeyed", "It recenters (0E 0E, FE 01)", True)
SECONDS = Subject("recenter.seconds", "Time until it rests after recentering", None, "s")
FASTEST = Subject("recenter.fastest", "Highest speed while it recenters", None, "deg/s")
YAW = Subject("recenter.yaw", "Yaw that it reports when it looks straight ahead", 0.0, "deg")
STRAIGHT = Subject("recenter.straight", "It looks straight ahead after recentering", True)
CENTERED = 5.0  # s at most for recentering
NEAR = 3.0  # deg from a place where nothing needs to be set


class FollowStep(GimbalStep):
    """Sets each mode, and then the one that was on."""

    key, title = "follow", "Follow modes"
    about = (
        "You are asked which follow mode is on. The gimbal is then set to lock, yaw and",
        "sport, a second each, and back to the one that was on.",
    )
    consent = "In a follow mode the gimbal may turn to face ahead, at a speed of its own."
    subjects = (*FOLLOW.values(), FOLLOWED)

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        known = yield Question("Which follow mode is on?", dict(NAMES))
        before, facts = (bench.mean() if bench.reads else None), []
        for key, mode in MODES.items():
            reply = yield from answer(bench, gimbal.Mode(mode))
            code = getattr(reply, "return_code", None)
            facts.append(FOLLOW[key].found(code == 0, answered(code, "no answer")))
            yield from wait(bench, 1.0, f"follow mode {NAMES[key]}")
        yield from answer(bench, gimbal.Mode(MODES[known]))
        yield from wait(bench, 1.0, f"back to {NAMES[known]}")
        if before is None:
            return [*facts, FOLLOWED.not_seen("no angles are read")]
        moved = max(map(abs, gone(before, bench.mean())))
        facts.append(FOLLOWED.found(round(moved, 1), "the largest of the three angles"))
        yield from home(bench)
        return facts


class RecenterStep(GimbalStep):
    """Recenters, and goes back to where it began."""

    key, title = "recenter", "Recenter"
    consent = "It turns to its center at a speed of its own, which may be fast and far."
    subjects = (RECENTERS, SECONDS, FASTEST, YAW, STRAIGHT)
    moves = True

    @property
    def about(self) -> tuple[str, ...]:  # pyright: ignore[reportIncompatibleVariableOverride] - it changes with the bench
        way = ""
        if self.bench.reads:
            here = self.bench.mean()
            way = ", ".join(f"{self.bench.name(index)} {abs(here[index]):.0f} deg" for index in self.bench.driven)
        return (
            f"The gimbal recenters at a speed of its own: {way or 'from where it is'}.",
            "You are asked whether it looks straight ahead then.",
            f"It goes back at {self.bench.back_speed:g} deg/s, which may take a while.",
        )

    def script(self, findings: Findings) -> Script:  # noqa: ARG002
        bench = self.bench
        before, begin = bench.mean(), bench.now
        reply = yield from answer(bench, gimbal.Mode(FollowMode.UNCHANGED, CenterAction.RECENTER))
        code = getattr(reply, "return_code", None)
        fastest, rests = 0.0, begin
        while bench.now < begin + CENTERED:
            recent = bench.since(bench.now - 0.15)
            if len(recent) >= 3:
                span = recent[-1].time - recent[0].time
                ways = [abs(half_turn(b - a)) for a, b in zip(recent[0].angles, recent[-1].angles, strict=True)]
                fastest = max(fastest, max(ways) / span)
            rests = rests if bench.still else bench.now
            if bench.now > begin + 1.5 and bench.still:
                break
            yield Wait(0.02, "it recenters")
        moved, yaw = max(map(abs, gone(before, bench.mean()))), bench.mean()[0]
        how = f"{answered(code, 'no answer')}, turned {moved:.1f} deg"
        seen = yield Question("Does the camera look straight ahead, and level?", {"y": "yes", "n": "no"})
        facts = [
            RECENTERS.found(code == 0 and seen == "y", how),
            SECONDS.found(round(rests - begin, 1), "until the readings rest"),
            FASTEST.found(round(fastest, 0), "between readings 0.15 s apart"),
            STRAIGHT.found(seen == "y", "the operator saw it"),
        ]
        if seen == "y":  # whether it recentered or was there already
            facts.append(YAW.found(round(yaw, 1), "the reading while the operator saw it so", within=NEAR))
        else:
            facts.append(YAW.not_seen("it did not look straight ahead"))
        yield from home(bench)
        return facts
