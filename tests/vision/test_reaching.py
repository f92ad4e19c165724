"""Reaching: plans that are clear and reachable, refusals as an oracle has them, looks that correct, balls carried."""

from dataclasses import replace
from functools import cache
from time import sleep

import cv2
import numpy as np
import pytest
from quick_locator import QuickLocator
from refusals import refused

from ir50p_lab.bench import SimulatedBench
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.errors import CalibrationError, CameraError, InputError, UnreachableError, VisionError
from ir50p_lab.modelling import IR50P, forward_kinematics, frames, inverse_kinematics
from ir50p_lab.vision import (
    BallLocator,
    Reacher,
    RenderedBench,
    TablePlane,
    camera_over,
    plan,
    reach,
    reach_pose,
)
from ir50p_lab.vision.reaching.budget import error_budget
from ir50p_lab.vision.reaching.reach_result import BallTracker
from tests.support.places import places_in, work_area
from tests.targets.vision_reaching import oracle_reaches
from tests.targets.vision_setup import calibrated

OVER = np.array([0.0, 0.0, 0.06])


def rig(ball=(0.40, 0.10, 0.03), seed=0, **options):
    bench = SimulatedBench(IR50P, seed=seed, q0=rest_pose(IR50P), record_to=False, calibration=calibrated(seed))
    world = RenderedBench(bench, ball, seed=seed)
    return (
        bench,
        world,
        QuickLocator(world, TablePlane(world.scene.pinhole, world.scene.T_cam_world), seed=seed, **options),
    )


# ---- where the arm can go


def test_refusals_are_those_of_an_independent_search():
    balls = places_in(work_area(IR50P), np.random.default_rng(1), 30) + OVER
    refused = 0
    for p in balls:
        try:
            q = reach_pose(IR50P, p)
        except UnreachableError:
            refused += 1
            assert not oracle_reaches(p, 60)
        else:
            assert oracle_reaches(p, 60)
            assert np.allclose(forward_kinematics(IR50P, q), p)
    assert 1 <= refused <= 10


@pytest.mark.parametrize(
    ("p", "why"),
    [
        ((0.70, 0.0, 0.09), "nearest point"),
        ((0.40, 0.0, -0.02), "under the table"),
        ((-0.40, 0.0, 0.09), "joint limit"),
        ((0.10, 0.0, 0.09), "joint limit"),
    ],
)
def test_a_refusal_says_why(p, why):
    refused(why, reach_pose, IR50P, p, error=UnreachableError)


def test_the_elbow_of_an_arm_with_a_short_column_stays_above_the_table():
    arm = replace(IR50P, l=(0.15, 0.200, 0.372), q_min=(-1.7, -1.7, -2.4), q_max=(1.7, 1.9, 2.4))
    place = (0.40, 0.0, 0.02)
    below = min(inverse_kinematics(arm, place).q, key=lambda q: np.sin(q[1]) + abs(q[0]))
    assert arm.l[0] + arm.l[1] * np.sin(below[1]) < 0, "else this proves nothing"
    q = reach_pose(arm, place, near=below)
    assert arm.l[0] + arm.l[1] * np.sin(q[1]) > 0


def test_plans_arrive_are_smooth_and_stay_clear():
    rng = np.random.default_rng(2)
    q = rest_pose(IR50P)
    for p in places_in(work_area(IR50P), rng, 15) + OVER:
        try:
            way = plan(IR50P, q, p)
        except UnreachableError:
            continue
        t = np.linspace(0, way.duration, 400)
        rows = way.sample(t)
        assert np.allclose(forward_kinematics(IR50P, rows[-1, 0]), p, atol=1e-9)
        assert np.allclose(rows[0, 0], q)
        heights = frames(IR50P, rows[:, 0])[:, 2:, 2, 3]
        assert heights.min() > p[2] - 1e-6
        assert np.abs(np.diff(rows[:, 0], axis=0)).max() < 0.7 * (t[1] - t[0])  # no jump: 0.5 rad/s, and the line
        tips = forward_kinematics(IR50P, rows[t > way.times[-2], 0])
        assert np.linalg.norm(tips[:, :2] - p[:2], axis=1).max() < 4e-3  # it comes from above
        q = np.array(way.points[-1])  # the next one from there, low over the table: it must go up first


def test_a_plan_takes_the_speed_that_it_is_given():
    q, p = rest_pose(IR50P), np.array([0.40, 0.1, 0.09])
    for speed in (0.25, 0.5):
        way = plan(IR50P, q, p, speed=speed)
        assert np.abs(way.sample(np.linspace(0, way.duration, 2000))[:, 1]).max() == pytest.approx(speed, rel=0.01)
    refused("speed", plan, IR50P, q, p, speed=0)


