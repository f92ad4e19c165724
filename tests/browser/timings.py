"""How fast LiveArm is in JupyterLab, and what is allowed (here: software WebGL). Needs a quiet machine; run by hand:

.venv/bin/python -m pytest -s tests/browser/timings.py
"""

import statistics

import pytest
from test_live_arm_in_lab import KERNEL_IDLE, RUN_ALL, show

# Time of an event to the first frame whose pixels, read back and thus finished, differ.
WATCH = """([number, event]) => {
  const view = document.querySelectorAll('.la')[number].liveArm, box = view.canvas;
  const sum = () => { // of the middle, where the arm is
    const [w, h] = [box.width >> 2, box.height >> 2];
    const data = new Uint32Array(box.getContext('2d').getImageData(2 * w - 60, h, 120, 2 * h).data.buffer);
    return data.reduce((hash, value) => (Math.imul(hash, 31) + value) | 0, 0);
  };
  const before = sum();
  window.timing = new Promise((done) => document.addEventListener(event, () => {
    const began = performance.now();
    const look = () => (sum() === before ? requestAnimationFrame(look) : done(performance.now() - began));
    requestAnimationFrame(look);
  }, { capture: true, once: true }));
}"""
FRAMES = """([number, seconds]) => new Promise((done) => {
  const view = document.querySelectorAll('.la')[number].liveArm, began = performance.now();
  let frames = 0, last = -1;
  const look = () => {
    frames += view.time !== last;
    last = view.time;
    const now = performance.now() - began;
    now < 1000 * seconds ? requestAnimationFrame(look) : done(frames / now * 1000);
  };
  look();
})"""
FIRST = """() => {
  const filled = (box) => new Set(new Uint32Array(
    box.getContext('2d').getImageData(0, 0, box.width, box.height).data.buffer)).size > 30;
  let began = null;
  const look = () => {
    const box = document.querySelector('.la');
    if (box) began ??= performance.now();
    box?.liveArm?.canvas.width > 0 && filled(box.liveArm.canvas)
      ? (window.first = performance.now() - began) : requestAnimationFrame(look);
  };
  look();
}"""


@pytest.fixture(scope="module", params=[1, 2], ids=["one pixel per CSS pixel", "two"])
def notebook(browser, lab, request):
    context = browser.new_context(viewport={"width": 1300, "height": 1000}, device_scale_factor=request.param)
    page = context.new_page()
    page.goto(lab, wait_until="commit")
    page.wait_for_function(KERNEL_IDLE, timeout=90_000)
    page.evaluate(FIRST)
    page.evaluate(RUN_ALL)
    page.wait_for_function("() => document.querySelectorAll('.la').length === 4", timeout=120_000)
    page.wait_for_function("() => [...document.querySelectorAll('.la')].every((box) => box.liveArm)")
    yield page
    context.close()


def test_the_first_frame(notebook):
    notebook.wait_for_function("() => window.first > 0")
    took = notebook.evaluate("() => window.first")
    print(f"\nfirst frame {took:.0f} ms after the view was placed on the page")
    assert took < 1000


@pytest.mark.parametrize(("number", "whose"), [(0, "its own slider"), (2, "the kernel")])
def test_key_to_pixels(notebook, number, whose):
    show(notebook, number)
    slider = notebook.locator(".la").nth(number).get_by_label("joint 2 in degrees")
    slider.focus()
    times = []
    for step in range(30):
        notebook.evaluate(WATCH, [number, "keydown"])
        notebook.keyboard.press("ArrowRight" if step % 2 else "ArrowLeft")
        times.append(notebook.evaluate("() => window.timing"))
        notebook.wait_for_timeout(350)
    print(f"\nkey to finished pixels, {whose}: median {statistics.median(times):.0f} ms, slowest {max(times):.0f} ms")
    assert statistics.median(times) < 60


def test_frames_while_playing(notebook):
    show(notebook, 3)
    notebook.locator(".la").nth(3).get_by_label("play or pause").click()
    rate = notebook.evaluate(FRAMES, [3, 5])
    notebook.locator(".la").nth(3).get_by_label("play or pause").click()
    print(f"\n{rate:.0f} frames a second while two arms play")
    assert rate > 20
