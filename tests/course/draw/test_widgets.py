"""Sliders: the picture follows, errors are seen, nothing queues up, the last value wins."""

import io
import threading
import time
import warnings
from types import SimpleNamespace

import ipywidgets
import numpy as np
import pytest
from PIL import Image

from ir50p_lab.course.draw import widgets
from ir50p_lab.course.draw.painter import Painter
from ir50p_lab.course.draw.style import new_figure
from ir50p_lab.course.draw.widgets import LivePanel, live, slider
from ir50p_lab.errors import InputError, UnstableLoopWarning


@pytest.fixture(autouse=True)
def no_other_panels():
    LivePanel.panels.clear()
    yield
    LivePanel.panels.clear()


def line_panel(update=None, **controls):
    """A panel with one line whose height is the slider's value."""
    figure = new_figure(3, 2)
    line = figure.axes[0].axhline(0.0)
    figure.axes[0].set_ylim(-10, 10)

    def move(height, **_):
        line.set_ydata([height, height])
        if update:
            return update(height)

    panel = live(figure, move, **({"height": (-10, 10, 0.5, 0.0)} | controls))
    panel.line = line
    return panel


def shown(panel):
    return np.asarray(Image.open(io.BytesIO(panel.image.value)))


def test_picture_follows_the_slider_and_equals_a_full_drawing():
    panel = line_panel()
    start = shown(panel)
    panel.controls["height"].value = 5.0  # what the browser does
    moved = shown(panel)
    assert (start != moved).any()
    full = Painter(panel.figure)
    np.testing.assert_array_equal(moved, full.rgba()[..., :3])
    panel.controls["height"].value = 0.0
    np.testing.assert_array_equal(shown(panel), start)


def test_values_reach_update_with_their_types():
    seen = []
    figure = new_figure(2, 2)
    panel = live(
        figure,
        lambda **values: seen.append(values),
        gain=(0.0, 1.0, 0.1, 0.5),
        count=(1, 5, 1, 2),
        shape=["square", "circle"],
        sign={"plus": 1, "minus": -1},
        numpy_scalar=slider(np.float64(0), np.float64(2), np.float64(0.25), np.float64(1)),
    )
    assert seen == [{"gain": 0.5, "count": 2, "shape": "square", "sign": 1, "numpy_scalar": 1.0}]
    assert [type(v) for v in seen[0].values()] == [float, int, str, int, float]
    panel.set(count=5, shape="circle", sign=-1)
    assert seen[1:] == [panel.values], "several controls, one update"
    assert panel.values | {"count": 5, "shape": "circle", "sign": -1} == panel.values


def test_rounding_noise_of_the_browser_is_removed_but_typed_numbers_are_kept():
    panel = line_panel(height=(0.0, 3.0, 0.01, 1.0))
    panel.controls["height"].value = 1.0599999999999998
    assert panel.values == {"height": 1.06}
    assert panel.drawn == {"height": 1.06}
    panel.controls["height"].value = 1.23456
    assert panel.values == {"height": 1.23456}


def test_label_is_the_text_beside_the_slider_and_unit_the_one_behind_it():
    panel = line_panel(height=slider(-1, 1, 0.1, 0, label="Kp1", unit="N m"))
    assert panel.controls["height"].description == "Kp1"
    row = panel.children[0].children[0]
    assert [child.value for child in row.children if isinstance(child, ipywidgets.Label)] == ["N m"]
    assert line_panel().controls["height"].description == "height"


def test_reset_puts_everything_back():
    panel = line_panel(extra=[1, 2, 3])
    start = shown(panel)
    panel.set(height=7, extra=3)
    button = panel.children[0].children[-1]
    button.click()
    assert panel.values == {"height": 0.0, "extra": 1}
    np.testing.assert_array_equal(shown(panel), start)


@pytest.mark.parametrize(
    ("controls", "words"),
    [
        ({}, "at least one control"),
        ({"a": (0, 1, 0.1)}, "give \\(min, max, step, start\\)"),
        ({"a": "text"}, "give \\(min, max, step, start\\)"),
        ({"a": []}, "give \\(min, max, step, start\\)"),
        ({"a": (1, 0, 0.1, 0.5)}, "min < max"),
        ({"a": (0, 1, 0, 0.5)}, "step > 0"),
        ({"a": (0, 1, 0.1, 2)}, "min <= start <= max"),
        ({"a": (0, float("nan"), 0.1, 0)}, "min < max"),
    ],
)
def test_controls_that_make_no_sense_are_refused(controls, words):
    with pytest.raises(InputError, match=words):
        live(new_figure(1, 1), lambda **_: None, **controls)


def test_set_refuses_unknown_names_and_values_off_the_scale():
    panel = line_panel()
    with pytest.raises(InputError, match=r"no control 'depth'; this panel has height"):
        panel.set(depth=1)
    with pytest.raises(InputError, match=r"height = 11 is off its slider \(-10.* to 10"):
        panel.set(height=11)
    assert panel.updates == 1


def too_high(height):
    if height > 4:
        raise ValueError(f"<{height}> is too high")


