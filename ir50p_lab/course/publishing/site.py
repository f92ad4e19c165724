"""The course as a site that runs in a browser tab (JupyterLite): `python3 -m ir50p_lab site --pyodide FOLDER|URL`.

Needs `jupyterlite-core`, `jupyterlite-pyodide-kernel`, `jupyter-server`, `pyodide-lock[wheel]` in the course's own
environment, and a Pyodide with its packages (docs/developing.md). The course's wheel and the pure packages that Pyodide
has not go into its lock: `import ir50p_lab` in a cell then loads all it needs.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.request
from pathlib import Path

from ir50p_lab import browser_tab
from ir50p_lab.errors import LabError
from ir50p_lab.home import PROJECT

NOTEBOOKS = "00 01 02 03 04 05 06 07 08 16".split()  # in a tab; in CI without numba, OpenCV, pyserial and loky
_DATA = ("first_reach.csv", "first_reach.jpg", "drawings", "arm_example.toml", "scenes")
_DATA += tuple(f"bench_16{ball}{which}.jpg" for ball in ("", "_blue") for which in ("", "_dim", "_empty"))
_PURE = "anywidget ipywidgets comm psygnal typing_extensions jupyterlab_widgets widgetsnbextension lazy_loader".split()
_PURE += "cloudpickle tomlkit tqdm sympy mpmath".split()
_AT_ONCE = ["ir50p-lab", "ipython", "jedi", "sqlite3", "comm"]  # fetched while the page opens
_WHEN_NEEDED = [*browser_tab.WHEN_NEEDED, "micropip", "ssl"]
#: What 00 does without: SciPy comes behind it; no widget of the classic notebook, no secure connection from Python.
_LEFT_OUT = {"ir50p-lab": "scipy", "ipywidgets": "widgetsnbextension", "ssl": "openssl"}
_WIDGETS = ("anywidget", "@jupyter-widgets/jupyterlab-manager")  # extensions of the page
_TO_NOTEBOOK = r"\[(?P<title>[^\[\]\n]*)\]\((?P<file>\w+)\.ipynb[^)]*\)"
_FIRST = "notebooks/index.html?path=notebooks/00_start_here.ipynb"
_TO_FIRST = f'<meta http-equiv="refresh" content="0; url=./{_FIRST}">'
_RUNTIME = "pyodide.js pyodide.mjs pyodide.asm.wasm python_stdlib.zip".split()


def build(pyodide, target):
    """Write the site into a folder. pyodide: folder or address; only packages that are needed are taken."""
    try:
        from pyodide_lock import PyodideLockSpec
        from pyodide_lock.utils import add_wheels_to_spec
    except ImportError:
        remedy = f"{sys.executable} -m pip install --no-deps -r .github/workflows/lite.txt"
        raise LabError(f"What builds the site is not in the course's environment. In {PROJECT}: {remedy}") from None
    with tempfile.TemporaryDirectory() as room:
        here = Path(room)
        runtime = here / "static" / "pyodide"
        runtime.mkdir(parents=True)
        address = pyodide if "://" in pyodide else Path(pyodide).resolve().as_uri()
        _fetch(address, "pyodide-lock.json", runtime)
        lock = PyodideLockSpec.from_json(runtime / "pyodide-lock.json")
        theirs = set(lock.packages)
        lock = add_wheels_to_spec(lock, _wheels(runtime, theirs), base_path=runtime)
        code = "pyodide.asm.js" if lock.info.version.startswith("0.") else "pyodide.asm.mjs"
        for name, needless in _LEFT_OUT.items():
            if name in lock.packages:
                lock.packages[name].depends = [one for one in lock.packages[name].depends if one != needless]
        for file in (code, *_RUNTIME, *_files(lock, theirs)):
            _fetch(address, file, runtime)
        lock.to_json(runtime / "pyodide-lock.json")
        kernel = {
            "pyodideUrl": "./static/pyodide/pyodide.js",
            "loadPyodideOptions": {"packages": _AT_ONCE, "lockFileURL": "./static/pyodide/pyodide-lock.json"},
            "disablePyPIFallback": True,
        }
        data = {"litePluginSettings": {"@jupyterlite/pyodide-kernel-extension:kernel": kernel}}
        settings = {"jupyter-lite-schema-version": 0, "jupyter-config-data": data | {"exposeAppInBrowser": True}}
        (here / "jupyter-lite.json").write_text(json.dumps(settings), encoding="utf-8")
        _contents(here / "files")
        lite = [sys.executable, "-m", "jupyterlite_core", "build", "--contents", "files", "--no-sourcemaps"]
        subprocess.run([*lite, "--output-dir", str(target)], cwd=here, check=True)
    _finish(target)


def _finish(target):
    """Lead the site to 00, and add to the notebooks' page what saves them. Raises LabError without widgets."""
    missing = [name for name in _WIDGETS if not (target / "extensions" / name).is_dir()]
    if missing:
        lack = " and ".join(missing)
        raise LabError(f"The site would show still pictures: {lack} is not in {sys.prefix}. Build it by that Python.")
    script = Path(__file__).with_name("tab.js").read_text(encoding="utf-8")
    _into_head(target / "index.html", _TO_FIRST)
    _into_head(target / "notebooks" / "index.html", f"<script type='module'>\n{script}</script>")


