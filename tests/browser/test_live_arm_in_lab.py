"""LiveArm in JupyterLab: hand, keys and kernel together."""

import numpy as np
import pytest
from conftest import KERNEL_IDLE, RUN_ALL, open_in_lab

from ir50p_lab.modelling import IR50P, forward_kinematics

VIEW = "document.querySelectorAll('.la')[{}].liveArm"


@pytest.fixture(scope="module")
def notebook(browser, lab):
    """The demo page, run, with all its views."""
    context = browser.new_context(viewport={"width": 1300, "height": 1000})
    page = context.new_page()
    open_in_lab(page, lab)
    page.evaluate(RUN_ALL)
    page.wait_for_function("() => document.querySelectorAll('.la').length === 4", timeout=120_000)
    page.wait_for_function("() => [...document.querySelectorAll('.la')].every((box) => box.liveArm)")
    page.wait_for_function(KERNEL_IDLE, timeout=90_000)
    yield page
    context.close()


def show(page, number):
    page.locator(".la").nth(number).scroll_into_view_if_needed()
    page.wait_for_function(f"() => {VIEW.format(number)}.scene.seen && {VIEW.format(number)}.scene.width > 0")
    page.wait_for_timeout(300)


def pixels(page, number):
    return page.evaluate(f"() => {VIEW.format(number)}.canvas.toDataURL()")


def angles(page, number):
    return np.array(page.evaluate(f"() => {VIEW.format(number)}.q"))


def drag_tip(page, number, right, up, steps=8):
    """Drag the tip of a view by CSS pixels. Returns by how much the tip misses the pointer, and the note."""
    at = page.evaluate(f"() => {VIEW.format(number)}.scene.onPage({VIEW.format(number)}.scene.tipAt)")
    page.mouse.move(*at)
    page.mouse.down()
    for step in range(1, steps + 1):
        page.mouse.move(at[0] + right * step / steps, at[1] - up * step / steps)
        page.wait_for_timeout(60)
    for _ in range(100):  # a kernel beside other work answers late
        page.wait_for_timeout(400)
        there = page.evaluate(f"() => {VIEW.format(number)}.scene.onPage({VIEW.format(number)}.scene.tipAt)")
        missed = np.array(there) - (at[0] + right, at[1] - up)
        note = page.locator(".la-note").nth(number).text_content()
        if note or np.abs(missed).max() < 2:
            break
    page.mouse.up()
    return missed, note


def test_a_slider_moves_the_arm_by_key_and_lab_takes_none_away(notebook):
    show(notebook, 0)
    cell = notebook.evaluate("() => document.querySelectorAll('.jp-Cell.jp-mod-active')[0]?.id")
    before, picture = angles(notebook, 0), pixels(notebook, 0)
    slider = notebook.locator(".la").nth(0).get_by_label("joint 2 in degrees")
    slider.focus()
    for _ in range(5):
        notebook.keyboard.press("ArrowRight")
    notebook.wait_for_timeout(400)
    degrees = float(slider.input_value())
    assert degrees == pytest.approx(np.degrees(before[1]) + 5, abs=0.51)
    assert angles(notebook, 0)[1] == pytest.approx(np.radians(degrees), abs=1e-9)
    assert pixels(notebook, 0) != picture
    assert notebook.evaluate("() => document.querySelectorAll('.jp-Cell.jp-mod-active')[0]?.id") == cell
    # the tip that the page names is the one of the angles shown, and the picture has the hand there
    named = notebook.evaluate(f"() => {VIEW.format(0)}.scene.tipAt")
    np.testing.assert_allclose(named, forward_kinematics(IR50P, angles(notebook, 0)), atol=1e-9)
    x, y = notebook.evaluate(f"() => {VIEW.format(0)}.scene.onPage({VIEW.format(0)}.scene.tipAt)")
    box = notebook.locator(".la-stage > canvas").nth(0).bounding_box()
    seen = notebook.evaluate(
        "([n, x, y]) => [...document.querySelectorAll('.la')[n].liveArm.canvas.getContext('2d')"
        ".getImageData(x - 6, y - 6, 12, 12).data]",
        [0, round(x - box["x"]), round(y - box["y"])],
    )
    assert np.reshape(seen, (-1, 4))[:, :3].min() < 130, "nothing dark where the tip should be"


