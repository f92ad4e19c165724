"""Whatever is handed in: a verdict, nothing written, and the next function is judged all the same."""

import subprocess
import sys
import zipfile
from types import SimpleNamespace

import pytest

from ir50p_lab.course.grading import sandbox
from ir50p_lab.course.grading.submissions import submissions
from ir50p_lab.modelling import IR50P, forward_kinematics

_LIMITS = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such limits")


def test_the_compiled_code_is_there(tmp_path):
    """Else each student's process compiles all of it anew."""
    forward_kinematics(IR50P, [0.1, 0.2, 0.3])
    look = "from ir50p_lab.jit import cache_folder; print(*cache_folder().rglob('*.nbi'))"
    assert subprocess.check_output([*sandbox.bubblewrap(tmp_path), sys.executable, "-c", look]).strip()


def _verdict(text, seconds=60):
    """Of a rot_z, with a second function behind it that is wrong in a plain way."""
    found = sandbox.verdicts({"rot_z": text, "dh_matrix": "def dh_matrix(theta):\n    return 0\n"}, [], seconds)
    assert found["dh_matrix"][0] == "wrong" and "it takes (theta)" in found["dh_matrix"][1]
    return found["rot_z"]


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("    while True:\n        pass", "does a loop in it never end?"),
        ("    while True:\n        __import__('os').fork()", "not run: "),
        ("    np.savetxt('written', np.eye(3))\n    return np.eye(3)", "not run: it uses `savetxt`"),
        ("    return np.lib._npyio_impl.os", "not run: it uses `os`"),
    ],
)
def test_a_hostile_function_is_wrong_and_the_next_is_judged(body, says):
    state, said = _verdict(f"def rot_z(angle):\n{body}\n")
    assert state == "wrong" and says in said


def _locked_up(code, folder):
    program = f"from ir50p_lab.course.grading import inside\ninside.lock_up()\nimport os\n{code}"
    return subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, timeout=60)


@_LIMITS
@pytest.mark.parametrize(
    ("code", "error"),
    [
        ("while True: os.fork()", "BlockingIOError"),
        ("open('written', 'w').write('x' * 100000)", "Error"),
        ("bytearray(12 << 30)", "MemoryError"),
    ],
)
def test_who_gets_past_the_gate_meets_the_limits(code, error, tmp_path):
    if "12 <<" in code and sys.platform != "linux":
        pytest.skip("macOS has no limit of memory")
    done = _locked_up(code, tmp_path)
    assert error in done.stderr
    written = tmp_path / "written"
    assert not written.exists() or written.stat().st_size == 0


def test_a_process_that_ends_early_is_one_wrong_function(monkeypatch):
    asked = []
    monkeypatch.setattr(sandbox, "_run", lambda left, *_: asked.append(list(left)) or {next(iter(left)): ("right", "")})
    found = sandbox.verdicts(dict.fromkeys("abcd", ""), [])
    assert [state for state, _ in found.values()] == ["right", "wrong", "right", "wrong"]
    assert "its process ended" in found["b"][1] and asked == [["a", "b", "c", "d"], ["c", "d"]]


def _zipped(folder, content):
    with zipfile.ZipFile(folder / "mallory.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in content.items():
            archive.writestr(name, text)
    (made,) = submissions(folder)
    return made


def test_a_zip_bomb_is_not_unpacked(tmp_path):
    made = _zipped(tmp_path, {"notebooks/my_robot/_rot_z.py": "#" * 50_000_000})
    assert made.functions == {} and "_rot_z.py has more than 100,000 bytes" in made.trouble


@pytest.mark.parametrize("name", ["../../my_robot/_rot_z.py", "/etc/my_robot/_rot_z.py", "C:\\my_robot\\_rot_z.py"])
def test_a_path_out_of_the_zip_is_refused(name, tmp_path):
    made = _zipped(tmp_path, {name: "def rot_z(angle):\n    return 1\n"})
    assert made.functions == {} and "leads out of it" in made.trouble


def test_what_is_no_zip_and_what_is_no_lab_book_is_said(tmp_path):
    (tmp_path / "a.zip").write_text("nothing")
    with zipfile.ZipFile(tmp_path / "b.zip", "w") as archive:
        archive.writestr("notebooks/my_robot/_rot_z.py", "x = 1\n")
        archive.writestr("notebooks/results/lab_book.json", "[" * 100_000)
    broken, odd = submissions(tmp_path)
    assert broken.trouble and odd.trouble and odd.functions == {"rot_z": "x = 1\n"}


@_LIMITS
def test_a_link_out_of_a_folder_is_not_followed(tmp_path):
    (tmp_path / "secret").write_text("the lecturer's")
    (tmp_path / "class" / "eve" / "my_robot").mkdir(parents=True)
    (tmp_path / "class" / "eve" / "my_robot" / "_rot_z.py").symlink_to(tmp_path / "secret")
    (made,) = submissions(tmp_path / "class")
    assert made.functions == {} and "not a plain file" in made.trouble


def test_a_forged_line_that_is_no_verdict_counts_for_nothing(monkeypatch):
    said = b'["rot_z", "right", ""]\n["rot_z", "best", ""]\n'
    ended = SimpleNamespace(pid=2**22 + 1, kill=lambda: None, communicate=lambda *_, **__: (said, b""))
    monkeypatch.setattr(sandbox.subprocess, "Popen", lambda *_, **__: ended)
    assert sandbox._run({"rot_z": ""}, [], 1) == {"rot_z": ("right", "")}
    said = b"forged\n"
    assert sandbox._run({"rot_z": ""}, [], 1) == {}
