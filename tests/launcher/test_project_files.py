"""The project's own files agree with each other: bounds and lock files, README and what it names."""

import json
import re
import subprocess
import tomllib
from importlib import import_module

import nbformat
import pytest
import yaml
from mini_project import PROJECT
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name
from packaging.version import Version

from ir50p_lab.course.publishing import colab

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
    assert student.items() <= tests.items(), "the two lock files disagree: refresh both (docs/developing.md)"


def test_lock_files_name_no_address():
    for name in ("environment.txt", "environment-test.txt"):
        assert not re.search(r"://|--(extra-)?index-url|--find-links|file:", (PROJECT / name).read_text("utf-8"))


def test_readme_lists_the_notebooks_that_exist():
    text = (PROJECT / "README.md").read_text("utf-8")
    listed = re.findall(r"^\| \[`([\dA]\d_\w+)`\].*\| (\d+|to look up)(?:, core \d+)?[^|]* \|$", text, flags=re.M)
    notebooks = sorted(path.stem for path in (PROJECT / "notebooks").glob("*.ipynb"))
    assert [name for name, _ in listed] == notebooks
    for name, minutes in listed:
        said = "A dictionary" if minutes == "to look up" else f"about {minutes} minutes"
        assert said in (PROJECT / "notebooks" / f"{name}.ipynb").read_text("utf-8")


def test_other_places_install_from_the_lock_and_take_the_pythons_of_the_project():
    python = tomllib.loads((PROJECT / "pyproject.toml").read_text("utf-8"))["project"]["requires-python"]
    for path in sorted((PROJECT / ".github" / "workflows").glob("*.yml")):
        jobs = yaml.safe_load(path.read_text("utf-8"))["jobs"]
        for job in jobs.values():
            matrix = job.get("strategy", {}).get("matrix", {})
            versions = [*matrix.get("python", []), *(one["python"] for one in matrix.get("include", []))]
            assert all(version in SpecifierSet(python) for version in versions)
            commands = " ".join(step.get("run", "") for step in job["steps"])
            assert "-m ir50p_lab" in commands and not re.search(
                r"pip install (?!.*(-r environment|--no-deps))", commands
            )
    container = json.loads((PROJECT / ".devcontainer" / "devcontainer.json").read_text("utf-8"))
    assert container["postCreateCommand"].endswith("-m ir50p_lab setup")
    assert (PROJECT / ".binder" / "requirements.txt").read_text("utf-8").strip() == "-r ../environment.txt"
    assert (PROJECT / ".binder" / "runtime.txt").read_text("utf-8").strip().removeprefix("python-") in SpecifierSet(
        python
    )
    subprocess.run(["bash", "-n", str(PROJECT / ".binder" / "postBuild")], check=True)


def test_copies_for_colab_are_the_notebooks_behind_a_first_cell(tmp_path):
    colab.write(tmp_path)
    for path in tmp_path.iterdir():
        first, *rest = nbformat.read(path, as_version=4).cells
        assert "git clone" in first.source and "ir50p-lab.git" in first.source
        assert rest == nbformat.read(PROJECT / "notebooks" / path.name, as_version=4).cells
    assert len(list(tmp_path.iterdir())) == len(list((PROJECT / "notebooks").glob("*.ipynb")))


PAGES = [PROJECT / "README.md", *sorted((PROJECT / "docs").glob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for path in re.findall(r"\]\((?!http)([^)#]+)", page.read_text("utf-8")):
        assert (page.parent / path).exists(), path


def test_a_visitor_finds_every_page_from_the_readme_and_reads_nothing_twice():
    texts = [page.read_text("utf-8") for page in PAGES if page.name != "index_of_equations.md"]
    assert texts[0].count("\n") <= 80
    assert all(f"docs/{page.name}" in texts[0] for page in PAGES[1:])
    prose = [re.sub(r"\s+", " ", re.sub(r"^(?:    |\|).*$", "", text, flags=re.M)) for text in texts]
    sentences = [one for text in prose for one in re.split(r"(?<=[.:]) ", text) if len(one) > 40]
    assert len(sentences) == len(set(sentences)), {one for one in sentences if sentences.count(one) > 1}


def test_the_published_address_is_the_same_everywhere():
    address = tomllib.loads((PROJECT / "pyproject.toml").read_text("utf-8"))["project"]["urls"]["Homepage"]
    host = address.split("/")[2]
    assert address in (PROJECT / "CITATION.cff").read_text("utf-8")
    for name in ("README.md", "CITATION.cff"):
        text = (PROJECT / name).read_text("utf-8")
        assert not re.search(rf"https://(?!{re.escape(host)})\S*ir50p", text)
    assert ".example" not in (PROJECT / "README.md").read_text("utf-8")  # nothing that a reader clicks leads nowhere


def test_what_the_pages_name_exists():
    table = (PROJECT / "docs" / "from_matlab.md").read_text("utf-8")
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
    layout = (PROJECT / "docs" / "developing.md").read_text("utf-8")
    for folder in re.findall(r"^      (\w+)/ ", layout, flags=re.M):
        assert (PROJECT / "ir50p_lab" / folder).is_dir(), folder
