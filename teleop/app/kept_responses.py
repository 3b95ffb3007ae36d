"""What a run takes from earlier runs of how its axes answer, and what it leaves for later ones.

A prior is chosen before the gimbal has answered for its version: the latest of its rig, kind of link, mode and payload.
Once the version is known, a prior of another one is dropped, for that of this version if there is one. At the end only
what is sure is kept, however the run ended; what no longer held, and was not found anew, is cleared.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field

from teleop.config.profile import Profile
from teleop.config.response_store import Kept, Key, ResponseStore, default_folder
from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis
from teleop.core.errors import TeleopError
from teleop.core.events import Tick
from teleop.core.response import Response
from teleop.devices.gimbal.version import VersionQuestion
from teleop.devices.rig import Rig
from teleop.links.url import parse


@dataclass(frozen=True)
class KeptReport:
    """The axes whose responses are `kept` for the next run, and a line about each that could not be.

    `delays` has the axes for which the profile's `delay` (s) counts instead, `watched` those that are sent positions:
    nothing goes by what was found of these.
    """

    kept: Sequence[Axis] = ()
    problems: Sequence[str] = ()
    delays: Mapping[Axis, float] = field(default_factory=dict)
    watched: Collection[Axis] = ()


class _Gimbal:
    """A gimbal's section of the profile: its key, and what is kept of its axes, for any version."""

    def __init__(self, profile: Profile, section: GimbalSection, kept: Sequence[Kept]) -> None:
        self.section = section
        self.axes = [axis for axis in section.axes if axis is not None and axis in profile.axes]
        kind = parse(profile.links[section.link]).kind
        self.key = Key(profile.name, "", kind, section.mode, section.payload)
        self._kept = [each for each in kept if each.axis in self.axes and each.key._replace(version="") == self.key]
        latest = max(self._kept, key=lambda each: each.found, default=None)
        self.version = latest.key.version if latest else ""  # of the priors
        self.settled = False

    @property
    def priors(self) -> dict[Axis, Response]:
        return {each.axis: each.response for each in self._kept if each.key.version == self.version}

    def settle(self, version: str) -> tuple[Mapping[Axis, Response | None], str]:
        """Take the gimbal's version. The priors that change, and a line about it where some are dropped."""
        self.settled, before, self.key = True, self.priors, self.key._replace(version=version)
        if version == self.version:
            return {}, ""
        was, self.version = self.version, version
        now = self.priors
        line = (
            f"{self.section.link}: {_named(version)}, but how {' and '.join(before)} answers was found with"
            f" {_named(was)}: dropped"
        )
        return {axis: now.get(axis) for axis in self.axes}, line if before else ""


class KeptResponses:
    """`priors` are for `open_rig`. Then `begin` with the open rig, `observe` each tick, and `finish`.

    `warn` gets a line about what cannot be read.
    """

    def __init__(self, profile: Profile, warn: Callable[[str], object]) -> None:
        self._gimbals: Sequence[_Gimbal] = ()
        self._store: ResponseStore | None = None
        self._questions: Mapping[str, VersionQuestion] = {}
        sections = [each for each in profile.sinks if isinstance(each, GimbalSection)]
        if not sections:
            return
        try:
            self._store = ResponseStore(default_folder())
        except TeleopError as error:
            warn(f"how the axes answer is not kept: {error}")
            return
        kept = self._store.read(profile.name)
        if self._store.damage:
            warn(self._store.damage)
        self._gimbals = [_Gimbal(profile, section, kept) for section in sections]

    @property
    def priors(self) -> Mapping[Axis, Response]:
        return {axis: prior for gimbal in self._gimbals for axis, prior in gimbal.priors.items()}

    def begin(self, rig: Rig, notify: Callable[[str], object]) -> None:
        """Watch this rig from now on; `notify` gets a line for what is dropped."""
        self._rig, self._notify = rig, notify
        links = [gimbal.section.link for gimbal in self._gimbals if gimbal.section.link in rig.connections]
        self._questions = {link: VersionQuestion(rig.connections[link]) for link in links}

    def observe(self, tick: Tick) -> None:
        for link, question in self._questions.items():
            question.ask(tick.time)
            if not question.over:
                continue
            for gimbal in self._gimbals:
                if gimbal.section.link == link and not gimbal.settled:
                    priors, line = gimbal.settle(question.version)
                    self._rig.suppose(priors)
                    if line:
                        self._notify(line)

    def finish(self) -> KeptReport:
        """Keep what is sure by now."""
        kept: list[Axis] = []
        problems: list[str] = []
        delays: dict[Axis, float] = {}
        found, changed = self._rig.responses, self._rig.changed
        for gimbal in self._gimbals:
            delays |= {axis: gimbal.section.delay for axis in gimbal.axes if gimbal.section.delay is not None}
            for axis in gimbal.axes:
                if axis in found or axis in changed:
                    self._keep(gimbal.key, axis, found.get(axis), kept, problems)
        watched = {axis for gimbal in self._gimbals if gimbal.section.mode == "position" for axis in gimbal.axes}
        return KeptReport(kept, problems, delays, watched)

    def _keep(self, key: Key, axis: Axis, response: Response | None, kept: list[Axis], problems: list[str]) -> None:
        assert self._store is not None
        try:
            if response is None:
                self._store.drop(key, axis)
            elif self._store.keep(key, axis, response):
                kept.append(axis)
        except TeleopError as error:
            problems.append(f"how {axis} answers is not kept: {error}")


def _named(version: str) -> str:
    return f"firmware {version}" if version else "firmware that does not give its version"
