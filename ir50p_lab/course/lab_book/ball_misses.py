"""How near each notebook came to the ball, from the student's lab book."""

import numpy as np

from ir50p_lab.course.draw.style import COLOURS, SETPOINT, subplots
from ir50p_lab.course.lab_book import predictions

#: How a notebook goes to the ball, and the name under which the lab book has it: `ball.miss.NAME`, `ball.seconds.NAME`.
_WAYS = {
    "00  your hand": "by_hand",
    "00  one turn of the waist": "by_turn",
    "00  one push of the waist": "by_push",
    "01  three angles, guessed": "by_guess",
    "02  your formula": "by_formula",
    "07  your plan": "by_plan",
    "08  your controller": "by_pid",
    "10  your calibration": "by_ruler",
    "12  your model": "by_model",
    "15  your push, planned": "by_plan_and_pd",
    "18  a picture": "by_camera",
}


def so_far():
    """Plot how far each notebook missed the ball, and how long it took. Returns: LabFigure.

    The numbers are those of the student's lab book.

    What is not done yet has an empty row; a miss below 0.01 mm is drawn at 0.01.
    """
    book = predictions.read()["predictions"]
    figure, ax = subplots(7.5, 3.4)
    for row, name in enumerate(_WAYS.values()):
        miss, seconds = (book.get(f"ball.{what}.{name}", {}).get("truth") for what in ("miss", "seconds"))
        if miss is None:
            ax.annotate("not yet", (0.012, row), va="center", color=COLOURS["grey"])
            continue
        place = np.clip(miss, 0.01, 1000)
        ax.plot(place, row, "o", ms=9, color=COLOURS["orange"])
        said = f"{miss:.3g} mm" + (f", {seconds:.2g} s" if seconds else "")
        ax.annotate(said, (place, row), (9, 0), textcoords="offset points", va="center")
    ax.axvline(30, label="the ball's radius", **SETPOINT)
    ax.set(xscale="log", xlim=(0.007, 6000), ylim=(len(_WAYS) - 0.5, -0.5), xlabel="miss [mm]")
    ax.set_yticks(range(len(_WAYS)), _WAYS)
    ax.set_title("Missed: the ball at (0.42, −0.15, 0.03) m", loc="left")
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), frameon=False)
    return figure
