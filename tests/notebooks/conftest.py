"""Every notebook is run once per session."""

import nbformat
import pytest
from notebook_runner import NOTEBOOKS, run_notebook


@pytest.fixture(scope="session")
def runs(tmp_path_factory):
    """Return a function path -> Run that runs each notebook once."""
    done = {}

    def run(path):
        if path not in done:
            with pytest.MonkeyPatch.context() as patch:
                patch.setenv("IR50P_PROGRESS", str(tmp_path_factory.mktemp("progress") / "progress.json"))
                patch.setenv("IR50P_RECORDINGS", str(tmp_path_factory.mktemp("recordings")))
                patch.setenv("PYDEVD_DISABLE_FILE_VALIDATION", "1")  # a debugger's notice on stderr
                done[path] = run_notebook(nbformat.read(path, as_version=4))
        return done[path]

    return run


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def path(request):
    """Every notebook."""
    return request.param


@pytest.fixture
def notebook(path):
    """The notebook as nbformat reads it."""
    return nbformat.read(path, as_version=4)
