"""What the notebooks share, in rooms: a room is one subject, and what two subjects need lies below them.

From below: `draw`, `lab_book`, `printed` (the thesis's equations), `robot` (what the student owns), `checking`;
on these stand `my_robot` and `live_arm`, and on all of them the subjects, from `start` to `reaching`.
"""

from ir50p_lab import home, lazy
from ir50p_lab.browser_tab import IN_BROWSER  # noqa: F401

home.check_folder()

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submodules=["my_robot"],
    submod_attrs={
        "checking.check": ["check", "reset"],
        "checking.numbers": ["solution"],
        "draw.arm3d": ["ArmView"],
        "draw.drawings": ["Drawing", "drawing"],
        "draw.picture_view": ["PictureView"],
        "draw.style": ["new_figure", "subplots"],
        "draw.traces": ["curves"],
        "draw.widgets": ["live", "slider"],
        "grading.judge": ["judged"],
        "lab_book.claims": ["ClaimError", "claim"],
        "lab_book.data_file": ["data_file"],
        "lab_book.predictions": ["helped_by", "keep", "measured", "note", "partners", "predict", "why"],
        "lab_book.results": ["arm_that_answers", "load_result", "results", "save_result"],
        "live_arm": ["LiveArm"],
        "live_arm.badge": ["badge_of"],
        "live_arm.step_through": ["step_through"],
        "loops.rehearse": ["RehearsalError", "rehearse"],
        "publishing.take_home": ["take_home"],
        "robot.arm_numbers": ["parts"],
        "unknown.hand_in": ["hand_in"],
    },
)