# ---- reaching


@cache
def misses(looks):
    found = []
    for seed in range(5):
        ball = places_in(work_area(IR50P), np.random.default_rng([seed, 3]), 40)
        ball = next(p for p in ball if oracle_reaches(p + OVER, 60) and np.hypot(*p[:2]) < 0.5)
        bench, world, locator = rig(ball, seed)
        with bench:
            done = reach(bench, locator, looks=looks, rest=False)
        found.append(np.linalg.norm(done.tip_true - world.balls_true[0] - OVER))
    return np.array(found)


def test_two_looks_put_the_true_tip_over_the_true_ball():
    two = misses(2)
    assert np.median(two) < 3e-3
    assert two.max() < 6e-3
    assert np.sqrt(np.mean(two**2)) < np.sqrt(np.mean(misses(1) ** 2))


def test_without_marker_or_ball_in_sight_the_reach_says_so_and_goes_on():
    bench, _, locator = rig()
    locator.blind = True
    with bench:
        done = reach(bench, locator, rest=False)
    assert "marker" in done.looks[0].note
    assert np.linalg.norm(done.tip_true - done.goal) < 0.012


def test_no_ball_or_one_out_of_reach_moves_nothing():
    bench, _, locator = rig()
    locator.no_ball = "nothing in the picture is red"
    with bench:
        refused("nothing in the picture is red", reach, bench, locator, rest=False, error=VisionError)
    bench, _, locator = rig((0.60, 0.1, 0.03))
    with bench:
        before = bench.plant.q_true
        refused("", reach, bench, locator, rest=False, error=UnreachableError)
        assert np.abs(bench.plant.q_true - before).max() < 0.05


def test_a_ball_that_rolls_out_of_reach_between_two_looks_does_not_let_the_arm_fall():
    bench, world, locator = rig((0.40, 0.1, 0.03))
    looks = []

    def look():
        if looks:
            world._lying[0] = 0.70, 0.1, 0.03
        looks.append(1)
        return type(locator).look(locator)

    locator.look = look
    with bench:
        done = reach(bench, locator, rest=False)
    assert "out of reach now" in done.looks[0].note and "moved by 300 mm" in done.looks[0].note
    assert np.linalg.norm(done.tip_true - [0.40, 0.1, 0.09]) < 6e-3 and done.miss > 0.25


def test_a_ball_that_cannot_be_gripped_is_not_reached_for():
    """Over it the arm reaches farther than down there."""
    bench, _, locator = rig((0.525, 0.0, 0.03))
    reach_pose(IR50P, np.array([0.525, 0.0, 0.09]))
    with bench, Reacher(bench, locator, rest=False) as reacher:
        before = bench.plant.q_true
        refused("", reacher.pick, error=UnreachableError)
        assert np.abs(bench.plant.q_true - before).max() < 0.05


def test_the_budget_is_what_reaching_measures():
    _, _, locator = rig()
    budget = error_budget(
        IR50P,
        locator,
        reach_pose(IR50P, [0.4, 0.1, 0.09]),
        sigma_q=0.5 / np.array([189, 122, 192.0]),
        slope=(189, 122, 192),
    )
    first, second = budget.loc["all together"]
    assert second < first
    measured = np.sqrt(np.mean(misses(2) ** 2))
    assert 0.5 < measured / second < 1.6
    assert second**2 == pytest.approx((budget["two looks"][:-1] ** 2).sum())


def test_a_ball_is_picked_seen_in_the_grip_and_put():
    bench, world, locator = rig((0.42, -0.12, 0.03), 3)
    with bench, Reacher(bench, locator) as reacher:
        found = reacher.pick()
        assert np.linalg.norm(found.ball - (0.42, -0.12, 0.03)) < 2e-3
        assert world.balls_true[0, 2] > 0.07
        refused("", reacher.put, (0.9, 0.0), error=UnreachableError)
        assert world.balls_true[0, 2] > 0.07
        reacher.put((0.36, 0.15))
        assert world.balls_true[0, 2] == 0.03
        assert np.linalg.norm(world.balls_true[0, :2] - (0.36, 0.15)) < 0.015
    assert np.abs(bench.plant.q_true - rest_pose(IR50P)).max() < 0.1


