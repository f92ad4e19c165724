"""In CI a skipped test is a failure: a run must not pass by leaving things out. Marks and what they leave out.

What JupyterLab has stored in a notebook is left out too, and said.
"""

import os
from functools import cache

import pytest
from hypothesis import settings
from marks import MARKS, TESTS

# no deadline: a first call may compile; the same examples in every run: a failure can be repeated
settings.register_profile("lab", deadline=None, derandomize=True)
settings.load_profile("lab")


@pytest.fixture(scope="session", autouse=True)
def students_folder(tmp_path_factory):
    """No test reads or writes what belongs to whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("IR50P_HOME", str(tmp_path_factory.mktemp("home")))
        yield


def pytest_addoption(parser):
    parser.addoption("--quick", action="store_true", help="without notebooks, the emulated board, and what takes long")
    parser.addoption("--all", action="store_true", help="notebooks with their dots, too, and what is marked `ci`")
    parser.addoption("--timing", choices=("only", "without"), help="only tests that measure time, or all others")


def pytest_collection_modifyitems(config, items):
    """Mark whole files and folders, then leave out what the options leave out."""
    for item in items:
        for mark in _marks_of(item.path):
            item.add_marker(mark)
    option = config.option
    option.ci = option.all or option.keyword or config.args != config.getini("testpaths")  # or by its name
    kept = [item for item in items if _is_asked_for(item, option)]
    chosen = set(kept)
    config.hook.pytest_deselected(items=[item for item in items if item not in chosen])
    items[:] = sorted(
        kept, key=lambda item: item.get_closest_marker("notebook") is None
    )  # the longest do not begin last


@cache
def _marks_of(path):
    return {mark for place, marks in MARKS.items() if path.is_relative_to(TESTS / place) for mark in marks.split()}


def _is_asked_for(item, option):
    marks = {mark.name for mark in item.iter_markers()}
    if option.quick and marks & {"notebook", "emulator", "slow", "timing"}:
        return False
    if "ci" in marks and not option.ci:
        return False
    return option.timing is None or (option.timing == "only") == ("timing" in marks)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session):
    skipped = _skipped(session.config)
    if (
        os.environ.get("CI")
        and skipped
        and session.exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
    ):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_runtest_logreport(report):
    """Name a notebook when it is done: a run of all tests takes minutes."""
    if report.when == "call" and "notebook" in report.keywords and not os.environ.get("PYTEST_XDIST_WORKER"):
        print(f"\n{report.nodeid.rpartition('::')[2]} {report.outcome} after {report.duration:.0f} s", flush=True)


def pytest_terminal_summary(terminalreporter, config):
    skipped = _skipped(config)
    if os.environ.get("CI") and skipped:
        terminalreporter.section("skipped tests fail in CI", red=True)
        for report in skipped:
            terminalreporter.line(f"{report.nodeid}: {report.longrepr[2] if report.longrepr else ''}")
    if any(report.nodeid.startswith("tests/notebooks/") for report in _reports(terminalreporter)):
        import stripped  # nbformat takes a while

        for sentence in stripped.sentences():
            terminalreporter.line(sentence)


def _reports(terminalreporter):
    return [report for outcome in ("passed", "failed") for report in terminalreporter.stats.get(outcome, [])]


def _skipped(config):
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    return reporter.stats.get("skipped", []) if reporter else []
