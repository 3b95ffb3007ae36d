"""A timelapse as `teleop play` shoots it: its journal in this folder, a view of it, and a report at the end."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path

from teleop.app.shoot_runner import Ended, Shooting, camera_link
from teleop.cli.key_terminal import key_terminal
from teleop.cli.options import Options
from teleop.cli.running import EXIT_CODES, print_links, print_take, undisturbed
from teleop.cli.screens.folded import complain, tell
from teleop.cli.screens.run_view import error_table
from teleop.cli.screens.shoot_view import ShootView, free
from teleop.cli.screens.take_summary import take_words
from teleop.cli.shoot_options import ShootOptions
from teleop.cli.stop_inputs import open_stop_inputs
from teleop.cli.timelapse_summary import clock, summary
from teleop.config.profile import Profile
from teleop.core.clock import VirtualClock
from teleop.core.interfaces import Clock, Observer
from teleop.core.run_state import Result
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.playback_keymap import RUN_KEYS, PlayKeys
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.writer import recording
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.journal import ENDING, Journal, Shoot, open_journal


def shoot(
    file: str,
    timelapse: Timelapse,
    profile: Profile,
    time: Clock,
    asked: ShootOptions,
    take: Path | None,
    options: Options,
) -> int:
    """Shoot it on the rig, from the first frame or from where it was left; the exit code."""
    virtual = isinstance(time, VirtualClock)
    path = Path(Path(file).stem + ENDING)
    belongs = Shoot(Path(file).name, timelapse.identity, timelapse.frames)
    descriptor = None if virtual else key_terminal()
    camera_link(profile)  # refused before a journal is begun
    with ExitStack() as stack:
        journal = stack.enter_context(
            open_journal(path, belongs, resume=asked.resume, restart=asked.restart, patient=virtual)
        )
        recorder = stack.enter_context(
            recording(take, profile.name, timelapse.title, timelapse.limits, patient=virtual)
        )
        keys = None if descriptor is None else stack.enter_context(Keyboard(descriptor, PlayKeys(RUN_KEYS)))
        observers: list[Observer] = [each for each in (recorder, keys) if each is not None]
        shooting = Shooting(
            timelapse,
            profile,
            time,
            journal,
            lambda line: view.say(line),
            observers,
            keys,
            asked.in_doubt,
            inputs=[] if virtual else open_stop_inputs(stack, profile, time),
        )
        view = ShootView(
            timelapse.title,
            timelapse.limits,
            path.absolute().parent,
            shooting.progress,
            options.json,
            bool(keys),
            take_words(recorder),
            shooting.shown,
        )
        tally = TrackingErrorMonitor(lambda: shooting.begin)
        observers += [tally, view]
        if not options.json:
            complain(f"{summary(timelapse)}; journal {path}")
        with undisturbed(shooting.interrupt, shooting.release_at_once, view.say), view:
            ended = shooting.run()
        if recorder is not None:
            recorder.finish(ended.result, ended.reasons, shooting.links)
        journal.catch_up()
        if options.json:
            facts = {} if recorder is None else {"take": recorder.facts}
            print(json.dumps({**_report(ended, shooting, journal, tally), **facts}))
        else:
            _print(ended, shooting, journal, tally)
            print_links(shooting.links)
            print_take(recorder)
    return EXIT_CODES[ended.result]


def _print(ended: Ended, shooting: Shooting, journal: Journal, tally: TrackingErrorMonitor) -> None:
    progress = shooting.progress
    for reason in ended.reasons:
        complain(f"teleop: stopped: {reason}")
    if tally.scores:
        error_table(tally)
    clip = f", {progress.clip:.2f} s of clip" if progress.clip is not None else ""
    print(f"{progress.shot} of {progress.slots.frames} frames shot{clip}")
    for line in _troubles(shooting):
        tell(line)
    if ended.result is not Result.DONE:
        if journal.in_doubt is not None:
            tell(f"Frame {journal.in_doubt} is in doubt: its shutter was due just when the shoot stopped.")
        left = clock(max(0.0, progress.slots.at(progress.slots.frames - 1) - progress.slots.at(journal.next)))
        tell(f"--resume goes on at frame {journal.next}, with {left} of shooting left ({journal.path})")


def _troubles(shooting: Shooting) -> list[str]:
    """What did not go as it should, in lines."""
    progress, lines = shooting.progress, []
    if progress.missed:
        lines.append(f"{progress.missed} slots were missed")
    if progress.lost:
        lines.append(f"No picture of frames {_numbers(progress.lost)}")
    if progress.doubtful:
        lines.append(f"Frames {_numbers(progress.doubtful)} may be missing: nobody can say whether they were shot")
    if progress.stopped:
        lines.append(f"Frames {_numbers(progress.stopped)} were exposing when a STOP halted the axes: look at them")
    if progress.late:
        lines.append(f"{progress.late} frames were late, by {progress.latest:.2f} s at most")
    if progress.refused:
        lines.append(f"The camera refused {progress.refused} times")
    if progress.unsettled:
        lines.append(f"{progress.unsettled} frames were shot before the axes were measured to be still")
    return lines


def _numbers(frames: list[int]) -> str:
    shown = ", ".join(map(str, frames[:20]))
    return shown if len(frames) <= 20 else f"{shown} and {len(frames) - 20} more"


def _report(ended: Ended, shooting: Shooting, journal: Journal, tally: TrackingErrorMonitor) -> Mapping[str, object]:
    progress = shooting.progress
    return {
        "result": ended.result.name.lower(),
        "reasons": list(ended.reasons),
        "seconds": round(tally.seconds, 3),
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
        "axes": {
            axis.value: {"readings": score.readings, "rms": round(score.rms, 6), "peak": round(score.peak, 6)}
            for axis, score in tally.scores.items()
        },
        "links": shooting.links,
    }
