"""Names loaded on first use keep the cause when that fails, and name a file that hides a package."""

import subprocess
import sys

import pytest

CAUSES = {
    "cv2": "raise AttributeError('_ARRAY_API not found')",
    "numba": "raise AttributeError(\"module 'numpy' has no attribute 'long'\")",
    "anywidget": "raise ImportError('DLL load failed')",
}
USERS = {
    "cv2": "from ir50p_lab.vision import calibrate",
    "numba": "from ir50p_lab.modelling import mass_matrix",
    "anywidget": "from ir50p_lab.course import LiveArm",
}


def last_line(code, folder):
    variables = {"PYTHONPATH": f"{folder}:{':'.join(path for path in sys.path if path)}", "PATH": "/usr/bin:/bin"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=variables, capture_output=True, encoding="utf-8"
    )
    return done.stderr.splitlines()[-1]


@pytest.mark.parametrize("package", CAUSES)
def test_the_cause_is_kept_and_the_file_that_hides_a_package_is_named(tmp_path, package):
    (tmp_path / f"{package}.py").write_text(CAUSES[package])
    said = last_line(USERS[package], tmp_path)
    assert said.startswith("ir50p_lab.errors.DependencyError: ")
    assert CAUSES[package].split("(")[1].strip("')\"")[:20] in said
    assert f"{package}.py hides the package {package}: rename it" in said


def test_a_folder_that_hides_a_package_is_named_and_a_file_that_nobody_loads_is_not(tmp_path):
    (tmp_path / "code.py").touch()
    (tmp_path / "cv2").mkdir()
    (tmp_path / "cv2" / "__init__.py").touch()
    said = last_line(USERS["cv2"], tmp_path)
    assert f"{tmp_path / 'cv2'} hides the package cv2: rename it" in said


@pytest.mark.parametrize(
    ("package", "text", "code"),
    [
        ("numba", "raise ImportError('Numba needs NumPy 2.0 or less')", USERS["numba"]),
        ("serial", "", "from ir50p_lab.bench import connect; connect()"),
    ],
)
def test_what_a_browser_tab_does_without_is_not_done_without_where_it_fails(tmp_path, package, text, code):
    """A numba that does not work is no reason for slow loops, nor a hidden pyserial for a bench without a board."""
    (tmp_path / f"{package}.py").write_text(text)
    said = last_line(code, tmp_path)
    assert said.startswith("ir50p_lab.errors.DependencyError: ")
    assert f"{package}.py hides the package {package}: rename it" in said


def test_a_name_that_does_not_exist_is_told_as_ever(tmp_path):
    assert "cannot import name 'calibrato'" in last_line("from ir50p_lab.vision import calibrato", tmp_path)


def test_a_package_that_is_missing_is_named_with_what_installs_it(tmp_path):
    said = last_line("import sys; sys.modules['cv2'] = None; from ir50p_lab.vision import find_balls", tmp_path)
    assert "find_balls could not be loaded" in said and "cv2 is not installed: 'python3 -m ir50p_lab setup'" in said
