"""Formulas that are easy to read: c_23 for cos(q2 + q3), one equation per line, masses before lengths before sines."""

import re

import sympy

_ORDER = {"I": 1, "j": 2, "m": 3, "g": 4, "c": 6, "s": 6, "q": 7}  # place in a product; of a length: 5
_LINE = 105  # visible characters that fit on a line of a notebook, roughly


def short_names(q):
    """Return {cos(q2 + q3): c_{23}, ...}, the short symbols for sine and cosine of q1, q2, q3 and q2 + q3."""
    angles = {"1": q[0], "2": q[1], "3": q[2], "23": q[1] + q[2]}
    functions = ((sympy.cos, "c"), (sympy.sin, "s"))
    return {f(angle): sympy.Symbol(f"{letter}_{{{name}}}") for name, angle in angles.items() for f, letter in functions}


class Formulas:
    """Named formulas, which a notebook shows as aligned equations; `rows` is a tuple of (name in LaTeX, expression)."""

    def __init__(self, rows):
        self.rows = tuple(rows)

    def __repr__(self):
        return "\n".join(f"{re.sub('[{}]', '', name)} = {expression}" for name, expression in self.rows)

    def _repr_latex_(self):
        lines = []
        for name, expression in self.rows:
            first, *more = _lines(expression)
            lines.append(f"{name} &= {first}")
            lines += [rf"&\quad {line if line.startswith('-') else '+ ' + line}" for line in more]
        return r"$\displaystyle \begin{aligned}" + r"\\[4pt] ".join(lines) + r"\end{aligned}$"


def _lines(expression):
    """LaTeX of an expression, one term a line if it is too long for one line."""
    whole = _latex(expression)
    if len(re.sub(r"\\[a-z]+|[{}^_ ]", "", whole)) <= _LINE or not expression.is_Add:
        return [whole]
    return [_latex(term) for term in expression.as_ordered_terms()]


def _latex(expression):
    """LaTeX with the factors in the order of a textbook: numbers, inertias, masses, g, lengths, functions, rates."""
    renamed, names = {}, {}
    for symbol in expression.free_symbols:
        rank, text = _rank_and_name(symbol.name)
        renamed[symbol] = sympy.Symbol(f"{rank}{symbol.name}")  # SymPy sorts by name
        names[renamed[symbol]] = text
    return sympy.latex(expression.xreplace(renamed), symbol_names=names)


def _rank_and_name(name):
    """Place of a symbol in a product, and how it is written."""
    kind, number = re.fullmatch(r"(\D*?)_?\{?(\d*)\}?", name).groups()
    letter = {"qdot": r"\dot{q}", "qddot": r"\ddot{q}"}.get(kind, kind[0])
    index = kind[1:] + number if kind[0] in "Il" else number  # Ixx2, lc3
    return _ORDER.get(kind[0], 5), f"{letter}_{{{index}}}" if index else letter
