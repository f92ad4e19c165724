"""README's table and the openings say how long a rewritten notebook takes, as it is counted."""

import minutes


def test_the_minutes_are_those_counted():
    command = "run tests/notebooks/minutes.py"
    readme = minutes.README.read_text(encoding="utf-8")
    assert readme == minutes.filled(readme), command
    instructor = minutes.INSTRUCTOR.read_text(encoding="utf-8")
    assert instructor == minutes.planned(instructor), command
    for path in minutes.rewritten():
        assert f"`{path.stem}`" in readme
        assert path.read_text(encoding="utf-8") == minutes.opening(path), command
