"""A headless Chromium, a JupyterLab of its own, and pages without a kernel, for what only a browser can show."""

import json
import os
import secrets
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from contextlib import contextmanager
from pathlib import Path

import nbformat
import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
ARGUMENTS = ["--no-sandbox", "--disable-dev-shm-usage", "--disable-background-networking", "--disable-component-update",
             "--disable-renderer-backgrounding", "--disable-background-timer-throttling"]  # fmt: skip

KERNEL_IDLE = "() => window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel?.status === 'idle'"
RUN_ALL = "() => { jupyterapp.commands.execute('notebook:run-all-cells'); }"


@pytest.fixture(scope="session")
def chromium():
    if CHROMIUM is None:
        pytest.skip("no Chromium here (Debian: apt-get install chromium): pages were not looked at in a browser")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        yield driver.chromium


@pytest.fixture(scope="session")
def browser_path():
    return CHROMIUM


@pytest.fixture(scope="session")
def browser(chromium):
    browser = chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS, timeout=90_000)
    yield browser
    browser.close()


@pytest.fixture
def page(browser):
    """A page that fails its test if anything goes wrong in the browser."""
    context = browser.new_context(viewport={"width": 1200, "height": 1000})
    page = context.new_page()
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    yield page
    context.close()
    assert not errors, errors


@pytest.fixture(scope="session")
def lab(tmp_path_factory):
    """Address of a JupyterLab on the demo page: its own settings, port and token."""
    home = tmp_path_factory.mktemp("lab")
    shutil.copy(Path(__file__).parent / "live_arm.ipynb", home)
    with running_lab(home) as (address, _):
        yield address.format("live_arm.ipynb")


def free_port():
    """A port below those that the system hands out by itself: the kernels of other tests take these at any time."""
    while True:
        port = 10_000 + secrets.randbelow(20_000)
        with socket.socket() as one:
            if one.connect_ex(("127.0.0.1", port)) != 0:
                return port


@contextmanager
def running_lab(home, app="jupyterlab", **variables):
    """A JupyterLab (or `notebook`) on a folder: the address of a notebook, with {} for its name, and the process."""
    settings = home / "settings" / "@jupyterlab" / "notebook-extension"
    settings.mkdir(parents=True, exist_ok=True)
    (settings / "tracker.jupyterlab-settings").write_text(json.dumps({"windowingMode": "none"}))
    port = free_port()
    token = secrets.token_hex(16)
    variables |= {
        "JUPYTERLAB_SETTINGS_DIR": str(home / "settings"),
        "JUPYTERLAB_WORKSPACES_DIR": str(home / "workspaces"),
        "JUPYTER_CONFIG_DIR": str(home / "config"),
        "JUPYTER_RUNTIME_DIR": str(home / "runtime"),
        "JUPYTER_TOKEN": token,
        "PYTHONPATH": str(Path(__file__).parents[2]),
    }
    command = ["-m", app, "--no-browser", "--allow-root", f"--port={port}", "--expose-app-in-browser"]
    command += ["--ServerApp.port_retries=0", f"--ServerApp.root_dir={home}", "--LabApp.news_url=None"]
    with open(home / "log", "w") as log:
        environment = os.environ | variables
        server = subprocess.Popen([sys.executable, *command], env=environment, stdout=log, stderr=log, cwd=home)
    address = f"http://127.0.0.1:{port}"
    try:
        _wait_for(f"{address}/api?token={token}", server, home / "log")
        yield f"{address}/{'lab/tree' if app == 'jupyterlab' else 'notebooks'}/{{}}?token={token}", server
    finally:
        server.terminate()
        try:
            server.wait(60)
        except subprocess.TimeoutExpired:  # a busy machine: it waits for its kernels
            server.kill()
            server.wait()


def write_notebook(path, *cells):
    """Write a notebook of code cells for this kernel."""
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    cells = list(map(nbformat.v4.new_code_cell, cells))
    nbformat.write(nbformat.v4.new_notebook(cells=cells, metadata={"kernelspec": kernel}), path)


def open_in_lab(page, address):
    """Open a notebook, and wait until its kernel is idle."""
    page.goto(address, wait_until="commit")
    page.wait_for_function(KERNEL_IDLE, timeout=90_000)


def _wait_for(address, server, log):
    deadline = time.monotonic() + 180
    while True:
        assert server.poll() is None and time.monotonic() < deadline, log.read_text()
        try:
            urllib.request.urlopen(address, timeout=2).close()
            return
        except OSError:
            time.sleep(0.2)