def test_the_mouse_turns_the_view_and_leaves_the_arm(notebook):
    show(notebook, 0)
    before, picture = angles(notebook, 0), pixels(notebook, 0)
    box = notebook.locator(".la-stage > canvas").nth(0).bounding_box()
    notebook.mouse.move(box["x"] + 60, box["y"] + 300)
    notebook.mouse.down()
    notebook.mouse.move(box["x"] + 200, box["y"] + 260, steps=5)
    notebook.mouse.up()
    notebook.wait_for_timeout(400)
    assert (turned := pixels(notebook, 0)) != picture
    notebook.keyboard.press("ArrowLeft")  # the view has the focus now
    notebook.wait_for_timeout(400)
    assert pixels(notebook, 0) != turned
    np.testing.assert_array_equal(angles(notebook, 0), before)


@pytest.mark.parametrize("number", [0, 1], ids=["in the browser", "by the student's Python"])
def test_the_tip_follows_the_hand(notebook, number):
    show(notebook, number)
    picture = pixels(notebook, number)
    missed, note = drag_tip(notebook, number, -40, 30)
    assert np.abs(missed).max() < 2 and note == "" and pixels(notebook, number) != picture
    missed, note = drag_tip(notebook, number, 500, 100)
    assert np.abs(missed).max() > 50
    assert ("out of reach by" if number == 0 else "no solution here: the nearest point is") in note


def test_a_wrong_frame_draws_a_wrong_arm(notebook):
    show(notebook, 2)
    drawn, right = (notebook.evaluate(f"() => {VIEW.format(2)}.scene.tipAt"), angles(notebook, 2))
    wrong = forward_kinematics(IR50P, right * [1, 1, -1])
    np.testing.assert_allclose(drawn, wrong, atol=1e-6)
    assert np.linalg.norm(wrong - forward_kinematics(IR50P, right)) > 0.1
    notebook.locator(".la").nth(2).get_by_label("joint 2 in degrees").focus()
    notebook.keyboard.press("ArrowRight")  # asks the kernel for frames
    notebook.wait_for_function(
        f"old => Math.hypot(...{VIEW.format(2)}.scene.tipAt.map((v, i) => v - old[i])) > 1e-3", arg=drawn
    )


def test_two_runs_play_pause_scrub_and_start_again(notebook):
    show(notebook, 3)
    box = notebook.locator(".la").nth(3)
    picture = pixels(notebook, 3)
    box.get_by_label("play or pause").click()
    notebook.wait_for_function(f"() => {VIEW.format(3)}.player.time > 0.5", timeout=10_000)
    assert pixels(notebook, 3) != picture
    box.get_by_label("play or pause").click()
    stopped = notebook.evaluate(f"() => {VIEW.format(3)}.player.time")
    notebook.wait_for_timeout(300)
    assert notebook.evaluate(f"() => {VIEW.format(3)}.player.time") == stopped
    plots = box.locator(".la-side canvas").first.bounding_box()
    notebook.mouse.click(plots["x"] + plots["width"] / 2, plots["y"] + plots["height"] / 2)  # curves share the cursor
    time, wanted = notebook.evaluate(
        f"() => [{VIEW.format(3)}.player.time, {VIEW.format(3)}.player.track.at({VIEW.format(3)}.player.time, 1)]"
    )
    assert 1.5 < time < 3
    np.testing.assert_allclose(angles(notebook, 3), wanted, atol=1e-6)
    box.get_by_label("speed").select_option("5")
    box.get_by_label("play or pause").click()
    ended = "{0}.player.time === {0}.player.track.end && !{0}.player.playing".format(VIEW.format(3))
    notebook.wait_for_function(f"() => {ended}", timeout=20_000)
    box.get_by_label("play or pause").click()
    notebook.wait_for_function(f"() => {VIEW.format(3)}.player.time < 3", timeout=10_000)  # from the start again
    box.get_by_label("play or pause").click()
