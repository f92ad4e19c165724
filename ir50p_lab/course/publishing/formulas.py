"""LaTeX formulas as MathML."""

import html
import re

from latex2mathml.converter import convert

_FORMULA = re.compile(r"\$\$(.+?)\$\$|\$(.+?)\$", re.DOTALL)


def mathml(latex, *, block=False):
    """Return a formula as MathML with its LaTeX as alternative text, or as LaTeX if the converter does not know it."""
    try:
        return convert(latex.strip(), display="block" if block else "inline").replace(
            "<math ", f'<math alttext="{html.escape(latex.strip())}" ', 1
        )
    except Exception:  # the converter raises whatever it stumbles over
        return f"<code>{html.escape(latex)}</code>"


def mathml_in(output):
    """Return a cell's output with its LaTeX as HTML."""
    data = output.get("data", {})
    if "text/latex" in data and "text/html" not in data:
        latex = data.pop("text/latex")
        formulas = _FORMULA.sub(lambda found: mathml(found[1] or found[2], block=True), latex)
        data["text/html"] = formulas if "<" in formulas else mathml(latex, block=True)
    return output
