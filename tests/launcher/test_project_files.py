"""The project's own files agree with each other: bounds and lock files, README and what it names."""

import re
import tomllib
from importlib import import_module

import pytest
from mini_project import PROJECT
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

SYSTEMS = [
    {"sys_platform": "linux", "os_name": "posix", "platform_system": "Linux", "platform_machine": "x86_64"},
    {"sys_platform": "win32", "os_name": "nt", "platform_system": "Windows", "platform_machine": "AMD64"},
    {"sys_platform": "darwin", "os_name": "posix", "platform_system": "Darwin", "platform_machine": "arm64"},
    {"sys_platform": "darwin", "os_name": "posix", "platform_system": "Darwin", "platform_machine": "x86_64"},
]
PYTHONS = ["3.11", "3.12", "3.13", "3.14"]


def locked(name, environment):
    """{package: version} that a lock file asks of a system; every line must be an exact version."""
    found = {}
    for line in (PROJECT / name).read_text("utf-8").splitlines():
        if line.startswith("#"):
            continue
        requirement = Requirement(line)
        (bound,) = requirement.specifier
        assert bound.operator == "==", line
        if requirement.marker is None or requirement.marker.evaluate(environment):
            key = canonicalize_name(requirement.name)
            assert key not in found, f"{name} asks for two versions of {key}"
            found[key] = Version(bound.version)
    return found


@pytest.mark.parametrize("python", PYTHONS)
@pytest.mark.parametrize("system", SYSTEMS, ids=lambda s: f"{s['sys_platform']}-{s['platform_machine']}")
def test_lock_files_hold_what_pyproject_asks_for(system, python):
    environment = default_environment() | system | {"python_version": python, "python_full_version": f"{python}.9"}
    project = tomllib.loads((PROJECT / "pyproject.toml").read_text("utf-8"))["project"]
    student, tests = locked("environment.txt", environment), locked("environment-test.txt", environment)
    for requirement in map(Requirement, project["dependencies"]):
        assert student[canonicalize_name(requirement.name)] in requirement.specifier
    for requirement in map(Requirement, project["optional-dependencies"]["test"]):
        assert tests[canonicalize_name(requirement.name)] in requirement.specifier
        assert canonicalize_name(requirement.name) not in student, "a test tool in the student's lock"
    assert student.items() <= tests.items(), "the two lock files disagree: refresh both (README.md)"


def test_lock_files_name_no_address():
    for name in ("environment.txt", "environment-test.txt"):
        assert not re.search(r"://|--(extra-)?index-url|--find-links|file:", (PROJECT / name).read_text("utf-8"))


def test_readme_lists_the_notebooks_that_exist():
    text = (PROJECT / "README.md").read_text("utf-8")
    listed = re.findall(r"^\| `([\dA]\d_\w+)` \|.*\| (\d+) \| no \|$", text, flags=re.M)
    notebooks = sorted(path.stem for path in (PROJECT / "notebooks").glob("*.ipynb"))
    assert [name for name, _ in listed] == notebooks
    for name, minutes in listed:
        assert f"about {minutes} minutes" in (PROJECT / "notebooks" / f"{name}.ipynb").read_text("utf-8")


def test_readme_names_only_what_exists():
    text = (PROJECT / "README.md").read_text("utf-8")
    for path in re.findall(r"\]\((?!http)([^)]+)\)", text):
        assert (PROJECT / path).exists(), path
    table = text[text.index("## From MATLAB") : text.index("## The lock files")]
    names = [
        *((f"ir50p_lab.{m}", n) for m, n in re.findall(r"`ir50p_lab\.(\w+)\.(\w+)", table)),
        *(("ir50p_lab.modelling", n) for n in re.findall(r"`(\w+)\((?:arm, (?:q|p)[^`]*)?\)`", table)),
        *(
            (f"ir50p_lab.{m}", n)
            for m, names in re.findall(r"`ir50p_lab\.(\w+)`: ((?:`\w+`(?:, )?)+)", table)
            for n in re.findall(r"\w+", names)
        ),
    ]
    assert len(names) > 12, "the patterns above no longer find what the table names"
    for module, name in names:
        assert hasattr(import_module(module), name), f"{module}.{name}"
    layout = text[text.index("## Layout") :]
    for folder in re.findall(r"^      (\w+)/ ", layout, flags=re.M):
        assert (PROJECT / "ir50p_lab" / folder).is_dir(), folder
