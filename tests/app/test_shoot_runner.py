"""Shoots as the gimbal and its camera see them, on virtual time: hours in seconds."""

from __future__ import annotations

import itertools
import math
import time
from itertools import pairwise
from pathlib import Path

import kill_server
import pytest
from at_once import AtOnce
from shoot_bench import Keys, SlowBook, Stage, small_disk

from teleop.app import shoot_runner as shooting
from teleop.config.profile import ShootingSection, load_profile
from teleop.core.axes import Axis
from teleop.core.clock import SystemClock
from teleop.core.errors import UsageError
from teleop.core.events import Tick
from teleop.core.operator_input import Command as Key
from teleop.core.operator_input import Press
from teleop.core.run_state import Result
from teleop.core.timing import PERIOD
from teleop.dji.gimbal.camera import CameraCommand, Command
from teleop.timelapse.compile import load_timelapse
from teleop.timelapse.journal import FrameState, Note

PAUSE = Press(Key.PAUSE)
TICK = PERIOD + 1e-6
AWAKE = 1.25  # s: the position is said again a second after it was said last, on a tick of a loop that sleeps 0.4 s


@pytest.fixture
def stage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Stage:
    return Stage(tmp_path, monkeypatch)


def assert_on_time(stage: Stage) -> None:
    """Every frame once, in its slot and its place, at rest."""
    shots = stage.shots
    assert len(shots) == stage.timelapse.frames
    for frame, (shot, due) in enumerate(zip(shots, stage.due, strict=True)):
        assert -1e-6 <= shot.time - shots[0].time - due <= TICK, frame
        assert stage.off(shot, frame) < 0.06, frame
        assert shot.rate < 0.05, frame


def test_six_hours_are_on_time_to_the_tick(stage: Stage) -> None:
    stage.write(361, "{from: 20s, to: 100s}")
    assert stage.shoot().result is Result.DONE
    assert_on_time(stage)
    assert stage.shots[-1].time - stage.shots[0].time == pytest.approx(6 * 3600, abs=TICK)
    assert stage.silences() < AWAKE
    assert not any(stage.shooting.progress.troubles.values())


def test_still_frames_lead_in_and_out_after_a_delay(stage: Stage) -> None:
    stage.write(10, "2s", "  lead_in: 3\n  lead_out: 2\n  delay: 30m\n")
    began = stage.clock.now()
    stage.shoot()
    assert_on_time(stage)
    assert len(stage.shots) == 15
    assert stage.shots[0].time == pytest.approx(began + 1800, abs=0.1)
    assert len({round(shot.pan, 3) for shot in stage.shots[:4]}) == 1
    assert len({round(shot.pan, 3) for shot in stage.shots[-3:]}) == 1
    assert stage.silences() < AWAKE


def test_a_frame_is_focused_pressed_and_let_go_in_time(stage: Stage) -> None:
    stage.write(3, "3s", "  prefocus: 0.7s\n  post: 0.2s\n")
    stage.shoot()
    [told] = [
        [(time - stage.shots[0].time, message.command) for time, message in each.heard if isinstance(message, Command)]
        for each in stage.gimbals
    ]
    once = [
        (-0.7, CameraCommand.CENTER_FOCUS),
        (0.0, CameraCommand.SHUTTER),
        (0.2, CameraCommand.END_CENTER_FOCUS),
        (0.2, CameraCommand.STOP_SHUTTER),
    ]
    wanted = [(3 * frame + at, command) for frame in range(3) for at, command in once]
    assert [command for _, command in told] == [command for _, command in wanted]
    assert [at for at, _ in told] == pytest.approx([at for at, _ in wanted], abs=TICK)
    moving = [time for each in stage.gimbals for time, rate in each.turned if rate > 0.05]
    for shot in stage.shots:
        assert not [time for time in moving if shot.time - 0.7 <= time <= shot.time + 0.4], "it moves while it shoots"


