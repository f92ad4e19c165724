"""A notebook that was saved and is opened again, its kernel gone, still shows the arm and lets it be turned."""

from conftest import RUN_ALL, open_in_lab, running_lab, write_notebook

CELL = "from ir50p_lab.course.live_arm import LiveArm\nfrom ir50p_lab.modelling import IR50P\nLiveArm(IR50P, (0.3, 0.8, -1))"
SHOWN = "() => document.querySelector('.la')?.liveArm"
MISSED = "() => document.querySelector('.jp-OutputArea-output')?.innerText.includes('model not found')"


def test_the_arm_is_there_without_a_kernel(browser, tmp_path):
    write_notebook(tmp_path / "one.ipynb", CELL)
    for run in (True, False):
        with running_lab(tmp_path) as (address, _):
            context = browser.new_context()
            page = context.new_page()
            open_in_lab(page, address.format("one.ipynb"))
            if run:
                page.evaluate(RUN_ALL)
            else:
                reload_where_missed(page)
            page.wait_for_function(SHOWN, timeout=120_000)
            assert page.evaluate("() => document.querySelector('.la').liveArm.q")[1] == 0.8
            page.evaluate("() => jupyterapp.commands.execute('docmanager:save')")
            page.wait_for_function("() => !jupyterapp.shell.currentWidget.context.model.dirty")
            context.close()


def reload_where_missed(page):
    """On a busy machine ipywidgets looks for a view before it has read the notebook's: then the page is loaded again."""
    for _ in range(3):
        page.wait_for_function(f"() => ({SHOWN})() || ({MISSED})()", timeout=120_000)
        if not page.evaluate(MISSED):
            return
        page.reload(wait_until="commit")
