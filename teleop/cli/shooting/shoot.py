"""A timelapse as `teleop play` shoots it: a view of it, and a report at the end."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from teleop.app.beside import BesideRun
from teleop.app.shoot import ShootReport, ShootRun
from teleop.app.shoot_runner import Shooting
from teleop.cli.key_terminal import key_terminal
from teleop.cli.options import Options
from teleop.cli.running import EXIT_CODES, axes_facts, print_links, print_reasons, print_take
from teleop.cli.screens.folded import complain, tell, warn
from teleop.cli.screens.run_view import error_table
from teleop.cli.screens.shoot_view import ShootView, free
from teleop.cli.screens.take_summary import take_words
from teleop.cli.shooting.options import ShootOptions
from teleop.cli.shooting.timelapse_summary import clock, summary
from teleop.cli.signals import signals_to
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.core.interfaces import Clock
from teleop.core.run_state import Result
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.playback_keymap import BY_HAND_KEYS, RUN_KEYS, PlayKeys
from teleop.recording.writer import Recorder
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.troubles import troubles


def shoot(
    file: str,
    timelapse: Timelapse,
    profile: Profile,
    time: Clock,
    asked: ShootOptions,
    take: Path | None,
    options: Options,
    beside: BesideRun | None = None,
) -> int:
    """Shoot it on the rig, from the first frame or from where it stopped; the exit code."""
    virtual = isinstance(time, VirtualClock)
    descriptor = None if virtual else key_terminal()
    if asked.by_hand:
        _check_by_hand(file, timelapse, virtual, descriptor is not None)
    keys = None if descriptor is None else Keyboard(descriptor, PlayKeys(BY_HAND_KEYS if asked.by_hand else RUN_KEYS))

    def view(shooting: Shooting, journal: Path, recorder: Recorder | None) -> ShootView:
        folder, title = journal.absolute().parent, timelapse.title
        words, keyed = take_words(recorder), keys is not None
        return ShootView(title, timelapse.limits, folder, shooting.progress, options.json, keyed, words, shooting.shown)

    def begun(journal: Path) -> None:
        if not options.json:
            complain(f"{summary(timelapse, asked.by_hand)}; journal {journal}")

    choices = (asked.resume, asked.restart, asked.in_doubt)
    run = ShootRun(file, timelapse, profile, time, keys, *choices, take, virtual, asked.by_hand, beside)
    report = run.perform(view, signals_to, begun, warn)
    if options.json:
        print(json.dumps({**_facts(report), **({} if report.take is None else {"take": report.take.facts})}))
    else:
        _print(report)
        print_links(report.shooting.links)
        print_take(report.take)
    return EXIT_CODES[report.ended.result]


def _check_by_hand(file: str, timelapse: Timelapse, virtual: bool, has_keys: bool) -> None:
    """Raises UsageError, or DocumentError for what the file says, where no operator can shoot it frame by frame."""
    if timelapse.continuous:
        raise DocumentError([f"--by-hand: {file} has mode: continuous; leave it out"])
    if virtual:
        raise UsageError("--by-hand: an operator works in real time; leave out --fast")
    if not has_keys:
        raise UsageError("--by-hand needs a terminal, for its keys")


def _print(report: ShootReport) -> None:
    progress, journal = report.shooting.progress, report.journal
    print_reasons(report.ended.reasons)
    if report.tracking.scores:
        error_table(report.tracking)
    clip = f", {progress.clip:.2f} s of clip" if progress.clip is not None else ""
    print(f"{progress.shot} of {progress.slots.frames} frames shot{clip}")
    for line in troubles(progress):
        tell(line)
    if report.ended.result is not Result.DONE:
        if journal.in_doubt is not None:
            tell(f"Frame {journal.in_doubt} may be missing: the shoot stopped at its shutter.")
        left = clock(max(0.0, progress.slots.at(progress.slots.frames - 1) - progress.slots.at(journal.next)))
        if progress.by_hand:
            tell(f"Continue with --by-hand --resume: frame {journal.next} is next ({journal.path})")
            return
        tell(f"Continue with --resume: frame {journal.next} is next, {left} of shooting left ({journal.path})")


def _facts(report: ShootReport) -> Mapping[str, object]:
    ended, journal, progress = report.ended, report.journal, report.shooting.progress
    return {
        "result": ended.result.name.lower(),
        "reasons": list(ended.reasons),
        "seconds": round(report.tracking.seconds, 3),
        "frames": progress.slots.frames,
        "shot": progress.shot,
        "next": None if ended.result is Result.DONE else journal.next,
        "in_doubt": journal.in_doubt,
        "missed": progress.missed,
        "lost": progress.lost,
        "doubtful": progress.doubtful,
        "stopped": progress.stopped,
        "late": progress.late,
        "latest": round(progress.latest, 6),
        "refused": progress.refused,
        "unsettled": progress.unsettled,
        "clip": progress.clip,
        "journal": str(journal.path),
        "disk_free": free(journal.path.absolute().parent),
        "axes": axes_facts(report.tracking),
        "links": report.shooting.links,
    }