def test_a_pause_holds_between_two_frames_for_hours_and_keeps_the_gimbal_awake(stage: Stage) -> None:
    stage.write(20, "4s")
    stage.keys = Keys()
    stage.keys.presses = [(1030.0, PAUSE), (1030.0 + 3600, PAUSE)]
    assert stage.shoot().result is Result.DONE
    shots = stage.shots
    assert len(shots) == 20
    gaps = [later.time - earlier.time for earlier, later in pairwise(shots)]
    [paused] = [gap for gap in gaps if gap > 5]
    assert paused == pytest.approx(3600, abs=8)
    assert [gap for gap in gaps if gap < 5] == pytest.approx([4.0] * 18, abs=TICK)
    assert all(stage.off(shot, frame) < 0.06 for frame, shot in enumerate(shots))
    assert stage.silences() < AWAKE
    assert stage.shooting.progress.missed == 0


STOP, CLEAR, GO = Press(Key.STOP), Press(Key.CLEAR), Press(Key.GO)


@pytest.mark.parametrize("later", [step / 10 for step in range(2, 41, 3)])
@pytest.mark.parametrize("mode", ["", "  prefocus: 0.3s\n", "  mode: continuous\n"])
def test_a_stop_at_any_moment_of_a_frame_loses_none_repeats_none_and_presses_no_shutter(
    stage: Stage, later: float, mode: str
) -> None:
    stage.write(12, "4s", mode)
    stage.executor = AtOnce()
    stage.keys = Keys()
    stopped, cleared = 1016.0 + later, 1116.0
    stage.keys.presses = [(stopped, STOP), (1050.0, PAUSE), (1060.0, GO), (cleared, CLEAR), (cleared + 10, GO)]
    assert stage.shoot().result is Result.DONE
    shots = stage.shots
    assert len(shots) == 12
    assert not [shot for shot in shots if stopped + 0.05 < shot.time < cleared + 10]
    moving = [time for each in stage.gimbals for time, rate in each.turned if rate > 0.05]
    assert not [time for time in moving if stopped + 1.5 < time < cleared + 10]
    for frame, shot in enumerate(shots):
        blurred = frame in stage.shooting.progress.stopped
        assert blurred or stage.off(shot, frame) < 0.2, frame
    assert len(stage.shooting.progress.stopped) <= ("continuous" in mode)
    assert not any(stage.shooting.progress.troubles.values())
    assert stage.silences() < AWAKE
    gaps = [after.time - before.time for before, after in pairwise(shots)]
    assert sum(gap > 4.1 for gap in gaps) == 1, "the rest keeps its rhythm"


def test_a_shoot_that_ends_while_it_is_stopped_says_so_and_can_be_gone_on_with(stage: Stage) -> None:
    stage.write(8, "2s")
    stage.keys = Keys()
    stage.keys.presses = [(1008.0, STOP), (1020.0, Press(Key.QUIT))]
    ended = stage.shoot()
    assert ended.result is Result.INTERRUPTED
    assert list(ended.reasons) == ["stopped by keys", "ended while stopped: STOP by keys"]
    stage.keys = None
    assert stage.shoot(resume=True).result is Result.DONE
    assert len(stage.shots) == 8


def test_a_stop_outlasts_a_link_that_is_lost_and_found_again(stage: Stage) -> None:
    stage.write(8, "2s")
    stage.profile = stage.profile.model_copy(update={"timelapse": ShootingSection(wait_for_link=True)})
    stage.keys = Keys()
    stage.keys.presses = [(1008.0, STOP), (1100.0, CLEAR), (1101.0, GO)]
    deaf = [(1020.0, 1030.0)]
    stage.prepare = lambda gimbal: setattr(gimbal, "deaf", lambda now: any(a < now < b for a, b in deaf))
    assert stage.shoot().result is Result.DONE
    assert len(stage.gimbals) > 1
    assert len(stage.shots) == 8
    assert not [shot for shot in stage.shots if 1008.1 < shot.time < 1101.0]


