"""The page to try: made from what is here now, and alive without a network."""

import pytest
from accessibility import fits, violations
from PIL import Image

from ir50p_lab.course.publishing.try_page import MADE_FROM, PAGE, fingerprint
from ir50p_lab.modelling import IR50P, inverse_kinematics
from tests.support.animation import PICTURE


def test_it_was_made_from_what_is_here():
    command = "python3 -m ir50p_lab try-page, then python3 -m ir50p_lab animation"
    assert MADE_FROM.read_text(encoding="utf-8").strip() == fingerprint(), command
    assert PAGE.stat().st_size < 2.5e6


def test_the_moving_picture_moves_and_is_small():
    with Image.open(PICTURE) as picture:
        assert picture.n_frames > 20 and min(picture.size) > 300
        first = picture.convert("RGB").tobytes()
        picture.seek(picture.n_frames - 1)
        assert picture.convert("RGB").tobytes() != first
    assert PICTURE.stat().st_size < 2e6


def test_the_first_view_plays_by_itself_and_takes_the_ball_along(page):
    page.goto(PAGE.as_uri())
    page.wait_for_function("() => document.querySelector('.la')?.liveArm.player.time > 0.1", timeout=60_000)
    for size in ({"width": 1366, "height": 768}, {"width": 390, "height": 844}):
        page.set_viewport_size(size)
        button = page.get_by_label("play or pause").first.bounding_box()
        assert button["y"] + button["height"] < size["height"], size
        tip, menu = (page.locator(one).first.bounding_box() for one in (".la-tip", ".la-layers summary"))
        assert max(tip["x"] + tip["width"], menu["x"] + menu["width"]) < size["width"], size
    at_the_end = """() => {
        const { player, scene } = document.querySelector('.la').liveArm;
        player.pause();
        player.seek(player.track.end);
        return [...scene.layers.all.ball.position].map((v, k) => v - scene.tipAt[k]);
    }"""
    assert page.evaluate(at_the_end) == pytest.approx([0, 0, 0], abs=1e-9)


def test_three_play_by_one_button_and_the_tip_says_how_far_it_is(page):
    page.emulate_media(reduced_motion="reduce")
    page.goto(PAGE.as_uri())
    page.get_by_role("button", name="all three").click()
    times = "() => [...document.querySelectorAll('.la')].map((box) => box.liveArm.player.time)"
    page.wait_for_function(f"() => ({times})().slice(2).every((time) => time > 0.1)")
    assert page.get_by_text("mm from the middle of the ball").is_visible()
    (q,) = [list(q) for q in inverse_kinematics(IR50P, (0.42, -0.15, 0.03)).q if q[2] < 0][:1]
    page.evaluate("(q) => document.querySelectorAll('.la')[1].liveArm.pose(q)", q)
    assert page.get_by_text("You touch it").is_visible()


def test_it_turns_drags_and_plays_with_the_network_off(page):
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    page.context.set_offline(True)
    page.emulate_media(reduced_motion="reduce")
    page.goto(PAGE.as_uri())
    page.wait_for_function("() => document.querySelectorAll('.la').length === 5", timeout=60_000)
    views = "[...document.querySelectorAll('.la')].map((box) => box.liveArm)"
    assert not any(page.evaluate(f"() => {views}.map((view) => Boolean(view.player.playing))"))
    page.get_by_label("play or pause").nth(2).click()
    page.wait_for_function(f"() => {views}[3].player.time > 0.2 || {views}[2].player.time > 0.2")
    second = page.locator(".la").nth(1)
    second.scroll_into_view_if_needed()
    page.wait_for_function(f"() => {views}[1].scene.width > 0 && {views}[1].scene.seen")
    at, before = (
        page.evaluate(f"() => {views}[1].scene.onPage({views}[1].scene.tipAt)"),
        page.evaluate(f"() => {views}[1].q"),
    )
    page.mouse.move(*at)
    page.mouse.down()
    for k in range(1, 6):
        page.mouse.move(at[0] - 10 * k, at[1] + 12 * k)
    page.mouse.up()
    assert page.evaluate(f"() => {views}[1].q") != pytest.approx(before, abs=0.02)
    assert [url for url in asked if not url.startswith(("data:", "blob:"))] == [PAGE.as_uri()]


def test_everybody_can_read_it_on_any_screen(page):
    page.goto(PAGE.as_uri())
    page.wait_for_function("() => document.querySelectorAll('.la').length === 5", timeout=60_000)
    assert violations(page) == {}
    fits(page, 390)
    assert violations(page) == {}
