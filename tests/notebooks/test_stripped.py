"""The metadata that a shipped notebook keeps are those that JupyterLab writes."""

import stripped
from ipykernel.ipkernel import IPythonKernel
from ipykernel.kernelspec import get_kernel_dict


def test_metadata_are_those_that_jupyterlab_writes():
    spec = get_kernel_dict()
    named = {"name": "python3", "display_name": spec["display_name"], "language": spec["language"]}
    assert stripped.METADATA["kernelspec"] == named
    language = stripped.METADATA["language_info"] | {"version": ""}
    assert language == IPythonKernel.language_info | {"version": ""}
