"""A notebook sees by the camera of its browser: a fake one, which plays a rendered ball on the table, ten pictures long."""

import base64
import io
import json
import re
from pathlib import Path

import cv2
import numpy as np
import pytest
from a_student_keeps_all import run
from conftest import ARGUMENTS, CHROMIUM, open_in_lab, running_lab, write_notebook
from PIL import Image

import ir50p_lab.vision
from ir50p_lab.course.publishing.export import export
from ir50p_lab.vision import render_scene
from ir50p_lab.vision.rendering import SceneBall, bench_scene

SCRIPT = Path(ir50p_lab.vision.__file__).with_name("page_camera.js")
BLOCK = 40  # px, of a black or white square: four of them in a corner tell which picture it is
NUMBER = f"sum(int(rgb[{BLOCK // 2}, {BLOCK} * k + {BLOCK // 2}].mean() > 128) << k for k in range(4))"
OPEN = """from ir50p_lab.vision import find_balls, open_camera
camera = open_camera()
try:
    camera.read()
except Exception as error:
    print(type(error).__name__, error)"""
READ = f"""rgb = camera.read().image
ball = find_balls(rgb)[0]
print([{NUMBER}, ball.x, ball.y, ball.radius, *rgb.shape])"""
EACH = """def find(rgb):
    found.append(find_balls(rgb)[0])
    return found[-1].x, found[-1].y, found[-1].radius
found = []
camera.each(mine=find, broken=lambda rgb: rgb[999])"""
TRACKS = """navigator.mediaDevices && (() => {
  window.tracks = [];
  const ask = navigator.mediaDevices.getUserMedia.bind(navigator.mediaDevices);
  navigator.mediaDevices.getUserMedia = async (what) => {
    const stream = await ask(what);
    window.tracks.push(...stream.getTracks());
    return stream;
  };
})()"""
LIT = "() => window.tracks.filter((track) => track.readyState === 'live').length"
PICTURE = "canvas[aria-label^='The live picture']"
ALONE = """async (script) => {
  const {default: widget} = await import(script);
  const said = [], model = {get: () => [640, 480], on: () => {}, send: (message) => said.push(message)};
  let heard;
  model.on = (name, then) => { if (name === 'msg:custom') heard = then; };
  const {initialize, render} = widget();
  initialize({model});
  render({el: document.body});
  heard({start: true});
  while (!said.some((message) => message.off)) await new Promise((later) => setTimeout(later, 50));
  return [document.querySelector('[role=status]').textContent, said.find((message) => message.off).off];
}"""


@pytest.fixture(scope="module")
def video(tmp_path_factory):
    """Ten pictures as a file that Chromium plays as a camera, and the ball in each: (10, 3) px."""
    path, truth = tmp_path_factory.mktemp("video") / "ball.y4m", []
    with path.open("wb") as file:
        file.write(b"YUV4MPEG2 W640 H480 F5:1 Ip A1:1 C420jpeg\n")
        for number in range(10):
            ball = SceneBall(position=(0.42, -0.15 + 0.03 * number, 0.03))
            image, seen = render_scene(bench_scene(ball), seed=number)
            for bit in range(4):
                image[:BLOCK, BLOCK * bit : BLOCK * (bit + 1)] = 255 * (number >> bit & 1)
            truth.append([seen.balls[0].x, seen.balls[0].y, seen.balls[0].radius])
            file.write(b"FRAME\n" + cv2.cvtColor(image, cv2.COLOR_RGB2YUV_I420).tobytes())
    return path, np.array(truth)


@pytest.fixture(scope="module")
def with_a_camera(chromium, video):
    fake = ["--use-fake-device-for-media-stream", f"--use-file-for-fake-video-capture={video[0]}"]
    browser = chromium.launch(executable_path=CHROMIUM, args=[*ARGUMENTS, *fake], timeout=90_000)
    yield browser
    browser.close()


def seen(page):
    """The picture on the page: (480, 640, 3)."""
    png = page.locator(PICTURE).first.evaluate("(canvas) => canvas.toDataURL().split(',')[1]")
    return np.array(Image.open(io.BytesIO(base64.b64decode(png))).convert("RGB"))


def number_of(rgb):
    return eval(NUMBER, {"rgb": rgb})


def comes(page):
    """Wait until a picture stands on the page."""
    for _ in range(300):
        if page.locator(PICTURE).count() and seen(page).std() > 10:
            return
        page.wait_for_timeout(100)
    raise AssertionError(page.locator("[role=status]").all_text_contents())


