"""A notebook that was saved and is opened again, its kernel gone, still shows the arm and lets it be turned."""

import nbformat
from conftest import running_lab
from test_live_arm_in_lab import KERNEL_IDLE, RUN_ALL

CELL = "from ir50p_lab.course.live_arm import LiveArm\nfrom ir50p_lab.modelling import IR50P\nLiveArm(IR50P, (0.3, 0.8, -1))"
SHOWN = "() => document.querySelector('.la')?.liveArm"


def test_the_arm_is_there_without_a_kernel(browser, tmp_path):
    kernel = {"name": "python3", "display_name": "Python 3"}
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CELL)], metadata={"kernelspec": kernel})
    nbformat.write(notebook, tmp_path / "one.ipynb")
    for run in (True, False):
        with running_lab(tmp_path) as (address, _):
            context = browser.new_context()
            page = context.new_page()
            page.goto(address.format("one.ipynb"), wait_until="commit")
            page.wait_for_function(KERNEL_IDLE, timeout=90_000)
            if run:
                page.evaluate(RUN_ALL)
            page.wait_for_function(SHOWN, timeout=60_000)
            assert page.evaluate("() => document.querySelector('.la').liveArm.q")[1] == 0.8
            page.evaluate("() => jupyterapp.commands.execute('docmanager:save')")
            page.wait_for_function("() => !jupyterapp.shell.currentWidget.context.model.dirty")
            context.close()
