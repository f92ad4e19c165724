"""What outputs say can be read in JupyterLab's light theme and in its dark one."""

import pytest
from conftest import RUN_ALL, open_in_lab, running_lab, write_notebook

CELLS = [
    "from ir50p_lab.course import check, my_robot, predict\n"
    "check('start-1', 7)\ncheck('rot_z', lambda angle: None)\npredict('start.fall', 'long', 's')\nmy_robot.progress()",
    "import numpy as np\nfrom ir50p_lab.course.draw.scope import Scope\n"
    "scope, rows = Scope(badge='simulated'), np.ones((11, 3))\n"
    "scope.show(np.arange(11) / 10, rows, rows, 100 * rows)\nscope",
    "from ir50p_lab.course.draw.style import new_figure\nfrom ir50p_lab.course.draw.widgets import live\n"
    "display(new_figure(3, 2))\n"
    "panel = live(new_figure(3, 2), lambda a: f'{1 / (1 - a):.2f}', a=(0, 1, 0.1, 0))\ndisplay(panel)\n"
    "panel.controls['a'].value = 1",
    "from ir50p_lab.course import my_robot\nmy_robot",
    "import numpy as np\nfrom ir50p_lab.course import PictureView\n"
    "view = PictureView(np.zeros((60, 80), bool), lambda x, y: 1 / x, alt='all dark')\ndisplay(view)\n"
    "view.canvas._handle_custom_msg({'right': 0, 'up': 0}, [])\nPictureView(np.ones((60, 80), bool), alt='all bright')",
    "from ir50p_lab.course.live_arm import LiveArm\nfrom ir50p_lab.modelling import IR50P\n"
    "from ir50p_lab.controllers import PID\nfrom ir50p_lab.signals import hold\nfrom ir50p_lab.simulation import simulate\n"
    "run = simulate(IR50P, PID(kp=300, limit_pwm=255), hold((0, 0.8, -1)), duration=2, period=0.01, q0=(0, 1, -1.4))\n"
    "display(LiveArm(IR50P, [0, 0.5, -1], badge='yours').play(run))\nprint('all shown')",
]
FAINT = """() => {
  const number = (text) => (text.match(/[\\d.]+/g) || [0, 0, 0, 0]).map(Number);
  const opaque = (text) => text !== 'transparent' && (number(text)[3] ?? 1) > 0.5;
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255)
    .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, k) => sum + c * [0.2126, 0.7152, 0.0722][k], 0);
  const faint = [];
  for (const output of document.querySelectorAll('.jp-OutputArea-output')) {
    const walk = document.createTreeWalker(output, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const text = walk.currentNode.textContent.trim(), box = walk.currentNode.parentElement;
      if (!text || !box.checkVisibility({ opacityProperty: true, visibilityProperty: true }) || box.closest('style,script')) continue;
      const style = getComputedStyle(box), ink = box.namespaceURI.endsWith('svg') ? style.fill : style.color;
      let ground = box;
      while (ground.parentElement && !opaque(getComputedStyle(ground).backgroundColor)) ground = ground.parentElement;
      const [one, other] = [ink, getComputedStyle(ground).backgroundColor].map(number).map(light).sort((a, b) => b - a);
      const contrast = (one + 0.05) / (other + 0.05);
      if (contrast < 4.5) faint.push(`${text.slice(0, 40)}: ${ink}, ${contrast.toFixed(1)}`);
    }
  }
  return faint;
}"""


@pytest.fixture(scope="module")
def shown(browser, tmp_path_factory):
    """A page of all kinds of outputs in JupyterLab."""
    home = tmp_path_factory.mktemp("lab")
    write_notebook(home / "outputs.ipynb", *CELLS)
    with running_lab(home, IR50P_HOME=str(home)) as (address, _):
        page = browser.new_context(viewport={"width": 1300, "height": 1000}).new_page()
        open_in_lab(page, address.format("outputs.ipynb"))
        page.evaluate(RUN_ALL)
        page.get_by_text("all shown").last.wait_for(timeout=120_000)
        page.wait_for_function("() => document.querySelector('.la')?.liveArm", timeout=60_000)
        yield page
        page.context.close()


@pytest.mark.parametrize("theme", ["JupyterLab Dark", "JupyterLab Light"])
def test_every_text_stands_out_from_its_ground(shown, theme):
    shown.evaluate(f"() => jupyterapp.commands.execute('apputils:change-theme', {{theme: '{theme}'}})")
    shown.wait_for_function(f"() => document.body.dataset.jpThemeName === '{theme}'")
    shown.wait_for_timeout(500)
    assert shown.evaluate("() => document.querySelectorAll('.jp-OutputArea-output').length") >= len(CELLS)
    assert shown.evaluate(FAINT) == []


def test_every_picture_says_what_it_shows(shown):
    images = "[...document.querySelectorAll('.jp-OutputArea-output img')]"
    assert shown.evaluate(f"() => {images}.length") >= 2
    assert shown.evaluate(f"() => {images}.filter((one) => !one.alt).length") == 0
