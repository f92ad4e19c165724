"""The text of a function of the student's, as it stands in its file."""

import ast
from dataclasses import dataclass

GIVEN = {"np": "import numpy as np", "numpy": "import numpy", "math": "import math"}


@dataclass(frozen=True)
class Source:
    """The text of a function and its helpers, and which earlier functions of `my_robot` it calls."""

    name: str
    text: str
    calls: tuple

    @property
    def module(self):
        """The text of the file that holds it: imports, then the student's lines."""
        names = {one.id for one in ast.walk(ast.parse(self.text)) if isinstance(one, ast.Name)}
        imports = [line for name, line in GIVEN.items() if name in names]
        imports += [f"from ._{name} import {name}" for name in self.calls]
        return "\n".join([*imports, "", "", self.text, ""]) if imports else self.text + "\n"
