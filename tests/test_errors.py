"""The tree on top of `errors.py` is the one of its classes."""

import inspect
import re

from ir50p_lab import errors


def test_the_tree_on_top_is_that_of_the_classes():
    classes = {name: one for name, one in vars(errors).items() if inspect.isclass(one)} | {"UserWarning": UserWarning}
    shown = []
    for line in (line for line in errors.__doc__.splitlines() if line.startswith("    ")):
        names = re.findall(r"(\w+(?:Error|Warning))\b( \*)?", line)
        above = classes[names[0][0]]
        assert above.__bases__[0] is errors.LabError or "─" not in line
        for name, star in names:
            assert classes[name] is above or classes[name].__bases__[0] is above, name
            assert issubclass(classes[name], ValueError) == bool(star), name
        shown += [name for name, _ in names]
    assert sorted(shown) == sorted(classes)
