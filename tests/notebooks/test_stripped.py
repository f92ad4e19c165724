"""What JupyterLab stores in a notebook is left out of what the tests run, and said; nothing that somebody wrote is."""

import nbformat
import pytest
import stripped
from ipykernel.ipkernel import IPythonKernel
from ipykernel.kernelspec import get_kernel_dict
from notebook_runner import NOTEBOOKS


@pytest.fixture
def stored():
    """A notebook after a lesson: outputs, metadata, another kernel, and the empty cell below the last one."""
    notebook = stripped.read(NOTEBOOKS[0])
    first, second = [cell for cell in notebook.cells if cell.cell_type == "code"][:2]
    first.outputs = [nbformat.v4.new_output("stream", text="42"), nbformat.v4.new_output("display_data")]
    first.execution_count = 7
    second.metadata = {"scrolled": True, "jupyter": {"source_hidden": True}}
    notebook.cells.append(nbformat.v4.new_code_cell())
    notebook.metadata |= {"widgets": {"application/vnd.jupyter.widget-state+json": {}}}
    notebook.metadata |= {
        "kernelspec": {"display_name": "mine", "name": "mine"},
        "language_info": {"version": "3.14.2"},
    }
    return notebook


def test_what_was_stored_is_left_out_and_said_and_what_somebody_wrote_stays(stored):
    assert stripped.strip(stored) == stripped.read(NOTEBOOKS[0])
    said = "outputs: 2, execution counts: 1, cells with metadata: 1, empty cells: 1, entries of metadata: 1, other kernels: 1"
    assert stripped.left_out(stored) == said
    stored.cells.append(nbformat.v4.new_markdown_cell("a note of mine"))
    assert stripped.strip(stored).cells[-1].source == "a note of mine"


def test_metadata_are_those_that_jupyterlab_writes():
    spec = get_kernel_dict()
    named = {"name": "python3", "display_name": spec["display_name"], "language": spec["language"]}
    assert stripped.METADATA["kernelspec"] == named
    language = stripped.METADATA["language_info"] | {"version": ""}
    assert language == IPythonKernel.language_info | {"version": ""}