def test_an_error_in_the_first_update_belongs_to_the_cell():
    with pytest.raises(ValueError, match="too high"):
        line_panel(too_high, height=(0.0, 10.0, 0.5, 5.0))
    assert not list(LivePanel.panels)


def test_a_later_error_is_shown_and_the_panel_recovers():
    panel = line_panel(too_high)
    panel.controls["height"].value = 5.0  # a callback of the browser: must not raise
    assert "ValueError: &lt;5.0&gt; is too high" in panel.status.value
    assert "line " in panel.status.value and "move" in panel.status.value
    assert isinstance(panel.error, ValueError)
    panel.controls["height"].value = 3.0
    assert panel.status.value == "" and panel.error is None
    assert list(panel.line.get_ydata()) == [3.0, 3.0]


def test_set_raises_what_update_raises():
    panel = line_panel(too_high)
    with pytest.raises(ValueError, match="too high"):
        panel.set(height=8)
    panel.reset()
    assert panel.error is None


def test_prints_and_texts_of_update_appear_under_the_figure(capsys):
    panel = line_panel(lambda height: print(f"height {height} < 10\nsecond line") or "and a text")
    assert panel.status.value.startswith("height 0.0 &lt; 10"), "from the start, not only once a slider moves"
    panel.set(height=2)
    assert panel.status.value == "height 2.0 &lt; 10<br>second line<br>and a text"
    assert capsys.readouterr().out == "", "they would end in the log where nobody looks"


def test_an_error_in_the_words_is_shown_beside_the_new_picture():
    panel = line_panel(lambda height: height and (lambda: 1 / 0))
    before = panel.image.value
    panel.controls["height"].value = 5.0
    assert "ZeroDivisionError" in panel.status.value
    assert panel.image.value != before


def test_title_legend_label_and_frame_lie_below_what_moves():
    figure = new_figure(3, 2)
    figure.axes[0].set_title("stands still")
    label = figure.axes[0].text(0.5, 0.5, "stands still, too")
    (line,) = figure.axes[0].plot([0, 1], [0, 1], label="moves")
    legend = figure.axes[0].legend()
    panel = live(figure, lambda height: line.set_ydata([0, height]), height=(0, 10, 1, 1))
    assert legend.get_zorder() > 1.5  # the grid
    panel.set(height=5)
    assert line.get_animated()
    still = (legend, label, figure.axes[0].title, *figure.axes[0].spines.values())
    assert not any(part.get_animated() for part in still)


def test_the_warning_of_an_unstable_loop_appears_under_the_figure_once():
    def update(gain):
        for _ in range(3):
            if gain > 1:
                warnings.warn("joint 1 <swings>", UnstableLoopWarning, stacklevel=1)
        return f"gain {gain}"

    panel = live(new_figure(), update, gain=(0, 3, 1, 0))
    assert "swings" not in panel.status.value
    panel.set(gain=2)  # warnings are errors in these tests
    assert panel.status.value == "gain 2<br>joint 1 &lt;swings&gt;"


@pytest.mark.timing
def test_a_hundred_changes_from_threads_end_with_the_last_value_drawn():
    drawn = []
    panel = line_panel(lambda height: (time.sleep(0.004), drawn.append(height))[1])
    control = panel.controls["height"]

    def drag(numbers):
        for number in numbers:
            control.value = float(number) / 10
            time.sleep(0.001)

    threads = [threading.Thread(target=drag, args=(range(k, 100, 4),)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20)
        assert not thread.is_alive()
    assert drawn[-1] == panel.drawn["height"] == panel.values["height"]
    assert panel.line.get_ydata()[0] == drawn[-1]
    assert 1 < len(drawn) < 80, "what came in during a drawing was not queued"


def test_a_denser_display_gets_as_many_more_pixels():
    panel = line_panel()
    panel.image.set_state({"ratio": 2.0})
    assert shown(panel).shape == (400, 600, 3) and panel.image.layout.width == "300px"
    panel.set(height=5)
    full = Painter(panel.figure)
    np.testing.assert_array_equal(shown(panel), full.rgba()[..., :3])


def test_panel_shows_as_a_widget_and_as_a_picture_where_there_are_none():
    panel = line_panel()
    bundle = panel._repr_mimebundle_()
    data = bundle[0] if isinstance(bundle, tuple) else bundle
    assert data["application/vnd.jupyter.widget-view+json"]["model_id"] == panel.model_id
    assert data["image/png"].startswith("iVBORw0KGgo")


def test_running_a_cell_again_closes_its_old_panel(monkeypatch):
    run = {"metadata": {"cellId": "cell-a"}, "header": {"msg_id": "1"}}
    monkeypatch.setattr(widgets, "get_ipython", lambda: SimpleNamespace(get_parent=lambda: run), raising=False)
    first, beside = line_panel(), line_panel()
    assert set(LivePanel.panels) == {first, beside}, "two panels of one run live together"
    run["header"] = {"msg_id": "2"}
    again = line_panel()
    assert set(LivePanel.panels) == {again}
    assert first.comm is None and first.image.comm is None
    run["metadata"] = {"cellId": "cell-b"}
    other = line_panel()
    assert set(LivePanel.panels) == {again, other}
