"""The figure of a replay in notebook 11: what other gains would send for the same angles."""

from ir50p_lab.course.draw.style import COLOURS, origin, subplots


def replay_figure(recording, replayed):
    """Draw what was sent to joint 1 then, and what other gains would send for the same angles. Returns: LabFigure.

    Args: recording: Recording, with u; replayed: Recording of a ReplayBench.
    """
    figure, above, below = subplots(9.0, 3.8, rows=2, sharex=True, note=f"recorded: {origin(recording)}")
    above.plot(recording.t, recording.q[:, 0], color=COLOURS["dark"])
    above.set(ylabel="angle [rad]", title="Joint 1: the angles are past, the commands are new")
    for run, colour, label in ((replayed, "orange", "would be sent now"), (recording, "blue", "sent then")):
        below.plot(run.t, run.u[:, 0], color=COLOURS[colour], drawstyle="steps-post", lw=1, label=label)
    below.set(xlabel="t [s]", ylabel="command [PWM counts]", ylim=(-275, 275))
    below.legend(fontsize=8)
    return figure
