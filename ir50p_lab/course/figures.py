"""The picture of the README: the arm in a working pose, with the frames of its joints.

`python -m ir50p_lab.course.figures docs/arm.png` draws it.
"""

import sys

from ir50p_lab.course.arm3d import ArmView
from ir50p_lab.course.style import new_figure


def readme_picture():
    """The arm of the book in a working pose, with the frames of its joints: LabFigure."""
    import numpy as np

    from ir50p_lab.modelling import IR50P, forward_kinematics

    figure, arm = new_figure(8.0, 5.4, projection="3d"), IR50P
    view = ArmView(figure.axes[0], arm, frames=True)
    s = np.linspace(0.0, 1.0, 200)
    path = np.column_stack([-1.5 + 1.3 * s, 1.25 + 0.25 * np.sin(9 * s), -1.5 + 0.35 * np.cos(6 * s)])
    view.trail(forward_kinematics(arm, path))
    view.update(path[-1])
    lengths = ", ".join(f"{1000 * length:.0f}" for length in arm.l)
    figure.axes[0].set_title(f"The {arm.name} arm: drawing of the model, links {lengths} mm, path of the tip")
    return figure


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit("usage: python -m ir50p_lab.course.figures FILE.png")
    readme_picture().savefig(sys.argv[1], dpi=150)
