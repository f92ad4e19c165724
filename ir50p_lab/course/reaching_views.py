"""Figures of notebook 11: loop and frames, the picture beside the arm, a way, a reach over time, the error budget."""

import numpy as np
from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch

from ir50p_lab.course.arm3d import ArmView, SideView, draw_frame
from ir50p_lab.course.bench_views import _stamped
from ir50p_lab.course.style import COLOURS, SETPOINT, new_figure
from ir50p_lab.modelling.chain import forward_kinematics, frames

_XYZ = (COLOURS["orange"], COLOURS["green"], COLOURS["blue"])
_RENDERED = "rendered picture, simulated arm"


def origin(simulated):
    """Where picture and arm are from, for the note in a figure."""
    return _RENDERED if simulated else "photograph, real arm"


def loop_figure():
    """What passes from picture to motor, box by box (Figure 4.14). Returns: LabFigure."""
    figure = new_figure(9.0, 2.2)
    (ax,) = figure.axes
    ax.set(xlim=(0, 6), ylim=(-0.05, 1.6), title="From the picture to the motors, and round again")
    ax.axis("off")
    boxes = (
        ("camera", "picture"),
        ("find_balls", "x, y [px]"),
        ("TablePlane", "X, Y [m]\non the table"),
        ("T_base_table", "p [m]\nin the base"),
        ("IK, plan", "q(t) [rad]"),
        ("controller", "u [PWM]"),
    )
    for k, (name, out) in enumerate(boxes):
        ax.add_patch(FancyBboxPatch((k + 0.12, 1.0), 0.76, 0.45, boxstyle="round,pad=0.04", fc="#EDF3F8", ec="#0072B2"))
        ax.text(k + 0.5, 1.22, name, ha="center", va="center", fontsize=9.5)
        ax.text(k + 0.5, 0.88, out, ha="center", va="top", fontsize=8, color=COLOURS["dark"])
        if k < 5:
            ax.add_patch(FancyArrowPatch((k + 0.9, 1.22), (k + 1.1, 1.22), arrowstyle="-|>", mutation_scale=10))
    style = {"arrowstyle": "-|>", "mutation_scale": 10, "connectionstyle": "arc,angleA=-90,angleB=-90,armA=25,armB=25"}
    ax.add_patch(FancyArrowPatch((5.5, 0.6), (0.5, 0.6), **style))
    again = {"ha": "center", "va": "top", "fontsize": 9, "color": COLOURS["dark"]}
    ax.text(3.0, 0.2, "the camera sees ball and hand: look again", **again)
    return figure


def frames_figure(arm, q, T_base_cam, ball=None, T_base_board=None, simulated=True):
    """The frames {0}, {c}, {ob} of Figures 4.15, 4.16 in 3-D, and the board, if its place is given. LabFigure."""
    figure = _stamped(origin(simulated), 8.0, 5.0, projection="3d")
    (ax,) = figure.axes
    _stage(ax, arm, q, T_base_cam)
    ax.view_init(elev=34, azim=-66)
    draw_frame(ax, np.eye(4), "{0}", 0.13)
    draw_frame(ax, T_base_cam, "{c}", 0.18)
    if T_base_board is not None:
        rim = 0.025 * np.array([[-1, -1], [9, -1], [9, 6], [-1, 6], [-1, -1]])  # of the board of 9x6 corners
        rim = np.column_stack([rim, np.zeros(5)]) @ T_base_board[:3, :3].T + T_base_board[:3, 3]
        ax.plot(*rim.T, color=COLOURS["grey"], linewidth=1.2)
        ax.text(*rim[1], "  board", fontsize=8, color=COLOURS["dark"])
    if ball is not None:
        T = np.eye(4)
        T[:3, 3] = ball
        draw_frame(ax, T, "{ob}", 0.1)
        ax.plot(*np.column_stack([T_base_cam[:3, 3], ball]), color=COLOURS["grey"], linewidth=1, linestyle=":")
    ax.set_title("Base {0}, camera {c}, ball {ob}: one transform takes the camera's numbers to the arm's")
    return figure


def _stage(ax, arm, q, T_base_cam):
    view = ArmView(ax, arm, q)
    eye = T_base_cam[:3, 3]
    reach = 1.15 * max(arm.reach, abs(eye[0]), abs(eye[1]))
    top = max(arm.l[0] + arm.reach, 1.15 * eye[2])
    ax.set(xlim=(-0.4, reach), ylim=(-0.6 * reach, 0.6 * reach), zlim=(0, top))
    ax.set_box_aspect((reach + 0.4, 1.2 * reach, top), zoom=1.25)
    ax.view_init(elev=24, azim=-58)
    view.update(q)
    return view


