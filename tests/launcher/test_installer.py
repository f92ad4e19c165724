"""What pip.conf and PIP_* say, as uv is told; uv asks a server as they say."""

import io
import os
import subprocess
import sys
import time

import pytest

from ir50p_lab.launcher.installer import clock, for_uv

AS_PIP = ["--index-strategy", "unsafe-best-match"]


def listed(folder, config="", **variables):
    """What `pip config list` prints of a configuration file and variables."""
    (folder / "pip.conf").write_text(config)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PIP_")}
    environment |= {"PIP_CONFIG_FILE": str(folder / "pip.conf"), "HOME": str(folder), "XDG_CONFIG_DIRS": str(folder)}
    environment |= variables
    command = [sys.executable, "-m", "pip", "config", "list"]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout


def test_what_pip_prints_is_translated(tmp_path):
    config = "[global]\nindex-url = https://a/simple\ncert = /a.pem\n[install]\nextra-index-url =\n  https://b\n  https://c\n"
    options, variables = for_uv(
        listed(tmp_path, config, PIP_FIND_LINKS="wheels more", PIP_NO_INDEX="0", PIP_CERT="/b.pem")
    )
    assert options[:2] == AS_PIP
    assert sorted(options[2:]) == [
        "--default-index=https://a/simple",
        "--find-links=more",
        "--find-links=wheels",
        "--index=https://b",
        "--index=https://c",
    ]
    assert variables == {"SSL_CERT_FILE": "/b.pem"}  # a variable is stronger than a file


@pytest.mark.parametrize(
    ("line", "options", "variables"),
    [
        (":env:.no-index='1'", ["--no-index"], {}),
        (":env:.constraint='a.txt b.txt'", ["--constraints=a.txt", "--constraints=b.txt"], {}),
        (":env:.trusted-host='mirror:8080\\nother'", [], {"UV_INSECURE_HOST": "mirror:8080 other"}),
        ("global.no-cache-dir='off'", [], {"UV_NO_CACHE": "off"}),
        ("global.proxy='p:3128'", [], dict.fromkeys(("HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY"), "p:3128")),
        ("global.timeout='60'", [], {"UV_HTTP_TIMEOUT": "60"}),
        (":env:.no-cache-dir=''", [], {}),
        ("global.timeout='60'\n:env:.timeout=''", [], {"UV_HTTP_TIMEOUT": "60"}),
        ("download.dest='x'", [], {}),  # for another command
    ],
)
def test_settings(line, options, variables):
    assert for_uv(line) == ([*AS_PIP, *options], variables)


def test_a_setting_without_counterpart():
    assert for_uv("global.index-url='https://a'\n:env:.exists-action='i'") is None
    assert for_uv(":env:.exists-action=''") is not None


def test_a_step_without_a_word_is_seen_to_go_on(monkeypatch):
    screen = io.StringIO()
    screen.isatty = lambda: True
    monkeypatch.setattr(sys, "stdout", screen)

    def shown():
        return {line.strip() for line in screen.getvalue().split("\r") if line.strip()}

    with clock() as last:
        last[0] = "a line"
        until = time.monotonic() + 60
        while len(shown()) < 2 and time.monotonic() < until:
            time.sleep(0.1)
    assert len(shown()) >= 2 and all(line.endswith(" s  a line") for line in shown())


def test_no_seconds_where_nobody_looks(monkeypatch):
    screen = io.StringIO()  # no terminal
    monkeypatch.setattr(sys, "stdout", screen)
    with clock() as last:
        last[0] = "a line"
        time.sleep(0.6)
    assert screen.getvalue() == ""
