"""In CI a skipped test is a failure: a run must not pass by leaving things out. Marker `compiled`."""

import os

import pytest
from hypothesis import settings

# no deadline: a first call may compile; the same examples in every run: a failure can be repeated
settings.register_profile("lab", deadline=None, derandomize=True)
settings.load_profile("lab")


def pytest_collection_modifyitems(config, items):
    """Without the compiler, tests marked `compiled(keep=n)` stay out, but for the first n cases of each.

    The coverage run goes without it, so that jitted lines count, a hundred times slower. What is left out there runs
    compiled in the main run, and the cases kept reach the same lines.
    """
    if os.environ.get("NUMBA_DISABLE_JIT") != "1":
        return
    seen, out = {}, []
    for item in items:
        marker = item.get_closest_marker("compiled")
        if marker is not None:
            name = item.nodeid.partition("[")[0]
            seen[name] = seen.get(name, 0) + 1
            if seen[name] > marker.kwargs.get("keep", 0):
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
