"""In CI a skipped test is a failure: a run must not pass by leaving things out. Marker `compiled`."""

import os
from collections import Counter

import pytest
from hypothesis import settings

UNCOMPILED = os.environ.get("NUMBA_DISABLE_JIT") == "1"  # the run that counts jitted lines, a hundred times slower

# no deadline: a first call may compile; the same examples in every run: a failure can be repeated
settings.register_profile("lab", deadline=None, derandomize=True)
settings.register_profile("uncompiled", settings.get_profile("lab"), max_examples=3)
settings.load_profile("uncompiled" if UNCOMPILED else "lab")


@pytest.fixture(scope="session", autouse=True)
def students_folder(tmp_path_factory):
    """No test reads or writes what belongs to whoever runs it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("IR50P_HOME", str(tmp_path_factory.mktemp("home")))
        yield


def pytest_collection_modifyitems(config, items):
    """Without the compiler, only the first two cases of a test run; the first n of one marked `compiled(keep=n)`.

    All cases run compiled in the main run; the few here are to reach the same lines.
    """
    if not UNCOMPILED:
        return
    seen, out = Counter(), []
    for item in items:
        marker = item.get_closest_marker("compiled")
        name = item.nodeid.partition("[")[0]
        seen[name] += 1
        if seen[name] > (2 if marker is None else marker.kwargs.get("keep", 0)):
            out.append(item)
    config.hook.pytest_deselected(items=out)
    items[:] = [item for item in items if item not in set(out)]


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session):
    skipped = _skipped(session.config)
    if (
        os.environ.get("CI")
        and skipped
        and session.exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
    ):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter, config):
    skipped = _skipped(config)
    if os.environ.get("CI") and skipped:
        terminalreporter.section("skipped tests fail in CI", red=True)
        for report in skipped:
            terminalreporter.line(f"{report.nodeid}: {report.longrepr[2] if report.longrepr else ''}")


def _skipped(config):
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    return reporter.stats.get("skipped", []) if reporter else []