def seen_figure(seen, arm, q, T_base_cam, marker=None):
    """The picture with the ball found in it, beside the arm in 3-D with the ball where it must be. LabFigure.

    seen: Seen; marker: (2,) px of the marker on the hand, if found.
    """
    figure = _stamped(origin(seen.simulated), 9.5, 4.4, cols=2, projection=[None, "3d"], width_ratios=(1.25, 1))
    picture, space = figure.axes
    _picture(picture, seen.image)
    if seen:
        x, y, r = seen.ball.x, seen.ball.y, seen.ball.radius
        picture.add_patch(Circle((x, y), r, fill=False, ec=COLOURS["sky"], lw=2))
        picture.plot([x], [y], "+", color="white", ms=9, mew=1.5)
        p, s = 1e3 * seen.position, 1e3 * seen.stderr
        picture.set_title(f"Ball at ({x:.1f}, {y:.1f}) px, radius {r:.1f} px")
    if marker is not None:
        picture.plot(*marker, "s", mfc="none", mec=COLOURS["amber"], ms=12, mew=2)
    view = _stage(space, arm, q, T_base_cam)
    draw_frame(space, T_base_cam, "{c}", 0.15)
    if seen:
        view.target(seen.position)
        space.plot(*np.column_stack([T_base_cam[:3, 3], seen.position]), color=COLOURS["grey"], lw=1, ls=":")
        space.set_title(f"({p[0]:.0f}, {p[1]:.0f}, {p[2]:.0f}) mm, ± {s[0]:.1f}, {s[1]:.1f} mm")
    return figure


def pictures_figure(images, titles, simulated=True):
    """Pictures side by side. images: RGB; titles: one each. Returns: LabFigure."""
    figure = _stamped(origin(simulated), 9.5, 3.1, cols=len(images))
    for ax, image, title in zip(figure.axes, images, titles, strict=True):
        _picture(ax, image)
        ax.set_title(title, fontsize=10)
    return figure


def _picture(ax, image):
    ax.imshow(image)
    ax.grid(False)
    ax.set(xlabel="x [px]", ylabel="y [px]")


def height_figure(plane, arm, ball, xy):
    """For a slider: the line of sight from the side, and where it is read at a height. Returns: figure, update.

    plane: TablePlane; ball: (3,) m, where it is believed to be; xy: (2,) px.
    `update(height)` (m) moves the reading and returns a sentence.
    """
    figure = new_figure(7.5, 3.4)
    (ax,) = figure.axes
    eye = plane.centre
    away = (ball[:2] - eye[:2]) / np.linalg.norm(ball[:2] - eye[:2])
    slope = (eye[2] - ball[2]) / float((ball[:2] - eye[:2]) @ away)
    sight = np.array([-0.25, 0.06])
    ax.axhline(0, color=COLOURS["grey"], linewidth=2)
    ax.add_patch(Circle((0, 1e3 * ball[2]), 1e3 * ball[2], fc="#C8202D", ec="none", alpha=0.8))
    ax.plot(1e3 * sight, 1e3 * (ball[2] - slope * sight), color=COLOURS["dark"], linestyle=":")
    (level,) = ax.plot([-160, 80], [0, 0], **SETPOINT)
    (mark,) = ax.plot([], [], "X", color=COLOURS["purple"], ms=11, mec="white")
    ax.set(
        xlim=(-160, 80), ylim=(-12, 110), aspect="equal", xlabel="along the line of sight [mm]", ylabel="height [mm]"
    )

    def update(height_mm):
        place = plane.to_table(xy, height_mm / 1e3)
        off = 1e3 * float((place - ball[:2]) @ away)
        mark.set_data([off], [height_mm])
        level.set_ydata([height_mm, height_mm])
        ax.set_title(f"Read at height {height_mm:.0f} mm, the ball is {off:+.1f} mm off")
        return f"to_table(xy, height={height_mm / 1e3:.3f}) = ({1e3 * place[0]:.1f}, {1e3 * place[1]:.1f}) mm"

    return figure, update


def way_figure(way, ball=None, radius=0.03):
    """A Plan from the side: radius and height of the tip, ball and clearance. Returns: LabFigure."""
    figure = new_figure(9.0, 3.6, cols=2, width_ratios=(1.1, 1))
    side, over = figure.axes
    p = way.points
    view = SideView(side, way.arm, colour=COLOURS["blue"])
    view.update(way.goal)
    side.plot(np.hypot(p[:, 0], p[:, 1]), p[:, 2], color=COLOURS["green"], linewidth=2)
    if ball is not None:
        side.add_patch(Circle((np.hypot(*ball[:2]), ball[2]), radius, fc="#C8202D", ec="none"))
    side.set_title(f"Never below {100 * way.lowest:.0f} cm: over, then down")
    t = np.linspace(0, way.duration, 300)
    for k, colour in enumerate(_XYZ):
        over.plot(t, way.sample(t)[:, 1, k], color=colour, label=f"joint {k + 1}")
    over.set(xlabel="t [s]", ylabel="joint rate [rad/s]", title="Smooth: every piece from rest to rest")
    over.legend(fontsize=8)
    return figure


