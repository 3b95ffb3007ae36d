"""The options of `teleop play` for passes that learn, and their report at the end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.screens.folded import tell
from teleop.cli.staging_options import StagingOptions
from teleop.config.documents.document import DocumentError
from teleop.config.files import check_place
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from teleop.app.planning import Plan
    from teleop.config.profile import Profile
    from teleop.learning.correction import Correction, PassErrors
    from teleop.learning.pass_learner import PassLearner

LEAST_PASSES = 2


@Parameter(name="*")
@dataclass(frozen=True)
class LearnedOptions:
    """Passes that correct the next one, and what was learned before."""

    learn: Annotated[
        bool,
        Parameter(
            help="Correct each of the --passes by the error of those before it; keep the best in a file.",
            negative=(),
            show_default=False,
        ),
    ] = False
    learned: Annotated[
        Path | None,
        Parameter(metavar="FILE", help="Play with a correction that --learn has written.", show_default=False),
    ] = None

    @property
    def asked(self) -> str:
        """The option that was given, "" for none."""
        return "--learn" if self.learn else "--learned" if self.learned else ""

    def check(self, plan: Plan, speed: float, staging: StagingOptions, trimmed: bool) -> None:
        """Raises UsageError for what does not go together with them."""
        if not self.asked:
            return
        passes = 0 if staging.passes is None else staging.passes
        refused = [
            (plan.is_flown, "a drone's move is not measured: leave it out"),
            (speed != 1, "the speed of the passes is 100 %: leave out --speed"),
            (self.learn and staging.loop, "leave out --loop, and give --passes"),
            (self.learn and passes < LEAST_PASSES, "needs passes to learn from, as in --passes 3"),
            (self.learn and staging.start_at is not None, "a pass must be played whole: leave out --start-at"),
            (self.learn and trimmed, "a pass must be played as it is: leave out --trim"),
        ]
        for wrong, cure in refused:
            if wrong:
                raise UsageError(f"{self.asked}: {cure}")

    def file(self, move: str, take: Path | None) -> Path:
        """Where the correction is kept: beside the take, else in this folder under the move's name.

        Raises UsageError where it would replace another one than --learned, OutputError where none can be written.
        """
        from teleop.learning.correction_file import ENDING

        beside = Path(f"{Path(move).stem}{ENDING}") if take is None else take.with_suffix(ENDING)
        file = self.learned if self.learned is not None and take is None else beside
        if file.exists() and file != self.learned:
            raise UsageError(f"--learn: {file} already exists; go on from it with --learned {file}, or move it away")
        check_place(file)
        return file

    def known(self, plan: Plan, profile: Profile, share: float, as_json: bool) -> Correction | None:
        """What was learned before. Raises DocumentError, and with --json prints it."""
        if self.learned is None:
            return None
        import json

        from teleop.app.learning import learned
        from teleop.planner.offset_limits import sequence_limits

        try:
            return learned(self.learned, profile, plan.sequence, sequence_limits(profile.limits, share))
        except DocumentError as error:
            if as_json:
                print(json.dumps({"ok": False, "problems": error.problems}))
            raise


class LearningReport:
    """How well each pass was met, what was best, and where it is kept."""

    def __init__(self, learner: PassLearner, file: Path) -> None:
        self._learner, self._file = learner, file

    def facts(self) -> Iterator[tuple[str, object]]:
        passes = [
            {"pass": each.number, "ignored": each.ignored, "axes": _plain(each.errors)} for each in self._learner.passes
        ]
        best = {axis.value: {"pass": number, **_rounded(error)} for axis, (number, error) in self._learner.best.items()}
        file = str(self._file) if self._learner.saved else None
        yield "learning", {"passes": passes, "best": best, "file": file}

    def print(self) -> None:
        for axis, (number, error) in self._learner.best.items():
            tell(f"{axis}: the best is pass {number}, RMS {error.rms:.3f} deg, worst {error.worst:.3f} deg")
        found = self._learner.correction
        if found is not None and not found.offsets:
            tell(f"{self._file}: no correction was better than none")
        elif self._learner.saved:
            tell(f"{self._file}: the best correction; play with it: --learned {self._file}")
        else:
            tell("no pass has taught anything: no file is written")


def _plain(errors: PassErrors) -> dict[str, object]:
    return {axis.value: _rounded(error) for axis, error in errors.items()}


def _rounded(error: object) -> dict[str, float]:
    return {name: round(value, 6) for name, value in asdict(error).items()}  # type: ignore[call-overload] - an Error


NOT_LEARNED = LearnedOptions()
Notify = Callable[[str], object]