def followed(seconds=8.0, age=0.0, **options):
    """(log, time by which the tip is before the true ball, s): by potentiometers, least squares, without the first 2 s."""

    def rolling(t):
        return np.array([0.38 + 0.03 * np.cos(0.3 * t), 0.12 * np.sin(0.4 * t), 0.03])

    class Camera(QuickLocator):
        """Shows what was `age` s ago; the pictures of a camera that is late are no rendered ones."""

        def look(self):
            world._rolling = lambda t: rolling(t - age)
            seen = replace(super().look(), simulated=not age)
            world._rolling = rolling
            return seen

    bench, world, locator = rig(rolling)
    with bench, Reacher(bench, Camera(world, locator.plane), rest=False) as reacher:
        log = reacher.follow_ball(seconds, **options)
        end = world.t - 0.3  # it holds still for a while then
        assert np.linalg.norm(bench.plant.tip_true[:2] - rolling(end)[:2]) < 0.03
    late = log.t > 2
    t = log.t[late] - log.t[-1] + end
    ball, then = (np.array([rolling(one)[:2] for one in t + dt]) for dt in (0.0, 1e-3))
    velocity = (then - ball) / 1e-3
    return log, np.sum((log.tip[late, :2] - ball) * velocity) / np.sum(velocity**2)


def test_a_rolling_ball_is_followed_without_lag_by_default():
    """Pictures that are late: the lead allows for it. That rendered ones are not is the next test's."""
    log, early = followed(age=0.1)
    assert log.lead == pytest.approx(0.14)
    assert abs(early) < 0.03
    late = log.t > 2
    assert np.nanmax(np.linalg.norm(log.tip[late, :2] - log.ball[late], axis=1)) < 0.03


def test_a_lead_puts_the_tip_before_the_ball_by_lead_times_speed():
    log, early = followed(lead=0.25)
    assert log.lead == 0.25
    assert early == pytest.approx(0.25 - 0.04, abs=0.03)
    late = log.t > 2
    shown = np.sum((log.ahead * log.speed)[late]) / np.sum(log.speed[late] ** 2)
    assert shown == pytest.approx(early, abs=0.03)


def test_a_ball_that_is_lost_is_waited_for(capsys):
    """Half a second after the last look nothing is known of it: the arm stops there, and goes on when it is back."""
    bench, world, locator = rig(lambda t: np.array([0.38, -0.15 + 0.02 * t, 0.03]))
    with bench, Reacher(bench, locator, rest=False) as reacher:
        see, looks = locator.look, []

        def look():
            looks.append(world.t)
            gone = len(looks) > 1 and looks[1] + 4 < world.t < looks[1] + 8
            locator.no_ball = "it is covered" if gone else ""
            return see()

        locator.look = look
        log = reacher.follow_ball(11.0, progress=True)
    assert "following: " in capsys.readouterr().err
    lost = np.flatnonzero(np.isnan(log.ball[:, 0]))
    first, last = log.t[lost[[0, -1]]]
    assert (np.diff(lost) == 1).all()
    assert last - first == pytest.approx(4 - 0.5, abs=0.15)
    early, late = (log.tip[(log.t > last - s) & (log.t <= last - s + 1)].mean(axis=0) for s in (2, 1))
    assert np.linalg.norm(late - early) < 0.002  # it would be 20 mm
    assert np.linalg.norm(log.tip[-1, :2] - log.ball[-1]) < 0.02  # there again


def test_the_tracker_knows_where_a_ball_will_be():
    tracker, rng = BallTracker(), np.random.default_rng(0)
    assert np.isnan(tracker.at(1.0)).all()
    for t in np.arange(0, 4, 0.1):
        tracker.update(t, np.array([0.3 + 0.05 * t, 0.02 * t]) + rng.normal(0, 2e-4, 2))
    assert np.allclose(tracker.at(4.5), [0.3 + 0.05 * 4.5, 0.02 * 4.5], atol=3e-3)


# ---- pictures: detection in the loop, once


def test_the_rendered_camera_sees_ball_and_marker_where_they_are():
    bench, world, _ = rig((0.42, 0.08, 0.03))
    locator = BallLocator(world, TablePlane(world.scene.pinhole, world.scene.T_cam_world))
    seen = locator.look()
    assert seen.simulated
    assert np.linalg.norm(seen.position - world.balls_true[0]) < 1.5e-3
    q = reach_pose(IR50P, [0.42, 0.08, 0.09])
    bench.plant.place(q)
    again = locator.look()
    marker = locator.find_marker(again.image, IR50P, q + 0.005)
    expected = world.scene.pinhole.project(world.scene.T_cam_world, locator.marker_place(IR50P, q))
    assert np.linalg.norm(marker - expected) < 1.0
    e = locator.joint_errors(IR50P, q - [0.004, -0.003, 0.0], marker, [0.006, 0.006, 0.004])
    after = forward_kinematics(IR50P, q - [0.004, -0.003, 0.0] + e) - forward_kinematics(IR50P, q)
    assert np.linalg.norm(after) < 2.5e-3
    away, sigma = q + np.array([0.08, 0, 0]), [0.006, 0.006, 0.004]
    refused("potentiometers put it", locator.joint_errors, IR50P, away, marker, sigma, error=VisionError)