def reads_the_ball(page, truth):
    """The next cell reads a new picture each time; the ball lies where it was rendered."""
    for _ in range(3):
        page.wait_for_timeout(500)  # where messages come between cells only, two cells at once see one picture
        number, x, y, radius, *shape = json.loads(re.search(r"\[\d.*?\]", run(page, 1, READ))[0])
        assert shape == [480, 640, 3]
        assert np.hypot(x - truth[number, 0], y - truth[number, 1]) < 1 and abs(radius - truth[number, 2]) < 1


def circles_lie_on_what_was_searched(page, truth):
    run(page, 2, EACH)
    status = page.locator("[role=status]", has_text="broken: IndexError")
    status.wait_for(timeout=30_000)
    for _ in range(3):
        page.wait_for_timeout(300)
        rgb = seen(page)
        x, y, radius = truth[number_of(rgb)]
        angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
        ring = rgb[(y + radius * np.sin(angles)).round().astype(int), (x + radius * np.cos(angles)).round().astype(int)]
        assert np.mean(ring.min(axis=-1) > 180) > 0.8
    run(page, 2, "camera.each()")


def nothing_is_kept_but_by_keep(page, path, tmp_path):
    kept = json.loads(run(page, 3, "camera.keep()"))
    assert [output["metadata"] for output in kept] == [{"image/png": {"alt": "A picture of the page's camera"}}]
    run(page, 3, "camera.close()")
    page.wait_for_function(f"() => ({LIT})() === 0")
    assert seen(page).std() == 0
    page.evaluate("() => jupyterapp.commands.execute('docmanager:save')")
    page.wait_for_timeout(1000)
    assert "none of it was kept" in path.read_text() and len(path.read_text()) < 40_000
    (html,) = export(path, tmp_path / "pages", run=False, pdf=False)
    assert html.read_text().count("Here stood the live picture of a camera; none of it was kept.") == 1
    assert "<img" not in html.read_text()


def goes_out_with_its_cell_and_with_python(page):
    run(page, 0)
    comes(page)
    run(page, 3, "from IPython.display import display\ndisplay(camera._live)")  # a second view
    page.wait_for_timeout(500)
    assert page.evaluate(LIT) == 1
    run(page, 0, "pass")
    page.wait_for_timeout(1500)
    assert page.evaluate(LIT) == 1
    run(page, 3, "pass")
    page.wait_for_function(f"() => ({LIT})() === 0")
    run(page, 0, OPEN)
    comes(page)
    page.evaluate("() => jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart()")
    page.wait_for_function(f"() => ({LIT})() === 0")
    assert "Python has ended: camera off." in page.locator("[role=status]").all_text_contents()


def test_a_notebook_sees_by_its_browser(with_a_camera, video, tmp_path):
    home = tmp_path / "lab"
    home.mkdir()
    path = home / "camera.ipynb"
    write_notebook(path, *["pass"] * 4)
    context = with_a_camera.new_context(permissions=["camera"], viewport={"width": 1200, "height": 1000})
    context.add_init_script(TRACKS)
    page = context.new_page()
    with running_lab(home) as (address, _):
        open_in_lab(page, address.format(path.name))
        said = run(page, 0, OPEN)
        assert "CameraError the page answers between cells: read it in the next cell" in said
        comes(page)
        reads_the_ball(page, video[1])
        circles_lie_on_what_was_searched(page, video[1])
        nothing_is_kept_but_by_keep(page, path, tmp_path)
        goes_out_with_its_cell_and_with_python(page)
    context.close()


@pytest.mark.parametrize(
    ("address", "protocol", "words"),
    [
        ("http://localhost/", "location.protocol", "may not use the camera: allow it"),
        ("http://lab.example/", "location.protocol", "only to pages of https"),
        ("http://localhost/", "'vscode-webview:'", "open it in JupyterLab, or take open_camera(0)"),
    ],
)
def test_why_there_is_no_picture_is_said(with_a_camera, address, protocol, words):
    context = with_a_camera.new_context()
    page = context.new_page()
    script = SCRIPT.read_text().replace("location.protocol", protocol)
    page.route("**/*", lambda route: route.fulfill(body="<!doctype html><body>", content_type="text/html"))
    page.route("**/camera.js", lambda route: route.fulfill(body=script, content_type="text/javascript"))
    page.goto(address)
    on_the_page, to_python = page.evaluate(ALONE, "/camera.js")
    assert words in on_the_page and to_python == on_the_page
    context.close()