@pytest.mark.parametrize("interval", ["2s", "{from: 1s, to: 4s}"])
def test_a_continuous_move_is_shot_in_its_slots_and_places(stage: Stage, interval: str) -> None:
    stage.write(60, interval, "  mode: continuous\n  lead_in: 3\n")
    assert stage.shoot().result is Result.DONE
    shots = stage.shots
    assert len(shots) == 63
    for frame, (shot, due) in enumerate(zip(shots, stage.due, strict=True)):
        assert -1e-6 <= shot.time - shots[0].time - due <= TICK, frame
        assert stage.off(shot, frame) < 0.12, frame
    assert sum(shot.rate > 0.2 for shot in shots) > 40
    assert not any(stage.shooting.progress.troubles.values())


def test_a_continuous_move_is_paused_and_resumed_along_its_path(stage: Stage) -> None:
    stage.write(40, "1s", "  mode: continuous\n")
    stage.executor = AtOnce()
    stage.keys = Keys()
    stage.keys.presses = [(1020.0, PAUSE), (1620.0, PAUSE)]
    stopping_at(stage, 30, "wait")
    assert stage.shoot().result is Result.INTERRUPTED
    stage.keys = None
    assert stage.shoot(resume=True).result is Result.DONE
    assert len(stage.shots) == 40
    for frame, shot in enumerate(stage.shots):
        assert stage.off(shot, frame) < 0.2, frame
    gaps = [later.time - earlier.time for earlier, later in pairwise(stage.shots)]
    assert max(gaps) == pytest.approx(600, abs=3)
    assert stage.silences() < AWAKE


@pytest.mark.parametrize(
    ("trembling", "settled_after", "unsettled"),
    [
        pytest.param(0.0, (0.15, 0.35), 0, id="still at once"),
        pytest.param(1.0, (1.1, 1.35), 0, id="still after a second"),
        pytest.param(9.0, (1.5, 1.5 + PERIOD), 5, id="never still"),
    ],
)
def test_settling_is_measured(
    stage: Stage, trembling: float, settled_after: tuple[float, float], unsettled: int
) -> None:
    stage.write(5, "6s", "  settle: {below: 0.05, at_most: 1.5s}\n")
    stage.prepare = lambda each: setattr(
        each, "trembles", lambda since: 0.2 * math.sin(30 * since) if since < trembling else 0.0
    )
    began, took = [0.0], []

    def watch(tick: Tick) -> None:
        settling = stage.shooting.progress.phase == "settle"
        if not settling and began[0]:
            took.append(tick.time - began[0])
        began[0] = (began[0] or tick.time) if settling else 0.0

    stage.watch = watch
    stage.shoot()
    assert_on_time(stage)
    assert stage.shooting.progress.unsettled == unsettled
    assert len(took) == 5
    for seconds in took:
        assert settled_after[0] <= seconds + 1e-6
        assert seconds <= settled_after[1] + 2 * TICK


def stopping_at(stage: Stage, frame: int, phase: str) -> None:
    """Ctrl-C as soon as a frame is in a phase."""

    def watch(_tick: object) -> None:
        progress = stage.shooting.progress
        if progress.frame >= frame and progress.phase == phase:
            stage.shooting.interrupt("SIGINT received")
            stage.watch = lambda _tick: None

    stage.watch = watch


@pytest.mark.parametrize("phase", ["settle", "wait", "prefocus", "expose", "post", "move"])
def test_a_stopped_shoot_goes_on_at_the_exact_frame(stage: Stage, phase: str) -> None:
    stage.write(12, "3s", "  prefocus: 0.3s\n  post: 0.1s\n")
    stopping_at(stage, 5, phase)
    ended = stage.shoot()
    assert (ended.result, list(ended.reasons)) == (Result.INTERRUPTED, ["SIGINT received"])
    before = len(stage.shots)
    assert 5 <= before <= 7
    assert stage.shoot(resume=True).result is Result.DONE
    assert len(stage.shots) == 12
    assert all(stage.off(shot, frame) < 0.06 for frame, shot in enumerate(stage.shots))
    assert stage.said == [], "nothing is in doubt after a stop"
    gaps = [later.time - earlier.time for earlier, later in pairwise(stage.shots)]
    assert min(gaps) > 2