def test_a_picture_of_another_size_than_the_calibration_is_refused():
    _, world, _ = rig()
    small = TablePlane(world.scene.pinhole.scaled((320, 240)), world.scene.T_cam_world)
    refused("320x240, not 640x480", BallLocator(world, small).look, error=CalibrationError)


def test_a_camera_that_dies_cuts_the_drive():
    bench, _, locator = rig()

    def unplugged():
        raise CameraError("the camera was unplugged")

    locator.look = unplugged
    with pytest.raises(CameraError), bench:
        reach(bench, locator)
    assert (bench.command == 0).all()


class Real:
    """What a bench with a real arm says of itself."""

    simulated, name = False, "arm on a bench"


def test_a_real_arm_is_given_no_rendered_camera(monkeypatch):
    monkeypatch.setattr(cv2, "VideoCapture", lambda index: Nothing())
    monkeypatch.delenv("IR50P_CAMERA", raising=False)
    refused("webcam 0 gives no picture", camera_over, Real(), error=CameraError)


class Nothing:
    """A cv2.VideoCapture where none is plugged in."""

    set = release = lambda *_: None
    grab = isOpened = lambda self: False  # noqa: N815


def test_a_real_arm_does_not_reach_for_a_rendered_ball():
    bench, _, locator = rig()
    bench.simulated = bench.realtime = False
    refused("the picture is rendered", Reacher, bench, locator, error=CameraError)  # before the drive is on
    bench.simulated = True
    for task in (Reacher.reach, lambda reacher: reacher.follow_ball(1.0)):
        before = bench.plant.q_true
        with pytest.raises(CameraError, match="the picture is rendered"), bench, Reacher(bench, locator) as reacher:
            bench.simulated, bench.realtime = False, True  # the camera says nothing, its picture does
            task(reacher)
        bench.simulated, bench.realtime = True, False
        assert (bench.command == 0).all()
        assert np.abs(bench.plant.q_true - before).max() < 0.05


def test_a_simulated_arm_is_reached_for_without_a_thread(monkeypatch):
    """In a browser tab there are none."""
    bench, _, locator = rig()
    monkeypatch.setattr("concurrent.futures.ThreadPoolExecutor.submit", None)
    with bench, Reacher(bench, locator, rest=False) as reacher:
        assert reacher.look()


@pytest.mark.timing
def test_the_loop_goes_on_while_the_eye_looks():
    bench, _, locator = rig()
    bench.realtime, quick = True, locator.look

    def slow():
        sleep(0.15)
        return quick()

    locator.look = slow
    with bench, Reacher(bench, locator, rest=False) as reacher:
        before = reacher._last.t
        assert reacher.look()
        assert reacher._last.t - before > 0.05  # cycles went by meanwhile, each with a command
        bench.realtime = False


def test_a_locator_of_bad_numbers_is_refused():
    _, world, _ = rig()
    for change in ({"radius": 0}, {"T_base_table": np.eye(3)}, {"marker_at": (1, 2)}):
        plane = TablePlane(world.scene.pinhole, world.scene.T_cam_world)
        refused(next(iter(change)), BallLocator, world, plane, **change)


def test_bad_arguments_of_reaching_are_refused():
    bench, _, locator = rig()
    refused("three numbers", reach_pose, IR50P, np.zeros((2, 3)))
    refused("simulated arm", RenderedBench, object())
    with bench, Reacher(bench, locator, rest=False) as reacher, pytest.raises(InputError, match="looks"):
        reacher.reach(looks=0)
    for task, name in (
        (lambda r: r.reach(height="a"), "height"),
        (lambda r: r.put((0.3, 0.0, 0.1)), "place"),
        (lambda r: r.follow_ball(1.0, lead=np.nan), "lead"),
        (lambda r: r.follow_ball(0), "seconds"),
    ):
        with bench, Reacher(bench, locator, rest=False) as reacher, pytest.raises(InputError, match=name):
            task(reacher)
