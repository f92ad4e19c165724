"""A picture in JupyterLab is clicked; the kernel names the pixel, and draws a circle there."""

import re

from conftest import RUN_ALL, open_in_lab, running_lab, write_notebook

CELL = """import numpy as np
from ir50p_lab.course import PictureView

def tell(x, y):
    view.circles = [(x, y, 9, "white")]
    return f"pixel {x}, {y}"

view = PictureView(np.full((120, 200, 3), (150, 20, 30), np.uint8), tell, alt="a red field")
view"""


def test_a_click_names_its_pixel(browser, tmp_path):
    write_notebook(tmp_path / "one.ipynb", CELL)
    with running_lab(tmp_path) as (address, _):
        context = browser.new_context()
        page = context.new_page()
        open_in_lab(page, address.format("one.ipynb"))
        page.evaluate(RUN_ALL)
        picture = page.get_by_alt_text("a red field").first
        picture.wait_for(timeout=90_000)
        before, box = picture.get_attribute("src"), picture.bounding_box()
        assert abs(box["width"] - 200) < 3 and abs(box["width"] / box["height"] - 200 / 120) < 0.05
        picture.click(position={"x": 150.5, "y": 40.5})
        said = page.get_by_text(re.compile(r"pixel \d+, \d+")).last.text_content(timeout=60_000)
        x, y = map(int, re.findall(r"\d+", said))
        assert abs(x - 150) <= 2 and abs(y - 40) <= 2
        page.wait_for_function(
            "before => document.querySelector('img[alt=\"a red field\"]').src !== before", arg=before
        )
        context.close()