def _into_head(page, text):
    page.write_text(page.read_text(encoding="utf-8").replace("</head>", f"{text}</head>", 1), encoding="utf-8")


def _fetch(address, file, folder):
    """Fetch one file of a Pyodide. Raises LabError where it is not there."""
    try:
        urllib.request.urlretrieve(f"{address}/{file}", folder / file)
    except OSError as error:
        raise LabError(f"{address}/{file}: {error}. Is this the address of a Pyodide's folder `full`?") from None


def _files(lock, theirs):
    """The files of Pyodide's own packages that the course needs, found from package to package."""
    wanted, found = [*_AT_ONCE, *_WHEN_NEEDED], set()
    while wanted:
        name = wanted.pop().replace("_", "-")
        if name in lock.packages and name not in found:
            found.add(name)
            wanted += lock.packages[name].depends
    return [lock.packages[name].file_name for name in sorted(found & theirs)]


def _wheels(folder, known):
    """The course's wheel, without its notebooks, and the pure ones that Pyodide lacks: paths in the folder."""
    from flit_core import buildapi

    os.chdir(PROJECT)  # where flit looks
    Path("build/wheel").mkdir(parents=True, exist_ok=True)
    shutil.rmtree("build/wheel/share", ignore_errors=True)
    own = folder / buildapi.build_wheel(str(folder))
    missing = [name for name in _PURE if name.replace("_", "-") not in known]
    pure = "--no-deps --only-binary :all: --platform any --implementation py --abi none".split()
    subprocess.run([sys.executable, "-m", "pip", "download", *pure, "-d", str(folder), *missing], check=True)
    return [own, *(next(folder.glob(f"{name}-*-none-any.whl")) for name in missing)]


def _contents(folder):
    """Notebooks and the data that they need, side by side as in the project."""
    pages = [path for path in (PROJECT / "notebooks").glob("[0-9]*.ipynb") if path.name[:2] in NOTEBOOKS]
    for source in (*pages, *(PROJECT / "data" / name for name in _DATA)):
        target = folder / source.relative_to(PROJECT)
        target.parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if source.is_dir() else shutil.copy)(source, target)
    for page in (folder / "notebooks").glob("*.ipynb"):
        page.write_text(re.sub(_TO_NOTEBOOK, _only_here, page.read_text(encoding="utf-8")), encoding="utf-8")


def _only_here(link):
    """A link to a notebook, or what it says where the tab has not got that one."""
    return link[0] if link["file"][:2] in NOTEBOOKS else f"{link['title']} (on your own machine)"


def main():
    """Build the site."""
    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab site", description=__doc__.splitlines()[0])
    parser.add_argument(
        "--pyodide",
        required=True,
        metavar="FOLDER|URL",
        help="a Pyodide with its packages: docs/developing.md, section 'The site of the browser tab'",
    )
    parser.add_argument("--to", default="site", metavar="FOLDER", help="where the site goes (default: site)")
    chosen = parser.parse_args()
    try:
        build(chosen.pyodide.rstrip("/"), Path(chosen.to).resolve())
    except LabError as problem:
        sys.exit(str(problem))


if __name__ == "__main__":
    main()