def test_a_resumed_shoot_comes_to_its_place_from_the_side_that_it_came_from(stage: Stage) -> None:
    stage.write(12, "2s")
    stopping_at(stage, 6, "wait")
    stage.shoot()
    stage.stands = (80.0, 0.0, 40.0)  # somebody has turned it by hand meanwhile
    stage.shoot(resume=True)
    place, first = stage.timelapse.path.at(6), stage.gimbals[-1].shots[0]
    coming = [(pan, tilt) for time, pan, tilt in stage.gimbals[-1].places if time < first.time]
    assert min(pan for pan, _ in coming) < place[Axis.PAN] - 0.8
    assert min(tilt for _, tilt in coming) < place[Axis.TILT] - 0.8
    last = [pan for pan, _ in coming[-60:]]
    assert all(pan <= place[Axis.PAN] + 0.05 for pan in last)


def test_a_silent_camera_stops_the_shoot_with_its_frame_in_doubt(stage: Stage) -> None:
    stage.write(8, "2s")
    stage.prepare = lambda gimbal: setattr(gimbal, "camera_says", lambda count: None if count == 3 else 0)
    ended = stage.shoot()
    assert ended.result is Result.FAILED
    assert ended.reasons[0] == "frame 3 may be missing: the camera did not answer"
    with stage.journal(resume=True) as journal:
        assert (journal.in_doubt, journal.next) == (3, 3)


@pytest.mark.parametrize(("in_doubt", "shots"), [("shoot", 8), ("skip", 7)])
def test_the_frame_in_doubt_is_named_and_shot_again_or_not(stage: Stage, in_doubt: str, shots: int) -> None:
    stage.write(8, "2s")
    stage.prepare = lambda gimbal: setattr(gimbal, "camera_says", lambda count: None if count == 3 else 0)
    stage.shoot()
    stage.prepare = lambda _gimbal: None
    assert stage.shoot(resume=True, in_doubt=in_doubt).result is Result.DONE
    assert len(stage.shots) == shots, "the press that nobody answered took no picture here"
    [said] = stage.said
    assert said.startswith("frame 3 may be missing")
    assert stage.shooting.progress.doubtful == ([3] if in_doubt == "skip" else [])


def test_a_refusing_camera_stops_the_shoot_and_nothing_is_in_doubt(stage: Stage) -> None:
    stage.write(8, "2s")
    stage.prepare = lambda gimbal: setattr(gimbal, "camera_says", lambda count: 2 if count == 3 else 0)
    ended = stage.shoot()
    assert ended.reasons[0] == "the camera refused to shoot frame 3 (return code 0x02)"
    stage.prepare = lambda _gimbal: None
    assert stage.shoot(resume=True).result is Result.DONE
    assert len(stage.shots) == 8
    assert stage.said == []


def test_a_camera_may_be_put_up_with(stage: Stage) -> None:
    stage.write(10, "2s", "  on_camera_fault: continue\n")
    stage.prepare = lambda gimbal: setattr(gimbal, "camera_says", lambda count: {3: 2, 6: None}.get(count, 0))
    assert stage.shoot().result is Result.DONE
    progress = stage.shooting.progress
    assert (progress.refused, progress.missed, progress.doubtful) == (1, 1, [5])
    assert len(stage.shots) == 9, "the refused frame in the next slot, the unanswered one not again"
    gaps = [round(later.time - earlier.time, 2) for earlier, later in pairwise(stage.shots)]
    assert sorted(gaps) == [2.0] * 6 + [4.0] * 2


def test_a_camera_that_never_shoots_is_given_up(stage: Stage) -> None:
    stage.write(30, "2s", "  on_camera_fault: continue\n")
    stage.prepare = lambda gimbal: setattr(gimbal, "camera_says", lambda _count: 2)
    ended = stage.shoot()
    assert (ended.result, stage.shooting.progress.refused) == (Result.FAILED, 10)


