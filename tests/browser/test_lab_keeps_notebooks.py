"""JupyterLab opens a notebook of the course, starts its kernel and saves it: the file stays as it is shipped."""

import platform

import nbformat
from a_student_keeps_all import NOTEBOOKS
from conftest import running_lab
from stripped import read

OPENED = "[...jupyterapp.shell.widgets('main')].find(widget => widget.context?.path === 'page.ipynb')"


def test_opening_and_saving_changes_nothing(tmp_path, page):
    """Where the Python is that of the file: another version is the one line that changes."""
    notebook = read(NOTEBOOKS[0])
    notebook.metadata.language_info.version = platform.python_version()
    shipped = nbformat.writes(notebook) + "\n"
    (tmp_path / "page.ipynb").write_text(shipped, encoding="utf-8")
    with running_lab(tmp_path) as (address, _):
        page.goto(address.format("page.ipynb"))
        kernel = f"{OPENED}?.sessionContext.session?.kernel"
        page.wait_for_function(f"() => window.jupyterapp && {kernel}?.status === 'idle'")
        page.evaluate(f"() => {kernel}.info")
        page.wait_for_timeout(1000)  # what the kernel has said of itself would be in the notebook now
        assert page.evaluate(f"() => {OPENED}.context.model.dirty") is False
        page.evaluate(f"() => {OPENED}.context.save()")
    saved = nbformat.read(tmp_path / "page.ipynb", as_version=4)
    assert (
        saved.metadata.pop("widgets")["application/vnd.jupyter.widget-state+json"]["state"] == {}
    )  # there are none yet
    assert nbformat.writes(saved) + "\n" == shipped
