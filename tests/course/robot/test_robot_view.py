"""The picture of the robot names every function with its notebook, in the colour of whose it is."""

from matplotlib.colors import to_hex

from ir50p_lab.course.robot.catalogue import ORDER, notebook_of
from ir50p_lab.course.robot.robot_view import owned


def test_every_square_has_its_name_and_the_colour_of_its_owner():
    whose = dict.fromkeys(ORDER, "the course's") | {"rot_z": "yours", "reach": "on loan"}
    figure = owned(whose)
    (ax,) = figure.axes
    places = {text.get_text(): text.get_position() for text in ax.texts}
    squares = {line.get_xydata()[0].tobytes(): line for line in ax.lines if line.get_marker() == "s"}
    assert len(squares) == len(ORDER) == 31
    colours = {}
    for name in ORDER:
        x, y = places[f"{notebook_of(name)} {name}"]
        square = min(squares.values(), key=lambda line: abs(line.get_xdata()[0] - x) + abs(line.get_ydata()[0] - y))
        colours.setdefault(whose[name], set()).add(to_hex(square.get_color()))
    assert len(set.union(*colours.values())) == len(colours) == 3
    assert "1 of 31 functions are yours, 1 on loan" in ax.get_title()