def test_a_slot_that_is_missed_is_counted_and_not_made_up(stage: Stage) -> None:
    stage.write(20, "2s")
    with stage.journal() as journal:
        slow = SlowBook(journal, stage, held={5: 5.0})
        ended = stage.shoot(slow)
    assert ended.result is Result.DONE
    gaps = [later.time - earlier.time for earlier, later in pairwise(stage.shots)]
    assert gaps == pytest.approx([2.0] * 4 + [8.0] + [2.0] * 14, abs=TICK), "on the old rhythm, no burst"
    assert stage.shooting.progress.missed == 3
    assert len(stage.shots) == 20


def test_a_slow_commit_makes_a_frame_late_and_no_other(stage: Stage) -> None:
    stage.write(10, "2s")
    with stage.journal() as journal:
        stage.shoot(SlowBook(journal, stage, held={5: 0.3}))
    gaps = [later.time - earlier.time for earlier, later in pairwise(stage.shots)]
    assert gaps == pytest.approx([2, 2, 2, 2, 2.2, 1.8, 2, 2, 2], abs=2 * TICK)
    assert (stage.shooting.progress.late, stage.shooting.progress.missed) == (1, 0)


def test_no_frame_is_shot_that_cannot_be_written_down(stage: Stage) -> None:
    stage.write(60, "1.1s")
    with small_disk(100_000), stage.journal() as journal:
        ended = stage.shoot(journal)
    assert ended.result is Result.FAILED
    assert "dusk.journal cannot be written: disk I/O error; frame " in ended.reasons[0]
    shot = len(stage.shots)
    assert 5 < shot < 20
    with stage.journal(resume=True) as journal:
        assert list(journal.frames.values()).count(FrameState.DONE) in (shot, shot - 1)
        doubt = journal.in_doubt
        assert journal.next in (shot, doubt)
    assert stage.shoot(resume=True).result is Result.DONE
    assert len(stage.shots) == 60 + (doubt is not None and doubt < shot)


def test_a_stalled_computer_is_no_reason_to_go_home(stage: Stage) -> None:
    stage.write(20, "2s")
    stage.watch = lambda tick: stage.clock.stall(7.0) if 1020 <= tick.time < 1020.5 else None
    assert stage.shoot().result is Result.DONE
    assert len(stage.shots) == 20 + sum("doubt" in said for said in stage.said)
    [said] = [said for said in stage.said if "stalled" in said]
    assert said.startswith("the computer stalled for 7.")
    gaps = [later.time - earlier.time for earlier, later in pairwise(stage.shots)]
    assert all(round(gap / 2, 2) % 1 == 0 for gap in gaps), "still on the old rhythm"
    assert stage.shooting.progress.missed > 0


@pytest.mark.parametrize("allowed", [True, False])
def test_a_lost_link_is_waited_for_where_the_profile_allows(stage: Stage, allowed: bool) -> None:
    stage.profile = stage.profile.model_copy(update={"timelapse": ShootingSection(wait_for_link=allowed)})
    stage.write(30, "2s")
    stage.prepare = lambda gimbal: setattr(gimbal, "deaf", lambda now: 1020.0 < now < 1050.0)
    ended = stage.shoot()
    if not allowed:
        assert ended.result is Result.FAILED
        assert "does not answer" in ended.reasons[0]
        stage.prepare = lambda _gimbal: None
        assert stage.shoot(resume=True).result is Result.DONE
    assert stage.shooting.progress.shot == 30
    assert len(stage.shots) == 30
    if allowed:
        assert ended.result is Result.DONE
        assert any("waiting for the link, then going on at frame" in said for said in stage.said)
        gaps = [later.time - earlier.time for earlier, later in pairwise(stage.shots)]
        assert all(round(gap / 2, 2) % 1 == 0 for gap in gaps)
        assert max(gaps) > 29


def test_signals_end_the_wait_for_a_link(stage: Stage) -> None:
    stage.profile = stage.profile.model_copy(update={"timelapse": ShootingSection(wait_for_link=True)})
    stage.write(30, "2s")
    stage.prepare = lambda gimbal: setattr(gimbal, "deaf", lambda now: now > 1020.0)
    stage.clock.hook = lambda now: stage.shooting.interrupt("SIGTERM received") if now > 1100 else None
    ended = stage.shoot()
    assert (ended.result, list(ended.reasons)) == (Result.INTERRUPTED, ["SIGTERM received"])


