"""Figures of notebook 18: the frames, the picture beside the arm, a reading at a height, balls that roll."""

import numpy as np
from matplotlib.patches import Circle

from ir50p_lab.course.draw.arm3d import ArmView, FrameView
from ir50p_lab.course.draw.pictures import show_picture
from ir50p_lab.course.draw.style import COLOURS, SETPOINT, new_figure, subplots

_ARRIVED = 1.5  # s after which a followed ball has been caught up with


def origin(simulated):
    """Where picture and arm are from, for the note in a figure."""
    return "rendered picture, simulated arm" if simulated else "photograph, real arm"


def frames_figure(arm, q, T_base_cam, ball, T_base_board, simulated):
    """The frames {0}, {c}, {ob} of Figures 4.15, 4.16 in 3-D, and the board of 9x6 corners. Returns: LabFigure."""
    figure, ax = subplots(8.0, 5.0, projection="3d", note=origin(simulated))
    _stage(ax, arm, q, T_base_cam)
    ax.view_init(elev=34, azim=-66)
    FrameView(ax, np.eye(4), "{0}", 0.13)
    FrameView(ax, T_base_cam, "{c}", 0.18)
    rim = 0.025 * np.array([[-1, -1, 0], [9, -1, 0], [9, 6, 0], [-1, 6, 0], [-1, -1, 0]])
    rim = rim @ T_base_board[:3, :3].T + T_base_board[:3, 3]
    ax.plot(*rim.T, color=COLOURS["grey"], linewidth=1.2)
    ax.text(*rim[1], "  board", fontsize=8, color=COLOURS["dark"])
    T_base_ball = np.eye(4)
    T_base_ball[:3, 3] = ball
    FrameView(ax, T_base_ball, "{ob}", 0.1)
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


def seen_figure(seen, arm, q, T_base_cam, marker=None):
    """The picture with the ball found in it, beside the arm in 3-D with the ball where it must be. LabFigure.

    seen: Seen; marker: (2,) px of the marker on the hand, if found.
    """
    figure = new_figure(9.5, 4.4, cols=2, projection=[None, "3d"], width_ratios=(1.25, 1), note=origin(seen.simulated))
    picture, space = figure.axes
    show_picture(picture, seen.image)
    picture.set(xlabel="x [px]", ylabel="y [px]")
    if marker is not None:
        picture.plot(*marker, "s", mfc="none", mec=COLOURS["amber"], ms=12, mew=2)
    _stage(space, arm, q, T_base_cam)
    FrameView(space, T_base_cam, "{c}", 0.15)
    if seen:
        x, y, r = seen.ball.x, seen.ball.y, seen.ball.radius
        picture.add_patch(Circle((x, y), r, fill=False, ec=COLOURS["sky"], lw=2))
        picture.plot(x, y, "+", color="white", ms=9, mew=1.5)
        picture.set_title(f"Ball at ({x:.1f}, {y:.1f}) px, radius {r:.1f} px")
        space.plot(*seen.position[:, None], "X", color=COLOURS["purple"], ms=10, mec="white", zorder=25)
        space.plot(*np.column_stack([T_base_cam[:3, 3], seen.position]), color=COLOURS["grey"], lw=1, ls=":")
        space.set_title("({:.0f}, {:.0f}, {:.0f}) mm".format(*(1e3 * seen.position)))
    return figure


def height_figure(plane, ball, xy):
    """For a slider: the line of sight from the side, and where it is read at a height. Returns: figure, update.

    plane: TablePlane; ball: (3,) m, where it is believed to be; xy: (2,) px.
    `update(height)` (m) moves the reading and returns a sentence.
    """
    figure, ax = subplots(7.5, 3.4)
    eye = plane.centre
    away = (ball[:2] - eye[:2]) / np.linalg.norm(ball[:2] - eye[:2])
    slope = (eye[2] - ball[2]) / float((ball[:2] - eye[:2]) @ away)
    ray = np.array([-0.25, 0.06])
    ax.axhline(0, color=COLOURS["grey"], linewidth=2)
    ax.add_patch(Circle((0, 1e3 * ball[2]), 1e3 * ball[2], fc="#C8202D", ec="none", alpha=0.8))
    ax.plot(1e3 * ray, 1e3 * (ball[2] - slope * ray), color=COLOURS["dark"], linestyle=":")
    (level,) = ax.plot([-160, 80], [0, 0], **SETPOINT)
    (mark,) = ax.plot([], [], "X", color=COLOURS["purple"], ms=11, mec="white")
    ax.set(xlim=(-160, 80), ylim=(-12, 110), aspect="equal")
    ax.set(xlabel="away from the camera, horizontally [mm]", ylabel="height [mm]")

    def update(height_mm):
        place = plane.to_table(xy, height_mm / 1e3)
        off = round(1e3 * float((place - ball[:2]) @ away), 3) + 0.0  # mm; rounding is no -0.0
        mark.set_data([off], [height_mm])
        level.set_ydata([height_mm, height_mm])
        ax.set_title(f"Read at height {height_mm:.0f} mm, the ball is {off:+.1f} mm off")
        return f"to_table(xy, height={height_mm / 1e3:.3f}) = ({1e3 * place[0]:.1f}, {1e3 * place[1]:.1f}) mm"

    return figure, update


def follow_figure(logs, simulated):
    """Followed balls: the table from above for the first FollowLog, how far each tip is ahead. Returns: LabFigure."""
    import pandas as pd

    figure, above, time = subplots(9.5, 4.0, cols=2, width_ratios=(1, 1.6), note=origin(simulated))
    above.plot(*(1e3 * logs[0].ball.T), color="#C8202D", label="ball, as seen")
    settled = logs[0].t > _ARRIVED
    above.plot(*(1e3 * logs[0].tip[settled, :2].T), ".", ms=2, color=COLOURS["blue"], label="tip")
    above.set(xlabel="x [mm]", ylabel="y [mm]", title=f"From above, lead {logs[0].lead:g} s")
    above.set_aspect("equal", adjustable="datalim")
    above.legend(fontsize=8)
    for log, colour in zip(logs, (COLOURS["blue"], COLOURS["orange"]), strict=True):
        settled = log.t > _ARRIVED
        t, ahead = log.t[settled], 1e3 * log.ahead[settled]
        time.plot(t, ahead, ".", ms=2, color=colour, alpha=0.35)
        smooth = pd.Series(ahead).rolling(31, center=True, min_periods=1).mean()
        time.plot(t, smooth, color=colour, lw=2, label=f"lead {log.lead:g} s")
        time.plot(t, 1e3 * log.lead * log.speed[settled], color=colour, lw=1.2, ls="--")
    time.plot([], [], color=COLOURS["dark"], lw=1.2, ls="--", label="lead × speed")
    time.axhline(0, color=COLOURS["dark"], lw=0.8)
    time.set(xlabel="t [s]", ylabel="tip before the ball [mm]", title="A lead puts the tip before the ball")
    time.legend(fontsize=8, loc="upper center", ncols=len(logs) + 1)
    low, high = time.get_ylim()
    time.set_ylim(low, high + 0.15 * (high - low))
    return figure
