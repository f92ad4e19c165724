"""A hand in the browser pushes an arm that a controller of the student's own holds: mouse, keys and touch."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from a_student_keeps_all import run
from conftest import RUN_ALL, open_in_lab, running_lab
from test_live_arm_in_lab import VIEW, show

THE_VIEW = VIEW.format(0)
MIDDLE_OF_LINK_2 = "view.scene.joints[1].map((v, i) => (v + view.scene.joints[2][i]) / 2)"
EVENTS = 3  # number of the cell that prints those of the recording


@pytest.fixture
def pushed(browser, tmp_path_factory):
    """The page with the arm, followed live."""
    home = tmp_path_factory.mktemp("push")
    shutil.copy(Path(__file__).parent / "push.ipynb", home)
    with running_lab(home) as (address, _):
        context = browser.new_context(viewport={"width": 1300, "height": 1000}, has_touch=True)
        page = context.new_page()
        open_in_lab(page, address.format("push.ipynb"))
        page.evaluate(RUN_ALL)
        page.wait_for_function(
            f"() => document.querySelector('.la')?.liveArm && {THE_VIEW}.hand.mostPush", timeout=120_000
        )
        show(page, 0)
        yield page
        context.close()


def tip(page):
    return np.array(page.evaluate(f"() => {THE_VIEW}.scene.tipAt"))


def place(page, point):
    """Where a point of the base is on the page."""
    return page.evaluate(f"() => {{ const view = {THE_VIEW}; return view.scene.onPage({point}); }}")


def arrow(page):
    """Length of the arrow that is drawn, m; None without one."""
    return page.evaluate(
        f"() => {{ const {{ hand, scene }} = {THE_VIEW}, {{ head, grip }} = hand; return head.visible ? head.position.distanceTo("
        "grip.point.clone().applyMatrix4(scene.robot.links[grip.link].matrix)) : null; }"
    )


def words(page, link):
    """The newtons that stand in words under the arm; if the kernel is late, it says so there until it answers."""
    text = page.locator(".la-note", has_text="you push").first.text_content(timeout=60_000)
    return float(re.fullmatch(rf"you push with ([\d.]+) N at link {link}", text)[1])


def rises(page, before, metres):
    page.wait_for_function(f"(z) => {THE_VIEW}.scene.tipAt[2] > z", arg=before[2] + metres, timeout=60_000)


def has_let_go(page):
    assert arrow(page) is None and "you push" not in page.locator(".la-note").first.text_content()


def mouse_pushes_the_tip_with_ten_newtons_at_most(pushed):
    before, (x, y) = tip(pushed), place(pushed, "view.scene.tipAt")
    pushed.mouse.move(x, y)
    pushed.mouse.down()
    pushed.mouse.move(x, y - 20, steps=4)
    some, short = words(pushed, 3), arrow(pushed)
    assert 0.5 < some < 10
    pushed.mouse.move(x, y - 400, steps=4)
    assert words(pushed, 3) == 10 and arrow(pushed) == pytest.approx(short * 10 / some, rel=0.1)
    rises(pushed, before, 0.1)  # P leaves 266 mm; held still for longer than a push lasts
    pushed.mouse.up()
    has_let_go(pushed)
    pushed.wait_for_function(f"(z) => {THE_VIEW}.scene.tipAt[2] < z", arg=before[2] + 0.05, timeout=60_000)


def shift_and_arrows_push_the_tip_newton_by_newton(pushed):
    before = tip(pushed)
    pushed.locator(".la-stage > canvas").first.focus()
    pushed.keyboard.down("Shift")
    for newtons in range(1, 13):
        pushed.keyboard.press("ArrowUp")
        assert words(pushed, 3) == min(newtons, 10)
    rises(pushed, before, 0.1)
    pushed.keyboard.up("Shift")
    has_let_go(pushed)
    assert "with Shift they push the arm" in pushed.locator(".la canvas").first.get_attribute("aria-label")


def finger_pushes_the_upper_arm(pushed):
    touch, (x, y) = pushed.context.new_cdp_session(pushed), place(pushed, MIDDLE_OF_LINK_2)
    for kind, lift in [("touchStart", 0), *(("touchMove", 20 * k) for k in range(1, 5))]:
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y - lift}]})
    assert words(pushed, 2) > 1 and arrow(pushed) > 0
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    has_let_go(pushed)


def recording_says_it(pushed):
    said = run(pushed, EVENTS)
    assert "a hand pushes at link 3 with 10.0 N" in said and "a hand pushes at link 2" in said
    assert "the hand has let go" in said
    run(pushed, EVENTS, "run.stop()")
    pushed.wait_for_function(
        f"() => !{THE_VIEW}.hand.mostPush && !{THE_VIEW}.player.isLive", timeout=60_000
    )  # played from now on


def test_a_hand_pushes(pushed):
    """One test, for each step finds the arm as the step before has left it."""
    mouse_pushes_the_tip_with_ten_newtons_at_most(pushed)
    shift_and_arrows_push_the_tip_newton_by_newton(pushed)
    finger_pushes_the_upper_arm(pushed)
    recording_says_it(pushed)
