"""Many views on one page, without a kernel: no context is lost, and the browser's mathematics is the package's."""

import json

import numpy as np
import pytest

from ir50p_lab.course.live_arm import LiveArm
from ir50p_lab.course.live_arm.view import BUNDLE
from ir50p_lab.modelling import IR50P, forward_kinematics, frames

SHOWN = ("options", "q", "layers", "poses", "shape")


@pytest.fixture
def views(page, tmp_path):
    """A page of twenty views; `views` is its browser page."""
    states = []
    for k in range(20):
        view = LiveArm(IR50P, [0.1 * k - 1, 0.8, -1.2], height=300)
        states.append({name: view.get_state()[name] for name in SHOWN} | {"track": ""})
    (tmp_path / "live_arm.js").write_bytes(BUNDLE.read_bytes())
    script = (
        "import * as code from './live_arm.js'; window.code = code;"
        f"for (const state of {json.dumps(states)}) {{"
        "const box = document.createElement('div'); document.body.append(box); code.mount(box, state); }"
    )
    (tmp_path / "page.html").write_text(f'<!doctype html><body><script type="module">{script}</script>')
    page.route("http://page.test/*", lambda route: route.fulfill(path=tmp_path / route.request.url.rsplit("/", 1)[1]))
    page.goto("http://page.test/page.html")
    page.wait_for_function("() => document.querySelectorAll('.la').length === 20", timeout=60_000)
    return page


def test_twenty_views_are_all_drawn_and_share_one_context(views):
    for k in (*range(20), 0):
        views.locator(".la").nth(k).scroll_into_view_if_needed()
        views.wait_for_function(
            "(k) => { const canvas = document.querySelectorAll('.la')[k].liveArm.canvas;"
            "const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;"
            "let dark = 0; for (let i = 0; i < data.length; i += 4) dark += data[i] < 100; return dark > 300; }",
            arg=k,
            timeout=20_000,
        )
    figures = views.evaluate("() => code.inspect.figures()")
    assert figures["views"] == 20 and figures["lost"] is False


def test_layers_are_named_with_their_colours(views):
    box = views.locator(".la").first
    assert box.locator(".la-tip").is_visible()
    assert "tip at x" in box.get_by_role("img").first.get_attribute("aria-label")
    assert box.locator(".la-legend i").count() == 0
    box.locator("summary").click()
    box.get_by_label("velocity ellipsoid").check()
    box.get_by_label("frames").check()
    assert box.locator(".la-legend").nth(1).text_content() == "velocity ellipsoidxyz"
    assert box.locator(".la-legend i").count() == 4


def test_the_browser_moves_the_arm_as_the_package_does(views):
    rng = np.random.default_rng(1)
    low, high = np.array(IR50P.q_min), np.array(IR50P.q_max)
    for q in rng.uniform(low, high, (20, 3)):
        drawn = views.evaluate("([l, q]) => code.inspect.frames(l, q)", [IR50P.l, q.tolist()])
        np.testing.assert_allclose(np.reshape(drawn, (4, 4, 4)), frames(IR50P, q), atol=1e-12)
        near = np.clip(q + rng.normal(0, 0.1, 3), low, high)
        goal = forward_kinematics(IR50P, q)
        question = [IR50P.l, np.column_stack([low, high]).tolist(), goal.tolist(), near.tolist()]
        found = views.evaluate("(given) => code.inspect.reach(...given)", question)
        assert found["miss"] < 1e-6 and (low <= found["q"]).all() and (found["q"] <= high).all()
        np.testing.assert_allclose(forward_kinematics(IR50P, found["q"]), goal, atol=1e-6)


def test_out_of_reach_no_pose_within_the_limits_is_nearer(views):
    rng = np.random.default_rng(2)
    low, high = np.array(IR50P.q_min), np.array(IR50P.q_max)
    tips = forward_kinematics(IR50P, rng.uniform(low, high, (20_000, 3)))
    for goal in rng.normal(0, 0.6, (15, 3)):
        question = [IR50P.l, np.column_stack([low, high]).tolist(), goal.tolist(), [0, 0.5, -1]]
        found = views.evaluate("(given) => code.inspect.reach(...given)", question)
        assert found["miss"] <= np.linalg.norm(tips - goal, axis=1).min() + 1e-3
