"""README's moving picture, of the page to try: `python3 -m ir50p_lab animation` writes docs/arm.gif.

A browser without a screen plays the first view of the page, and each frame is taken from it.
"""

import io

from PIL import Image
from tqdm import tqdm

from ir50p_lab.course.publishing.export import find_browser
from ir50p_lab.course.publishing.try_page import PAGE
from ir50p_lab.home import PROJECT

PICTURE = PROJECT / "docs" / "arm.gif"
_FRAMES, _SECONDS, _SIZE, _COLOURS = 60, 5.0, (720, 420), 96
_VIEW = "document.querySelector('.la').liveArm"
_SHOW = f"(part) => {{ const {{ player, scene }} = {_VIEW}; player.seek(part * player.track.end);"
_SHOW += " scene.controls.rotateLeft(0.004); scene.controls.update(); scene.draw(false); }"


def main():
    """Take the frames, turning the view a little, and write them as one GIF."""
    from playwright.sync_api import sync_playwright  # a test tool

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=find_browser(), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 768, "height": 900}, reduced_motion="reduce")  # no play by itself
        page.goto(PAGE.as_uri())
        page.wait_for_function(f"() => {_VIEW}?.scene.width > 0", timeout=60_000)
        page.evaluate(f"() => {{ {_VIEW}.scene.soon = () => {{}}; }}")  # no coarse pictures between
        frames = [_frame(page, k / (_FRAMES - 1)) for k in tqdm(range(_FRAMES), desc="frames")]
        browser.close()
    last = [int(1000 * _SECONDS / _FRAMES)] * (_FRAMES - 1) + [2000]  # ms; it rests at its end
    frames[0].save(PICTURE, save_all=True, append_images=frames[1:], duration=last, loop=0, optimize=True)
    print(f"{PICTURE}: {PICTURE.stat().st_size / 1e6:.1f} MB")


def _frame(page, part):
    page.evaluate(_SHOW, part)
    picture = Image.open(io.BytesIO(page.locator("canvas").first.screenshot())).convert("RGB")
    picture.thumbnail(_SIZE)
    return picture.quantize(_COLOURS, dither=Image.Dither.NONE)


if __name__ == "__main__":
    main()
