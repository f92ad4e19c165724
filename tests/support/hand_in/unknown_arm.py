import numpy as np

import ir50p_lab.course.my_robot as my_robot
import ir50p_lab.course.unknown as views
from ir50p_lab.course.unknown.notebook_functions import acted, camera_at, fit_joint, most_counts, when_it_acts

GENTLE = {"kp": (350, 500, 400), "ki": (150, 300, 250), "kd": (40, 60, 40)}


def practise(bench, seed):
    way, pid = views.PracticeWay(bench, seed), my_robot.PID(**GENTLE)
    for sample in bench.run(58):
        bench.drive(pid.step(sample.t, sample.q, way(sample.t)))
    return bench.recording


def learn(bench, runs):
    parts = [views.motion(run) for run in runs]
    Y, use = (np.concatenate([getattr(part, name) for part in parts]) for name in ("Y", "moving"))
    u = np.concatenate([acted(run.u, bench.delay) for run in runs])
    theta = np.zeros((3, 20))
    for joint, columns in enumerate(views.COLUMNS):
        theta[joint, columns] = fit_joint(Y[:, joint][:, columns], u[:, joint], use[:, joint])
    return theta


def quickest(theta, a, b, most=200):
    for seconds in 0.4 * 1.15 ** np.arange(20):
        if most_counts(theta, a, b, seconds) < most:
            break
    return seconds


def race(bench, theta, legs, kp=25, ki=3, kd=15):
    on_legs, rate, total = views.OnLegs(legs), views.Rate(), np.zeros(3)
    for sample in bench.race():
        plan, ahead = on_legs(sample, 0), on_legs(sample, bench.delay)
        off, off_rate = sample.q - plan[0], rate.of(sample.q - plan[0])
        total = total + 0.01 * off
        off, off_rate = when_it_acts(off, off_rate, bench.delay)
        ahead[2] = ahead[2] - ki * total

        def model(q, qd, qdd, planned=ahead[1]):
            return np.sum(my_robot.regressor(q, planned, qdd, np.tanh(planned / 0.05)) * theta, axis=1)

        bench.drive(my_robot.computed_torque(ahead[0] + off, ahead[1] + off_rate, ahead, model, kp, kd))


def unknown_arm(bench):
    balls = views.find_balls(bench, camera_at)
    theta = learn(bench, [practise(bench, 1), practise(bench, 2)])
    legs = views.plan(bench, balls, lambda a, b: quickest(theta, a, b))
    race(bench, theta, legs)
