"""The course as a site that runs in a browser tab (JupyterLite): `python3 -m ir50p_lab site --pyodide FOLDER|URL`.

Needs `jupyterlite-core`, `jupyterlite-pyodide-kernel`, `jupyter-server`, `pyodide-lock[wheel]`, and a Pyodide with its
packages. The course's wheel and the pure packages that Pyodide has not go into its lock: `import ir50p_lab` in a cell
then loads all it needs.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import urllib.request
from pathlib import Path

from ir50p_lab.errors import LabError
from ir50p_lab.home import PROJECT

NOTEBOOKS = ("00", "01", "02", "03", "08")  # which run in a tab, and in CI without numba, OpenCV, pyserial and loky
_DATA = ("first_reach.csv", "first_reach.jpg", "drawings", "arm_example.toml")
_PURE = "anywidget ipywidgets comm psygnal typing_extensions jupyterlab_widgets widgetsnbextension lazy_loader".split()
_PURE += "cloudpickle tomlkit tqdm sympy mpmath".split()
_AT_ONCE = ["ir50p-lab", "ipython", "jedi", "sqlite3", "comm"]  # fetched while the page opens


def build(pyodide, target):
    """Write the site into a folder. pyodide: folder or address, with pyodide.js and pyodide-lock.json."""
    try:
        from pyodide_lock import PyodideLockSpec
        from pyodide_lock.utils import add_wheels_to_spec
    except ImportError:
        remedy = "pip install jupyterlite-core jupyterlite-pyodide-kernel 'pyodide-lock[wheel]'"
        raise LabError(f"what builds the site is not in the course's environment: {remedy}") from None
    remote = pyodide.startswith("http")
    with tempfile.TemporaryDirectory() as room:
        here = Path(room)
        place = "static/course" if remote else "static/pyodide"  # what lies in the second, JupyterLite copies
        runtime = here / place
        runtime.mkdir(parents=True)
        if remote:
            urllib.request.urlretrieve(f"{pyodide}/pyodide-lock.json", runtime / "pyodide-lock.json")
        else:
            shutil.copytree(pyodide, runtime, dirs_exist_ok=True)
        lock = PyodideLockSpec.from_json(runtime / "pyodide-lock.json")
        for package in lock.packages.values() if remote else ():
            package.file_name = f"{pyodide}/{package.file_name}"
        lock = add_wheels_to_spec(lock, _wheels(runtime, set(lock.packages)), base_path=runtime)
        lock.to_json(runtime / "pyodide-lock.json")
        kernel = {
            "pyodideUrl": f"{pyodide}/pyodide.js" if remote else "./static/pyodide/pyodide.js",
            "loadPyodideOptions": {"packages": _AT_ONCE, "lockFileURL": f"./{place}/pyodide-lock.json"},
            "disablePyPIFallback": True,
        }
        data = {"litePluginSettings": {"@jupyterlite/pyodide-kernel-extension:kernel": kernel}}
        settings = {"jupyter-lite-schema-version": 0, "jupyter-config-data": data | {"exposeAppInBrowser": True}}
        (here / "jupyter-lite.json").write_text(json.dumps(settings), encoding="utf-8")
        _contents(here / "files")
        lite = [sys.executable, "-m", "jupyterlite_core", "build", "--contents", "files", "--no-sourcemaps"]
        subprocess.run([*lite, "--output-dir", str(Path(target).resolve())], cwd=here, check=True)
        shutil.copytree(runtime, Path(target) / place, dirs_exist_ok=True)


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


def main():
    """Build the site."""
    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab site", description=__doc__.splitlines()[0])
    parser.add_argument("--pyodide", required=True, metavar="FOLDER|URL", help="a Pyodide with its packages")
    parser.add_argument("--to", default="site", metavar="FOLDER", help="where the site goes (default: site)")
    chosen = parser.parse_args()
    build(chosen.pyodide.rstrip("/"), Path(chosen.to).resolve())


if __name__ == "__main__":
    main()
