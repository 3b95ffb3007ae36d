"""From a device's controls to what an operator asks for: a mapping, laid over the device that is plugged in.

Several controls may move one axis (two triggers, one each way): their deflections add up. Exchanging two axes is
exchanging their names in the mapping.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from teleop.config.inputs_section import DIRECTIONS, ControlSection
from teleop.core.operator_input import Held
from teleop.inputs.hid.controls import Button, ControlReader, ControlValues, Lever, Stick, Wheel
from teleop.inputs.hid.pads import stops
from teleop.inputs.hid.pairs import PAIRS, Pair
from teleop.inputs.hid.state import Change, Sample


class Mapped:
    """A mapping on one device, from its plugging in to its unplugging.

    `relative` are the controls that the descriptor calls so, `dead_zone` and `expo` those of controls without their
    own. `guessed`: no profile has this mapping, so that what does not rest in its middle is locked until it does.
    `centers` are those known from before an unplugging; `puck`: it is a multi-axis controller, which rests at 0.
    `names` are the controls that it needs, `stops` those that are a STOP, `watched` those whose every change counts,
    `counting` whether those that the descriptor describes wrongly report counts. Where `each` is a dict, it has what
    each control asked for at the last look.
    """

    def __init__(
        self,
        controls: Mapping[str, ControlSection],
        enable: str | None = None,
        relative: Collection[str] = (),
        dead_zone: float = 0.0,
        expo: float = 0.0,
        guessed: bool = False,
        centers: Mapping[str, float] | None = None,
        puck: bool = False,
    ) -> None:
        flat = _flat(controls)
        self.each: dict[str, ControlValues] | None = None
        self._enable, self._guessed = enable, guessed
        self._fine = {name: section.fine_button for name, section in flat.items()}
        self._sticks = {
            name: Stick(section, dead_zone, expo, guessed, (centers or {}).get(name), puck)
            for name, section in flat.items()
            if _is_stick(section, name in relative)
        }
        others = {
            name: _reader(section, name in relative) for name, section in flat.items() if name not in self._sticks
        }
        pairs = [[self._sticks[name] for name in pair if name in self._sticks] for pair in PAIRS if guessed]
        self._pairs = [Pair(sticks) for sticks in pairs if sticks]
        self.stops = frozenset(name for name, section in flat.items() if stops(section))
        self._readers: Mapping[str, ControlReader] = {**self._sticks, **others}
        buttons = {name for name in (enable, *self._fine.values()) if name}
        self.names = frozenset(self._readers) | buttons
        self.watched = frozenset(name for name, reader in others.items() if not isinstance(reader, Lever))
        self.counting = {
            name: section.value_type == "relative" for name, section in flat.items() if section.value_type is not None
        }

    @property
    def finding(self) -> bool:
        """Whether the center of some stick is still being found."""
        return any(stick.finding for stick in self._sticks.values())

    @property
    def uncentered(self) -> Collection[str]:
        """Sticks that were not in their middle when first seen."""
        return [name for name, stick in self._sticks.items() if stick.uncentered]

    @property
    def is_inside(self) -> bool:
        """Whether a stick is deflected, and not to the end of its range."""
        return any(stick.is_inside for stick in self._sticks.values())

    @property
    def deflected(self) -> Collection[str]:
        """The sticks that are not at rest."""
        return [name for name, stick in self._sticks.items() if stick.is_deflected]

    @property
    def is_unrested(self) -> bool:
        """Whether a stick is deflected that was never seen at rest: its first report may come after the others'."""
        return any(stick.is_unrested for stick in self._sticks.values())

    @property
    def centers(self) -> Mapping[str, float]:
        """The centers that were learned."""
        known = {name: stick.center for name, stick in self._sticks.items()}
        return {name: of.value for name, of in known.items() if of and of.learned and of.value is not None}

    def read(self, values: Mapping[str, Sample], changes: Iterable[Change], now: float) -> Held:
        """What the controls ask for at `now`; of a control that has not reported, or has no value, nothing."""
        read = ControlValues()
        changed: dict[str, list[Change]] = {}
        for change in changes:
            changed.setdefault(change.name, []).append(change)
        for name, reader in self._readers.items():
            if (sample := values.get(name)) is not None:
                fine = _pressed(values, self._fine[name])
                own = read if self.each is None else ControlValues()
                reader.read(sample, changed.get(name, ()), now, fine, own)
                if self.each is not None:
                    self.each[name] = own
                    read.add(own)
        for pair in self._pairs:
            pair.see(now)
        if values:
            for stick in self._sticks.values():
                stick.expect()
        enabled = None if self._enable is None else _pressed(values, self._enable)
        return Held(
            read.deflections,
            read.steps,
            read.dial,
            read.presses,
            enabled,
            positions=read.positions,
            click=read.click,
            deflected=read.deflected,
        )


def _pressed(values: Mapping[str, Sample], name: str | None) -> bool:
    return name is not None and name in values and values[name].pressed


def _flat(controls: Mapping[str, ControlSection]) -> dict[str, ControlSection]:
    """The mapping with the directions of hats as the buttons that they are."""
    flat: dict[str, ControlSection] = {}
    for name, section in controls.items():
        directions = {key: getattr(section, key) for key in DIRECTIONS}
        if not any(directions.values()):
            flat[name] = section
        for key, action in directions.items():
            if action is not None:
                flat[f"{name} {key}"] = ControlSection(**action.model_dump())
    return flat


def _reads(section: ControlSection, relative: bool) -> str:
    return section.value_type or ("relative" if relative else "absolute")


def _is_stick(section: ControlSection, relative: bool) -> bool:
    return not section.press and section.by != "position" and _reads(section, relative) == "absolute"


def _reader(section: ControlSection, relative: bool) -> ControlReader:
    if section.press:
        return Button(section)
    if _reads(section, relative) == "absolute":
        return Lever(section)
    return Wheel(section, counter=_reads(section, relative) == "counter")
