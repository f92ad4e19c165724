from functools import partial

import numpy as np

import ir50p_lab.course.my_robot as my_robot
import ir50p_lab.course.unknown as views


def camera_at(K, corners, points):
    G = np.linalg.solve(my_robot.homography(corners, points[:, :2]) @ K, np.eye(3))
    G = G / np.linalg.norm(G[:, 0]) * np.sign(G[2, 2])
    R = np.column_stack([G[:, 0], G[:, 1], np.cross(G[:, 0], G[:, 1])])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R.T, -R.T @ G[:, 2]
    return T


def practise(bench, seed):
    path = views.PracticePath(bench, seed)
    gentle = my_robot.PID(kp=(350, 500, 400), ki=(150, 300, 250), kd=(40, 60, 40))
    for sample in bench.run(58):
        bench.drive(gentle.step(sample.t, sample.q, path(sample.t)))
    return bench.recording


def acted(u, delay):
    late = round(delay / 0.01)
    return np.concatenate([np.zeros((late, 3)), u[: len(u) - late]])


def both_ways(x):
    return my_robot.low_pass(my_robot.low_pass(x, 2, 100)[::-1], 2, 100)[::-1]


def fit_joint(Y, y, use):
    A = np.apply_along_axis(both_ways, 0, Y)[use]
    theta, _ = my_robot.least_squares(*views.with_a_pull(A, both_ways(y)[use]))
    return theta


def learn(bench, run):
    seen, u = views.motion(run, both_ways), acted(run.u, bench.delay)
    theta = np.zeros((3, 20))
    for joint, columns in enumerate(views.COLUMNS):
        Y = seen.Y[:, joint][:, columns]
        theta[joint, columns] = fit_joint(Y, u[:, joint], seen.moving[:, joint])
    return theta


def counts(theta, q, qd, qdd):  # (3,); the direction of friction without a jump at rest
    return np.sum(my_robot.regressor(q, qd, qdd, np.tanh(qd / 0.05)) * theta, axis=1)


def most_counts(theta, a, b, seconds):
    times = np.linspace(0, seconds, 15)
    pushes = [counts(theta, *my_robot.quintic(a, b, seconds, t)) for t in times]
    return np.max(np.abs(pushes))


def quickest(theta, a, b, most=200):
    for seconds in 0.4 * 1.15 ** np.arange(20):
        if most_counts(theta, a, b, seconds) < most:
            break
    return seconds


def when_it_acts(off, off_rate, plan_at, delay):
    plan = plan_at(delay)
    return plan[0] + off + delay * off_rate, plan[1] + off_rate, plan


def race(bench, theta, legs, meets, kp=25, kd=15):
    on_legs, rate = views.OnLegs(legs), views.Rate()
    for sample in bench.race():
        off = sample.q - on_legs(sample, 0)[0]
        q, qd, plan = meets(off, rate.of(off), partial(on_legs, sample), bench.delay)

        def model(q, qd, qdd, planned=plan[1]):
            return counts(theta, q, planned, qdd)

        bench.drive(my_robot.computed_torque(q, qd, plan, model, kp, kd))


def unknown_arm(bench):
    balls = views.find_balls(bench, camera_at)
    theta = learn(bench, practise(bench, 1))
    legs = views.plan(bench, balls, partial(quickest, theta, most=225))
    race(bench, theta, legs, when_it_acts)