def test_the_wait_for_a_link_has_an_end(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    """A day in earnest; here a minute, of tries with a pause between them."""
    monkeypatch.setattr(shooting, "LONGEST_WAIT", 60.0)
    stage.profile = stage.profile.model_copy(update={"timelapse": ShootingSection(wait_for_link=True)})
    stage.write(30, "2s")
    stage.prepare = lambda gimbal: setattr(gimbal, "deaf", lambda now: now > 1020.0)
    ended = stage.shoot()
    assert ended.result is Result.FAILED
    assert 1020 + 60 < stage.clock.now() < 1020 + 60 * 3
    assert stage.shooting._runs <= 60 / shooting.RETRY + 2


def test_steps_of_the_wall_clock_move_no_frame(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    (stage.folder / "quick.yaml").write_text(kill_server.PROFILE.replace("virtual:quick", "sim:"))
    (stage.folder / "quick-shoot.yaml").write_text(kill_server.FILE)
    stage.profile = load_profile(str(stage.folder / "quick.yaml"))
    quick = load_timelapse(str(stage.folder / "quick-shoot.yaml"), stage.profile.limits, "the rig")
    assert quick is not None
    stage.timelapse, stage.clock = quick, SystemClock()
    wall, steps = time.time, itertools.cycle([0.0, 3600.0, -7200.0, 1e9])
    monkeypatch.setattr(time, "time", lambda: wall() + next(steps))
    assert stage.shoot(patient=False).result is Result.DONE
    assert len(stage.shots) == kill_server.FRAMES
    missed = stage.shooting.progress.missed
    took = stage.shots[-1].time - stage.shots[0].time
    assert took == pytest.approx((kill_server.FRAMES - 1 + missed) * 0.05, abs=0.05)


def test_q_ends_a_shoot_that_can_be_gone_on_with(stage: Stage) -> None:
    stage.write(8, "2s")
    stage.keys = Keys()
    stage.keys.presses = [(1008.0, Press(Key.QUIT))]
    ended = stage.shoot()
    assert (ended.result, list(ended.reasons)) == (Result.INTERRUPTED, ["q pressed"])
    assert 0 < len(stage.shots) < 8
    stage.keys = None
    assert stage.shoot(resume=True).result is Result.DONE
    assert len(stage.shots) == 8


def test_a_shoot_that_was_killed_after_its_last_frame_has_nothing_left_to_shoot(stage: Stage) -> None:
    stage.write(6, "2s")
    with stage.journal() as journal:
        for frame in range(6):
            journal.note(frame, FrameState.DONE)
    assert stage.shoot(resume=True).result is Result.DONE
    assert stage.shots == []
    assert stage.shooting.progress.shot == 6
    with pytest.raises(UsageError, match="is finished"), stage.journal(resume=True):
        pass


def test_a_last_frame_in_doubt_may_be_passed_over(stage: Stage) -> None:
    stage.write(6, "2s")
    stage.prepare = lambda gimbal: setattr(gimbal, "camera_says", lambda count: None if count == 5 else 0)
    assert stage.shoot().result is Result.FAILED
    assert stage.shoot(resume=True, in_doubt="skip").result is Result.DONE
    assert len(stage.shots) == 5
    assert stage.shooting.progress.doubtful == [5]


def test_an_end_that_cannot_be_written_down_is_no_lost_frame(stage: Stage) -> None:
    stage.write(6, "2s")
    with stage.journal() as journal:
        book = SlowBook(journal, stage, held={})

        def full() -> Note:
            journal.trouble = "dusk.journal cannot be written: full"
            return Note(None, FrameState.DONE)

        book.finish = full  # type: ignore[attr-defined]  # in front of the journal's own
        ended = stage.shoot(book)
    assert (ended.result, len(stage.shots)) == (Result.FAILED, 6)
    assert ended.reasons[0] == "dusk.journal cannot be written: full; the last frame is done all the same"
