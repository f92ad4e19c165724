"""README's table and the openings say how long a rewritten notebook takes, as it is counted."""

import minutes
import nbformat


def test_the_minutes_are_those_counted():
    command = "run tests/notebooks/minutes.py"
    readme = minutes.README.read_text(encoding="utf-8")
    assert readme == minutes.filled(readme), command
    instructor = minutes.INSTRUCTOR.read_text(encoding="utf-8")
    assert instructor == minutes.planned(instructor), command
    for path in minutes.rewritten():
        assert f"`{path.stem}`" in readme
        assert path.read_text(encoding="utf-8") == minutes.opening(path), command


def test_a_notebook_is_counted_by_the_rule(tmp_path):
    code = 'predict("a", ..., "m")\ncheck("rot_z", rot_z)\nLiveArm(arm)\n' + "x = 1\n" * 21
    text, code = nbformat.v4.new_markdown_cell("word " * 750), nbformat.v4.new_code_cell(code)
    path = tmp_path / "00_x.ipynb"
    nbformat.write(nbformat.v4.new_notebook(cells=[text, code]), path)
    assert minutes.minutes(path) == 30  # 7 of words, 3 of a prediction, 6 of a function, 2 of a panel, 12 of code: 30
