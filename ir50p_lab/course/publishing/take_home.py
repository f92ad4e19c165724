"""What belongs to the student, out of a browser tab and into it: report and ZIP as links, a button to put a ZIP in.

`python3 -m ir50p_lab pack` writes such a ZIP with all recordings and reports of bench-test: one file to send.
"""

import base64
import contextlib
import io
import tempfile
import zipfile
from datetime import date
from pathlib import Path

import ipywidgets
from IPython.display import HTML, display

from ir50p_lab.course.lab_book.update import take_over
from ir50p_lab.course.publishing.report import report
from ir50p_lab.home import home

_FOLDERS = ("my_robot", "results")


def take_home():
    """Show two links, your report and a ZIP with everything that you wrote and measured, and a button to put a ZIP in.

    On a laptop `python3 -m ir50p_lab update FILE.zip` takes the ZIP over; a ZIP that a laptop made goes into a tab by
    the button. Nothing that is here already is overwritten.
    """
    today = f"{date.today():%Y-%m-%d}"
    links = (
        _link(f"ir50p_report_{today}.html", "text/html", report().encode(), "Your report"),
        _link(f"ir50p_{today}.zip", "application/zip", packed(), "A ZIP of my_robot and results"),
    )
    display(HTML(" · ".join(links)))
    put_in = ipywidgets.FileUpload(accept=".zip", description="Put a ZIP in", layout={"width": "12em"})
    said = ipywidgets.Output()
    put_in.observe(lambda change: _put_in(put_in.value[0], said), "value")
    display(ipywidgets.VBox([put_in, said]))


def packed(folders=_FOLDERS) -> bytes:
    """Return a ZIP with these folders of `notebooks/`, and the exercises that are done."""
    files = [path for name in folders for path in (home() / name).rglob("*") if path.is_file()]
    kept = io.BytesIO()
    with zipfile.ZipFile(kept, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("notebooks/", "")
        for path in (*files, *home().glob("progress.json")):
            if path.suffix != ".pyc":
                archive.write(path, f"notebooks/{path.relative_to(home()).as_posix()}")
    return kept.getvalue()


def _link(name, kind, content, words):
    text = base64.b64encode(content).decode()
    return f'<a download="{name}" href="data:{kind};base64,{text}">{words}</a> ({len(content) / 1000:.0f} kB)'


def _put_in(upload, said):
    with tempfile.TemporaryDirectory() as room, said, contextlib.redirect_stderr(None):
        file = Path(room, "put_in.zip")
        file.write_bytes(upload["content"])
        try:
            take_over(file)
        except SystemExit as problem:
            print(problem)


def main():
    """Write the ZIP with the recordings into the present folder, and say what to do with it."""
    path = Path(f"ir50p_{date.today():%Y-%m-%d}.zip").resolve()
    path.write_bytes(packed((*_FOLDERS, "recordings")))
    print(f"{path}: {path.stat().st_size / 1000:.0f} kB, with functions, results, recordings and reports of bench-test")


if __name__ == "__main__":
    main()
