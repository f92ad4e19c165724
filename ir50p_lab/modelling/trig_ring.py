"""Polynomials in the sines and cosines of the arm's angles: why the derivation takes milliseconds.

Everything in the arm's equations of motion is a polynomial in c1 = cos q1, s1 = sin q1, ..., c23 = cos(q2 + q3),
s23 and the physical parameters. SymPy's general `simplify` does not know that and searches for 12 s. Here a
product, a derivative or a reduction by s^2 + c^2 = 1 is a few dictionary operations.
"""

from itertools import product

import sympy
from sympy import QQ
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

# The joints whose angles make up each angle: c23 is the cosine of q2 + q3.
ANGLES = {"1": (0,), "2": (1,), "3": (2,), "23": (1, 2)}
TRIG = tuple(f + angle for angle in ANGLES for f in "cs")  # c1, s1, c2, s2, c3, s3, c23, s23


class TrigRing:
    """The polynomial ring QQ[c1, s1, c2, s2, c3, s3, c23, s23, parameters...].

    Args:
        q: three sympy symbols, the joint angles (rad).
        parameters: names of the other generators.
    """

    def __init__(self, q, parameters):
        self._ring = PolyRing([*TRIG, *parameters], QQ, lex)
        self._at = dict(zip(self._ring.symbols, range(len(self._ring.symbols)), strict=True))
        self.gen = {str(s): g for s, g in zip(self._ring.symbols, self._ring.gens, strict=True)}
        angles = {name: sum(q[j] for j in joints) for name, joints in ANGLES.items()}
        trig = [f(angles[name]) for name in ANGLES for f in (sympy.cos, sympy.sin)]
        positive = [sympy.Symbol(name, real=True) for name in parameters]
        self.symbols = dict(zip(parameters, positive, strict=True))
        self._sympy = trig + positive
        self._rules = self._make_rules()

    def zeros(self, rows, columns):
        """A matrix of zeros, as a list of rows (ring elements)."""
        return [[self._ring.zero] * columns for _ in range(rows)]

    def identity(self, n):
        """The n x n identity."""
        return [[self._ring.one if i == j else self._ring.zero for j in range(n)] for i in range(n)]

    def number(self, value):
        """An integer or a rational as a ring element."""
        return self._ring.ground_new(QQ.convert(value))

    def multiply(self, *matrices):
        """Product of matrices, each entry reduced."""
        result = matrices[0]
        for right in matrices[1:]:
            columns = list(zip(*right, strict=True))
            result = [
                [self.reduce(sum((a * b for a, b in zip(row, column, strict=True)), self._ring.zero)) for column in columns]
                for row in result
            ]
        return result

    def diff(self, p, joint):
        """Derivative of `p` by the angle of `joint` (0, 1, 2): the chain rule over every angle that holds it."""
        result = self._ring.zero
        for angle, joints in ANGLES.items():
            if joint in joints:
                c, s = self.gen["c" + angle], self.gen["s" + angle]
                result += p.diff(s) * c - p.diff(c) * s
        return result

    def _make_rules(self):
        """(i, j, replacement): the product of generators i and j equals the replacement."""
        g, at = self.gen, dict(zip(map(str, self._ring.symbols), range(len(TRIG)), strict=False))
        squares = [(at["s" + a], at["s" + a], 1 - g["c" + a] ** 2) for a in ANGLES]
        # cos and sin of a sum and of a difference; each is used in the direction that shortens.
        sums = [
            ("s2", "s3", g["c2"] * g["c3"] - g["c23"]),
            ("s2", "c3", g["s23"] - g["c2"] * g["s3"]),
            ("s2", "s23", g["c3"] - g["c2"] * g["c23"]),
            ("s2", "c23", g["c2"] * g["s23"] - g["s3"]),
        ]
        return squares + [(at[i], at[j], new) for i, j, new in sums]

    def _apply(self, p, rule):
        """Replace generator i times generator j by the rule's polynomial wherever it occurs, until it is gone."""
        i, j, new = rule
        while True:
            hit, rest = {}, {}
            for monomial, coefficient in p.items():
                exponents = list(monomial)
                exponents[i] -= 1
                exponents[j] -= 1
                if exponents[i] >= 0 and exponents[j] >= 0:
                    hit[tuple(exponents)] = coefficient
                else:
                    rest[monomial] = coefficient
            if not hit:
                return p
            p = self._ring.from_dict(rest) + self._ring.from_dict(hit) * new

    def reduce(self, p):
        """The same function with fewer terms: each rule is kept for the coefficient that it shortens."""
        parts = self._split(self._apply(p, self._rules[0]), len(TRIG))
        result = self._ring.zero
        for monomial, trig in parts.items():
            shorter = True
            while shorter and len(trig) > 1:
                shorter = False
                for rule in self._rules:
                    candidate = self._apply(trig, rule)
                    if len(candidate) < len(trig):
                        trig, shorter = candidate, True
            result += trig * self._ring.from_dict({monomial: QQ.one})
        return result

    def _split(self, p, first):
        """{monomial of generators >= first: polynomial in the generators before}."""
        parts = {}
        n = len(self._ring.symbols)
        for monomial, coefficient in p.items():
            key = (0,) * first + monomial[first:]
            parts.setdefault(key, {})[monomial[:first] + (0,) * (n - first)] = coefficient
        return {key: self._ring.from_dict(part) for key, part in parts.items()}

    def is_zero(self, p):
        """True if `p` is the zero function: c23 and s23 expanded, then s^2 = 1 - c^2 leaves a unique form."""
        g = self.gen
        c23, s23 = self._at[self._ring.symbols[TRIG.index("c23")]], self._at[self._ring.symbols[TRIG.index("s23")]]
        expanded = self._ring.zero
        for monomial, coefficient in p.items():
            exponents = list(monomial)
            n_c, n_s = exponents[c23], exponents[s23]
            exponents[c23] = exponents[s23] = 0
            term = self._ring.from_dict({tuple(exponents): coefficient})
            expanded += term * (g["c2"] * g["c3"] - g["s2"] * g["s3"]) ** n_c * (g["s2"] * g["c3"] + g["c2"] * g["s3"]) ** n_s
        for rule in self._rules[:3]:
            expanded = self._apply(expanded, rule)
        return not expanded

    def to_sympy(self, p, by=()):
        """`p` as a sympy expression: common factors in front, grouped by the parameters `by`, groups factored."""
        if not p:
            return sympy.S.Zero
        common, rest = p.terms_gcd()[0], p
        rest = self._ring.from_dict(
            {tuple(a - b for a, b in zip(m, common, strict=True)): c for m, c in p.items()}
        )
        sign = -1 if all(c < 0 for c in rest.values()) else 1
        content = rest.content() * sign
        rest = rest.quo_ground(content)
        groups = {}
        at = [self._at[s] for s in self._ring.symbols if str(s) in by]
        for monomial, coefficient in rest.items():
            key = tuple(monomial[k] if k in at else 0 for k in range(len(monomial)))
            inner = tuple(0 if k in at else monomial[k] for k in range(len(monomial)))
            groups.setdefault(key, {})[inner] = coefficient
        total = sympy.Add(*[self._monomial(key) * self._factored(part) for key, part in groups.items()])
        return sympy.Mul(sympy.Rational(int(content.numerator), int(content.denominator)), self._monomial(common), total)

    def _monomial(self, exponents):
        return sympy.Mul(*[s**e for s, e in zip(self._sympy, exponents, strict=True) if e])

    def _factored(self, part):
        """Factor {exponents: coefficient} in a ring of just its own generators (five times faster)."""
        if len(part) == 1:
            ((exponents, coefficient),) = part.items()
            return _rational(coefficient) * self._monomial(exponents)
        used = [k for k in range(len(self._sympy)) if any(m[k] for m in part)]
        small = PolyRing([self._ring.symbols[k] for k in used], QQ, lex)
        p = small.from_dict({tuple(m[k] for k in used): c for m, c in part.items()})
        symbols = [self._sympy[k] for k in used]
        coefficient, factors = p.factor_list()
        return sympy.Mul(_rational(coefficient), *[f.as_expr(*symbols) ** n for f, n in factors])


def _rational(x):
    return sympy.Rational(int(x.numerator), int(x.denominator))
