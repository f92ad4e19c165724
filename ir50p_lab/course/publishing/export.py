"""A notebook as one HTML page without network requests: pictures, formulas and the 3-D arm inside; and as PDF."""

import asyncio
import html
import os
import re
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import nbclient
import nbformat
from nbclient.exceptions import CellExecutionError
from nbconvert import HTMLExporter
from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath
from pygments.formatters import HtmlFormatter

from ir50p_lab.course.publishing.formulas import mathml, mathml_in
from ir50p_lab.course.publishing.pictures import live_arm_script, plain_outputs
from ir50p_lab.errors import InputError, LabError

_BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome", "msedge", "microsoft-edge")
_REACHED = """<script>for (const one of document.querySelectorAll("math, table, .output_html"))
  if (one.scrollWidth > one.clientWidth) one.tabIndex = 0;</script>"""  # what scrolls does so by keys, too
_CSS = Path(__file__).with_name("page.css").read_text(encoding="utf-8")


class _Renderer(IPythonRenderer):
    """Markdown whose formulas become MathML, which browsers draw by themselves."""

    def inline_math(self, body):
        return mathml(body)

    def block_math(self, body):
        return mathml(body, block=True)

    def latex_environment(self, name, body):
        return mathml(f"\\begin{{{name}}}{body}\\end{{{name}}}", block=True)


class _Exporter(HTMLExporter):
    """The body of a page, without scripts and styles from elsewhere."""

    template_name = "basic"

    def markdown2html(self, source):
        return MarkdownWithMath(renderer=_Renderer(escape=False, embed_images=True)).render(source)

    def default_filters(self):
        yield from super().default_filters()
        yield "markdown2html", self.markdown2html


def export(notebook, folder=".", *, run=True, pdf=True, code=True, title=None):
    """Write a notebook as `folder`/NAME.html, and NAME.pdf where a browser (Chromium, Chrome, Edge) is found.

    Args: notebook: path of an .ipynb, or of a page of text (.md); run: run it first, in its own folder; else its stored
    outputs are taken; code: with the cells' code; title: of the page, else the notebook's name.
    Returns: the paths written. Raises InputError if there is no such notebook, LabError if a cell fails.
    """
    notebook, folder = Path(notebook), Path(folder)
    if not notebook.is_file():
        raise InputError(f"there is no notebook {notebook}: give the path of an .ipynb file")
    is_text = notebook.suffix == ".md"
    nb = _text_page(notebook) if is_text else nbformat.read(notebook, as_version=4)
    if run and not is_text:
        execute(nb, notebook)
    folder.mkdir(parents=True, exist_ok=True)
    written = [folder / f"{notebook.stem}.html"]
    title = title or notebook.stem
    written[0].write_text(_page(nb, title, live=True, code=code), encoding="utf-8")
    browser = find_browser()
    if pdf and browser:
        written.append(_print(browser, _page(nb, title, live=False, code=code), folder / f"{notebook.stem}.pdf"))
    return written


def _text_page(path):
    """A text as a notebook of one cell; its pictures are found where it lies."""
    text = re.sub(
        r"(!\[[^]]*]\()(?!\w+:)", f"\\g<1>{path.resolve().parent.as_posix()}/", path.read_text(encoding="utf-8")
    )
    return nbformat.v4.new_notebook(cells=[nbformat.v4.new_markdown_cell(text)])


def find_browser():
    """Path of a browser that prints and is driven without a screen, or None."""
    return next(filter(None, map(shutil.which, _BROWSERS)), None)


def execute(nb, notebook, **variables):
    """Run the cells in the folder of the file `notebook`, with these environment variables too.

    Raises LabError with the cell that fails.
    """
    where = {"metadata": {"path": str(notebook.resolve().parent)}}
    client = nbclient.NotebookClient(nb, timeout=600, kernel_name="python3", resources=where)

    def run():
        with asyncio.Runner(loop_factory=asyncio.SelectorEventLoop) as loop:
            loop.run(client.async_execute(env=os.environ | variables, stderr=subprocess.DEVNULL))  # its own notices

    try:
        with ThreadPoolExecutor(1) as thread:  # the caller's may have a loop that is running: in a notebook it has
            thread.submit(run).result()
    except CellExecutionError as error:
        raise LabError(f"{notebook} does not run: {error}") from None


def _page(nb, title, *, live, code):
    """The whole page. live: with the 3-D arm in motion; else its pictures."""
    nb = nbformat.from_dict(nb)
    state = nb.metadata.get("widgets", {}).get("application/vnd.jupyter.widget-state+json", {}).get("state", {})
    for cell in nb.cells:
        if cell.cell_type == "code":
            cell.outputs = [mathml_in(output) for output in plain_outputs(cell.outputs, state, live=live)]
    body, _ = _Exporter(exclude_input=not code).from_notebook_node(nb)
    script = live_arm_script() if "data-live-arm" in body else ""
    style = _CSS + HtmlFormatter().get_style_defs(".highlight")
    head = (
        f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{html.escape(title)}</title>'
    )
    page = f"<head>{head}<style>{style}</style></head><body><main>{body}</main>{_REACHED}{script}</body>"
    return f"<!doctype html><html lang=en>{page}</html>"


def _print(browser, page, path):
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "page.html"
        source.write_text(page.replace("<details", "<details open"), encoding="utf-8")  # paper has no click
        options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}/profile"]
        target = ["--no-pdf-header-footer", f"--print-to-pdf={path.resolve()}", source.as_uri()]
        done = subprocess.run([browser, *options, *target], capture_output=True, text=True, timeout=120)
    if not path.is_file():
        raise LabError(
            f"{browser} wrote no PDF: {done.stderr[-500:]}; use --no-pdf and print the HTML page from a browser"
        )
    return path
