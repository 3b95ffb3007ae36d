"""What the findings make of a profile: values by their places in it, each with how it was found."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from statistics import fmean
from typing import Any

from teleop.commission.findings import Findings
from teleop.config.documents.document import Location
from teleop.config.profile import Profile
from teleop.config.sinks_section import GimbalSection
from teleop.config.wiring import half_turn
from teleop.core.axes import Axis

MODES = "position", "speed", "stick"
ON_TIME = 0.005  # s: a latency below that is none
TURNED = 3.0  # deg of the yaw straight ahead that is a mount


@dataclass(frozen=True)
class Settings:
    """`values` by place; `notes` are how they were found, by the place above which the profile says so.

    `removed` are places of what is not there.
    """

    values: Mapping[Location, Any] = field(default_factory=dict)
    notes: Mapping[Location, Sequence[str]] = field(default_factory=dict)
    removed: Sequence[Location] = ()


def settings_of(findings: Findings, profile: Profile) -> Settings:
    """For the first gimbal of the profile."""
    index = next(i for i, section in enumerate(profile.sinks) if isinstance(section, GimbalSection))
    section = profile.sinks[index]
    assert isinstance(section, GimbalSection)
    maker = _Maker(findings, profile, section)
    here: Location = ("sinks", index)
    values = {(*here, key): value for key, value in maker.sink().items()} | maker.axes()
    notes: dict[Location, list[str]] = {here: list(maker.sink_notes()), ("axes",): list(maker.axis_notes())}
    removed = list(_absent(findings, profile))
    if removed:
        notes[here].append("no focus motor answered: its sink and its axis were taken out")
    if (pad := findings.value("pad.mapping")) and not profile.inputs:
        values["inputs",] = [{"pad": pad}]
        notes["inputs",] = [f"pad {pad}: {findings['pad.device'].how}"]
    return Settings(values, {place: lines for place, lines in notes.items() if lines}, removed)


def _absent(findings: Findings, profile: Profile) -> Iterator[Location]:
    """The focus motor, where none answered and nothing else in the profile moves it."""
    if findings.value("focus.present") is not False or _uses_focus(profile):
        return
    for index, section in enumerate(profile.sinks):
        if section.type == "focus":
            yield ("sinks", index)
            if Axis.FOCUS in profile.axes:
                yield ("axes", Axis.FOCUS.value)


def _uses_focus(profile: Profile) -> bool:
    controls = [control for entry in profile.inputs for control in entry.controls.values() if control is not None]
    return any(getattr(control, "axis", None) == Axis.FOCUS for control in controls)


class _Maker:
    """The values of one gimbal."""

    def __init__(self, findings: Findings, profile: Profile, section: GimbalSection) -> None:
        self._findings, self._profile, self._section = findings, profile, section
        self._names = [axis.value for axis in section.axes if axis is not None and axis in profile.limits]
        self._mode = self._best_mode()

    def sink(self) -> dict[str, Any]:
        made: dict[str, Any] = {}
        if self._mode != self._section.mode:
            made["mode"] = self._mode
        made |= self._signs()
        if (order := self._order()) != self._section.legacy_angles:
            made["legacy_angles"] = order
        if (mount := self._mount()) is not None:
            made["mount"] = {"yaw": mount}
        if (delay := self._delay()) is not None:
            made["delay"] = delay
        if self._mode == "stick" and (full := self._numbers("stick.full.")):
            made["full_stick"] = {**self._section.full_stick, **full}
        return made

    def axes(self) -> dict[Location, Any]:
        made: dict[Location, Any] = {}
        for name in self._names:
            for end in ("min", "max"):
                value = self._findings.value(f"soft.{end}.{name}")
                if isinstance(value, int | float):
                    made["axes", name, end] = int(value) if value == int(value) else value
            full, limits = self._findings.value(f"stick.full.{name}"), self._profile.limits[Axis(name)]
            if self._mode == "stick" and isinstance(full, int | float) and limits.velocity > full:
                made["axes", name, "velocity"] = math.floor(full)
        return made

    def sink_notes(self) -> Iterator[str]:
        of = self._findings
        version = of.value("gimbal.version")
        model = ", ".join(
            filter(None, [of.date, str(of.value("gimbal.model") or ""), f"firmware {version}" if version else ""])
        )
        lines = [*self._sign_notes(), *self._other_notes()]
        if lines:
            yield f"found by teleop commission ({model})" if model else "found by teleop commission"
            yield from lines

    def axis_notes(self) -> Iterator[str]:
        for place, value in self.axes().items():
            _, name, key = place
            fact = f"soft.{key}.{name}" if key != "velocity" else f"stick.full.{name}"
            yield f"{name}.{key} {value:g}: {self._findings[fact].how}"

    def _sign_notes(self) -> Iterator[str]:
        written = self._signs()
        for key, prefix in self._sign_keys().items():
            for name, value in self._numbers(prefix).items() if key in written else ():
                yield f"{key}.{name} {value:g}: {self._findings[f'{prefix}{name}'].how}"

    def _other_notes(self) -> Iterator[str]:
        of, made = self._findings, self.sink()
        if "mode" in made:
            obeyed = ", ".join(f"{mode} by {self._score(mode)}" for mode in MODES)
            yield f"mode {self._mode}: commands are obeyed as {obeyed} of {len(self._names)} axes"
        if of.value("reply.order") is not None:
            yield f"legacy_angles {self._order()}: {of['reply.order'].how}"
        if "mount" in made:
            yield f"mount.yaw {made['mount']['yaw']:g}: {of['recenter.yaw'].how}"
        if "delay" in made:
            yield f"delay {made['delay']:g}: mean latency of {', '.join(self._numbers('latency.'))}"
        for name, value in made.get("full_stick", {}).items():
            if f"stick.full.{name}" in {fact.key for fact in of.facts}:
                yield f"full_stick.{name} {value:g}: {of[f'stick.full.{name}'].how}"

    def _sign_keys(self) -> dict[str, str]:
        """The keys of the profile, and how the facts behind them begin."""
        return {
            "signs": "sign.position.",
            "speed_signs": "sign.stick." if self._mode == "stick" else "sign.speed.",
            "report_signs": "sign.report.",
        }

    def _signs(self) -> dict[str, Any]:
        section, made = self._section, dict[str, Any]()
        for key, prefix in self._sign_keys().items():
            if found := {name: int(sign) for name, sign in self._numbers(prefix).items()}:
                made[key] = {**getattr(section, key), **found}
        signs = made.get("signs", section.signs)
        reports = made.get("report_signs", {})
        if not section.report_signs and all(signs.get(name, 1) == sign for name, sign in reports.items()):
            made.pop("report_signs", None)
        return made

    def _order(self) -> str:
        order, section = self._findings.value("reply.order"), self._section
        if order is None:
            return section.legacy_angles
        if order == "yaw, roll, pitch":
            bare = self._findings.value("reply.command") is False
            known = section.legacy_angles
            exchanged = known == "all-yaw-pitch-roll" or (bare and known == "yaw-pitch-roll")
            return "yaw-roll-pitch" if exchanged else known
        return "yaw-pitch-roll" if self._findings.value("reply.command") is False else "all-yaw-pitch-roll"

    def _mount(self) -> float | None:
        """The yaw straight ahead, where it is another than the profile's."""
        yaw = self._findings.value("recenter.yaw")
        if not isinstance(yaw, int | float):
            return None
        off = half_turn(yaw - self._section.mount.yaw)
        if abs(off) <= TURNED:
            return None
        return 180.0 if abs(abs(yaw) - 180) <= TURNED else 0.0 if abs(yaw) <= TURNED else yaw

    def _delay(self) -> float | None:
        found = self._numbers("latency.")
        if self._mode != "position" or not found:
            return None
        late = round(fmean(found.values()), 3)
        known = self._section.delay or 0.0
        return min(late, 0.5) if late > ON_TIME or known else None

    def _numbers(self, prefix: str) -> dict[str, float]:
        """What was found of each axis."""
        found = {name: self._findings.value(f"{prefix}{name}") for name in self._names}
        return {name: value for name, value in found.items() if isinstance(value, int | float)}

    def _score(self, mode: str) -> int:
        return sum(self._findings.value(f"{mode}.obeyed.{name}") is True for name in self._names)

    def _best_mode(self) -> str:
        """That of the profile, unless another is obeyed by more axes."""
        mode = self._section.mode
        if all(self._findings.value(f"{mode}.obeyed.{name}") is None for name in self._names):
            return mode
        return max((mode, *MODES), key=self._score)