def tip_figure(arm, recording, done, simulated=True):
    """X, Y, Z of the tip over time, by potentiometers, with the goal dashed (Figure 4.20). Returns: LabFigure."""
    figure = _stamped(origin(simulated).split(", ")[1], 9.0, 4.6, rows=3, sharex=True)
    p = 1e3 * forward_kinematics(arm, recording.q)
    for ax, k, name, colour in zip(figure.axes, range(3), "XYZ", _XYZ, strict=True):
        ax.plot(recording.t, p[:, k], color=colour, linewidth=1)
        ax.axhline(1e3 * done.goal[k], **SETPOINT)
        ax.set_ylabel(f"{name} [mm]")
    figure.axes[0].set_title(
        f"The tip goes where the camera saw the ball; it stands {1e3 * done.miss:.1f} mm beside it"
    )
    figure.axes[-1].set_xlabel("t [s]")
    return figure


def budget_figure(budget, measured=()):
    """Causes of error as bars, after one look and after two; measured: rms mm of each as dashed lines. LabFigure."""
    figure = new_figure(9.0, 3.6)
    (ax,) = figure.axes
    names = [cause.name for cause in budget.causes] + ["all together"]
    first, second = ([1e3 * getattr(c, k) for c in budget.causes] for k in ("first", "second"))
    rows = np.arange(len(names))[::-1]
    total = [1e3 * value for value in budget.total]
    ax.barh(rows + 0.19, [*first, total[0]], 0.36, color=COLOURS["sky"], label="one look")
    ax.barh(rows - 0.19, [*second, total[1]], 0.36, color=COLOURS["blue"], label="two looks")
    for value in measured:
        ax.axvline(1e3 * value, **SETPOINT)
    ax.set_yticks(rows, names)
    ax.set(xlabel="rms at the tip [mm]", title=f"The second look takes {total[0]:.1f} mm down to {total[1]:.1f} mm")
    ax.legend(fontsize=8)
    return figure


def residual_figure(fit):
    """Loop errors of a HandEye, pose by pose. Returns: LabFigure."""
    figure = new_figure(9.0, 2.8, cols=2)
    for ax, values, unit in zip(
        figure.axes, (1e3 * fit.translation_error, 1e3 * fit.rotation_error), ("mm", "mrad"), strict=True
    ):
        ax.bar(np.arange(len(values)), values, color=COLOURS["blue"])
        ax.set(xlabel="pose [number]", ylabel=f"left over [{unit}]")
    figure.axes[0].set_title("The two ways round the loop differ by millimetres:")
    figure.axes[1].set_title("quantised potentiometers, taken as exact")
    return figure


def follow_figure(log, simulated=True):
    """The table from above: the ball as tracked and the tip after it. Returns: LabFigure."""
    figure = _stamped(origin(simulated), 9.0, 3.8, cols=2, width_ratios=(1, 1.3))
    above, time = figure.axes
    above.plot(*(1e3 * log.ball.T), color="#C8202D", label="ball, as seen")
    above.plot(*(1e3 * log.tip[:, :2].T), color=COLOURS["blue"], label="tip")
    above.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal", title="From above")
    above.legend(fontsize=8)
    off = 1e3 * np.linalg.norm(log.tip[:, :2] - log.ball, axis=1)
    time.plot(log.t, off, color=COLOURS["blue"])
    late = off[log.t > 0.5 * log.t[-1]]
    time.set(
        xlabel="t [s]", ylabel="tip beside the ball [mm]", title=f"Once there, it stays within {late.max():.0f} mm"
    )
    return figure


def poses_before(arm, camera, T_cam_base, T_tool_board, board, n, rng):
    """n joint poses (n, 3) rad that hold a board, its print to the camera, fully into the picture.

    camera: Calibration or Pinhole; T_tool_board: (4, 4); board: (m, 3) m; rng: numpy generator.
    """
    pinhole, kept = getattr(camera, "pinhole", camera), []
    low, high = (np.clip(limit, -np.pi, np.pi) for limit in (arm.q_min, arm.q_max))
    size = np.array(pinhole.size)
    for _ in range(20000):
        q = rng.uniform(low, high)
        T = T_cam_base @ frames(arm, q)[3] @ T_tool_board
        X = board @ T[:3, :3].T + T[:3, 3]
        if X[:, 2].min() < 0.25 or T[2, 2] < 0.3 or (np.abs(X[:, :2]) > X[:, 2:]).any():
            continue
        xy = pinhole.project(np.eye(4), X)
        if (xy > 5).all() and (xy < size - 6).all():
            kept.append(q)
        if len(kept) == n:
            break
    return np.array(kept)
