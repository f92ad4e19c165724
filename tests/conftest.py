"""In CI a skipped test is a failure: a run must not pass by leaving things out."""

import os

import pytest
from hypothesis import settings

# no deadline: a first call may compile; the same examples in every run: a failure can be repeated
settings.register_profile("lab", deadline=None, derandomize=True)
settings.load_profile("lab")


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
