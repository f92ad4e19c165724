"""Notebook 18: camera and law of a bench, the path of the arm, and the same reach on many copies of the arm."""

import contextlib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
from tqdm.auto import tqdm

from ir50p_lab.bench import SimulatedBench, fit_calibration
from ir50p_lab.bench.rest import rest_pose
from ir50p_lab.course import PictureView, my_robot
from ir50p_lab.course.camera.functions.pixel_to_plane import pixel_to_plane
from ir50p_lab.course.images.notebook_functions import edges_of, with_neighbours
from ir50p_lab.course.lab_book.data_file import data_file
from ir50p_lab.course.lab_book.results import load_result
from ir50p_lab.course.torque.bench_views import OnBench
from ir50p_lab.errors import InputError, NotMeasuredError, VisionError
from ir50p_lab.modelling import inverse_dynamics
from ir50p_lab.vision import BallLocator, RenderedBench, TablePlane, calibrate, load_image
from ir50p_lab.vision.board_pose import inverse_transform
from ir50p_lab.vision.rendering import pose

_SPEED = 12.25  # rad/s of the loop, gains of 150 and 24.5: stiff, so that a joint that breaks loose does not jump far
_QUARTER = 0.25  # of a full circle's votes: fingers cover a part of the ball between them
_POSES, _READINGS = 30, 50  # of a copy that is calibrated


def camera_for(bench):
    """Return the camera above a bench, a Calibration with T_base_cam: the student's of 17, else the course's.

    Raises NotMeasuredError if it is not known where the student's camera stands.
    """
    camera = load_result("camera", bench, course=_course_camera)
    if camera.T_base_cam is None:
        raise NotMeasuredError("your camera was kept without the place where it stands: run 'Keep it' of notebook 17")
    return camera


def _course_camera():
    """From nine pictures of the board, and one of the board at its place on the table."""
    files = sorted(data_file("calibration/flat").glob("board_*.jpg"))[:9]
    camera, board = calibrate(files, progress=False), load_image(data_file("calibration/table/board.jpg"))
    T_base_board = pose((0.32, 0.08, 0)) @ np.diag([1.0, -1, -1, 1])  # its z points into the table
    plane = TablePlane.from_picture(camera, board, T_table_board=T_base_board)
    return replace(camera, T_base_cam=inverse_transform(plane.T_cam_table))


def law_for(bench):
    """Return the law of 14 for a bench, with friction by the plan (15): the student's `computed_torque`.

    Its model is the student's of 13 if that was measured on this bench, else the drawing's.
    """
    model = load_result("model", bench, course=lambda: bench.arm)
    theta = model.theta_pwm if hasattr(model, "theta_pwm") else model.theta

    def counts(q, qd, qdd, direction):
        return inverse_dynamics(theta, q, qd, qdd)  # the planned speed has the direction

    def into(q, qd, plan):
        return q, plan[1], np.sign(plan[1])

    return OnBench(counts, into, _SPEED)


def path(start, goal, seconds=4):
    """Return the student's quintic from pose to pose, as Mover takes it. Raises VisionError if the goal is None."""
    if goal is None:
        raise VisionError("there is no pose to go to: no ball is seen, or the arm cannot go there; look at the picture")

    def sample(t):
        return np.array([my_robot.quintic(start, goal, seconds, one) for one in t])

    return SimpleNamespace(duration=seconds, sample=sample)


def seen_circle(mask, radii):
    """Return the pixel (column, row) of the best circle in a mask, by the student's `circle_votes`.

    Raises VisionError if none has a quarter of its votes.
    """
    points, inwards = edges_of(mask)
    votes = [with_neighbours(my_robot.circle_votes(points, inwards, r, mask.shape)) / (2 * np.pi * r) for r in radii]
    shares = np.max(votes, axis=0)
    if shares.max() < _QUARTER:
        raise VisionError(f"no circle is seen, the best has {shares.max():.0%} of its votes: is the ball covered?")
    row, column = np.unravel_index(np.argmax(shares), mask.shape)
    return column, row


def locator_for(watch, camera):
    """Return a BallLocator of the course that looks through `watch`.

    camera: its calibration, from pictures of any size.
    """
    pinhole = camera.pinhole.scaled(watch.size)
    return BallLocator(watch, TablePlane(pinhole, inverse_transform(camera.T_base_cam)))


def picture_with_ball(camera, place):
    """Return a picture (RGB); for a rendered one somebody lays the ball at `place` (3,) m first."""
    if isinstance(camera, RenderedBench):
        camera.lay(place)
    return camera.read().image


def follow_clicks(hand, watch, camera, eye):
    """Return a PictureView: a click lays the ball there, and `hand`, a LiveArm, goes where `eye(picture, q)` says.

    watch: what takes the pictures; camera: its calibration.
    """
    rest = np.array(hand.q)

    def clicked(x, y):
        view.picture = picture_with_ball(watch, pixel_to_plane(camera.K, camera.T_base_cam, (x, y), 0.03))
        q = eye(view.picture, rest)
        hand.q = list(rest if q is None else q)
        return "None" if q is None else f"q = {np.round(q, 2)} rad"

    view = PictureView(watch.read().image, clicked, alt="The bench from its camera; a click lays the ball there")
    return view


def true_tip(bench):
    """Return where the tip of a simulated arm truly is, (3,) m; nan for a real one."""
    return bench.plant.tip_true if bench.simulated and hasattr(bench, "plant") else np.full(3, np.nan)


def on_copies(reach_for, arm, copies, ball, *, calibrated=False, knocked=(0, 0, 0)):
    """Return what `reach_for(bench, camera)` returns on copies of the simulated arm: an array, one row per copy.

    copies: their numbers; ball: (3,) m; calibrated: with the potentiometers of each copy calibrated as in 10;
    knocked: (3,) degrees, by which its camera is turned about its own axes without anybody having noticed.
    """
    found = []
    for copy in tqdm(copies, leave=False):
        line = _calibration(SimulatedBench(arm, seed=copy, record_to=False).plant) if calibrated else None
        with SimulatedBench(arm, q0=rest_pose(arm), seed=copy, record_to=False, calibration=line) as bench:
            camera = RenderedBench(bench, ball)
            turned = pose((0, 0, 0), np.radians(knocked)) @ camera.scene.T_cam_world
            camera.scene = replace(camera.scene, T_cam_world=turned)
            found.append(reach_for(bench, camera))
    return np.array(found)


def _calibration(plant):
    """The lines of 10 for a copy: put into poses by hand, and read many times in each."""
    rng, q, counts = np.random.default_rng(18), [], []
    while len(q) < _POSES:
        place = rng.uniform(plant.arm.q_min, plant.arm.q_max)
        with contextlib.suppress(InputError):  # the table is in the way
            plant.place(place)
            q.append(place)
            counts.append(np.mean([plant.counts() for _ in range(_READINGS)], axis=0))
    return fit_calibration(q, counts, arm=plant.arm)
