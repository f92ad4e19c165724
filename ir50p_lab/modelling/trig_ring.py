"""Polynomials in the sines and cosines of the arm's angles: why the derivation takes milliseconds.

Everything in the arm's equations of motion is a polynomial in c1 = cos q1, s1 = sin q1, ..., c23 = cos(q2 + q3),
s23 and the physical parameters. SymPy's general `simplify` does not know that and searches for seconds. Here a
product, a derivative or a reduction by s^2 + c^2 = 1 is a few dictionary operations.
"""

import functools

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
        parameters: names of the other generators; `symbols` maps each to its (real) sympy symbol.

    Matrices are lists of rows of ring elements; `gen` maps a generator's name to the element.
    """

    def __init__(self, q, parameters):
        self._names = [*TRIG, *parameters]
        self._ring = PolyRing(self._names, QQ, lex)
        self.zero, self.one = self._ring.zero, self._ring.one
        self.gen = dict(zip(self._names, self._ring.gens, strict=True))
        self.symbols = {name: sympy.Symbol(name, real=True) for name in parameters}
        angles = [sum(q[j] for j in joints) for joints in ANGLES.values()]
        trig = [f(angle) for angle in angles for f in (sympy.cos, sympy.sin)]
        self._sympy = [*trig, *self.symbols.values()]
        self._rules = self._make_rules()
        self._factors = {}  # factoring is most of the work and the same sums come back

    def rational(self, numerator, denominator=1):
        """A constant as a ring element."""
        return self._ring.ground_new(QQ(numerator, denominator))

    def multiply(self, *matrices):
        """Product of matrices, each entry reduced."""
        result = matrices[0]
        for right in matrices[1:]:
            columns = list(zip(*right, strict=True))
            result = [[self.reduce(self.dot(row, column)) for column in columns] for row in result]
        return result

    def dot(self, a, b):
        """Sum of products of two rows, not reduced."""
        return sum((x * y for x, y in zip(a, b, strict=True)), self.zero)

    def diff(self, p, joint):
        """Derivative of `p` by the angle of `joint` (0, 1, 2): the chain rule over every angle that holds it."""
        result = self.zero
        for angle, joints in ANGLES.items():
            if joint in joints:
                c, s = self.gen["c" + angle], self.gen["s" + angle]
                result += p.diff(s) * c - p.diff(c) * s
        return result

    def reduce(self, p):
        """The same function in fewer terms: q1 drops out where it can, then each rule is used where it shortens."""
        result = self.zero
        for parameters, trig in self._split(self._replace(p, self._rules[0])).items():
            shorter = True
            while shorter and len(trig) > 1:
                shorter = False
                for rule in self._rules:
                    candidate = self._replace(trig, rule)
                    if len(candidate) < len(trig):
                        trig, shorter = candidate, True
            result += trig.mul_monom(parameters)
        return result

    def to_sympy(self, p, by=()):
        """`p` as a sympy expression to be read: common factors in front, then a sum over the parameters `by`.

        Each parameter (a mass, say) is followed by its factored coefficient; parameters that share one are collected.
        """
        if not p:
            return sympy.S.Zero
        number, common, p = _primitive(p)
        kept = [name in by for name in self._names]
        groups = {}
        for monomial, coefficient in p.items():
            key = tuple(e if keep else 0 for e, keep in zip(monomial, kept, strict=True))
            inner = tuple(0 if keep else e for e, keep in zip(monomial, kept, strict=True))
            groups.setdefault(key, {})[inner] = coefficient
        shared = {}
        for key, part in groups.items():
            content, monomial, part = _primitive(part)
            expression = self._monomial(monomial) * self._factored(part)
            shared.setdefault(expression, []).append(content * self._monomial(key))
        total = sympy.Add(*[sympy.Add(*keys) * expression for expression, keys in shared.items()])
        total = self._monomial(common) * total
        # sympy multiplies a number into a sum; kept in front it reads better, and later products still merge it
        return sympy.Mul(number, total, evaluate=not (total.is_Add and number != 1))

    def _make_rules(self):
        """(i, j, new): generator i times generator j equals `new`. The first takes q1 out of M and g."""
        g, index = self.gen, self._names.index
        squares = [(index("s" + a), index("s" + a), 1 - g["c" + a] ** 2) for a in ANGLES]
        sums = [  # cosine and sine of a sum and of a difference
            ("s2", "s3", g["c2"] * g["c3"] - g["c23"]),
            ("s2", "c3", g["s23"] - g["c2"] * g["s3"]),
            ("s2", "s23", g["c3"] - g["c2"] * g["c23"]),
            ("s2", "c23", g["c2"] * g["s23"] - g["s3"]),
        ]
        return squares + [(index(i), index(j), new) for i, j, new in sums]

    def _replace(self, p, rule):
        """`p` with generator i times generator j replaced by the rule's polynomial until none is left."""
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

    def _split(self, p):
        """{monomial of parameters: polynomial in the trigonometric generators} of `p`."""
        n_trig, n = len(TRIG), len(self._names)
        parts = {}
        for monomial, coefficient in p.items():
            key = (0,) * n_trig + monomial[n_trig:]
            parts.setdefault(key, {})[monomial[:n_trig] + (0,) * (n - n_trig)] = coefficient
        return {key: self._ring.from_dict(part) for key, part in parts.items()}

    def _monomial(self, exponents):
        return sympy.Mul(*[s**e for s, e in zip(self._sympy, exponents, strict=True) if e])

    def _factored(self, part):
        """Factor {exponents: coefficient} in a ring of only its own generators (much faster there)."""
        known = frozenset(part.items())
        if known not in self._factors:
            used = [k for k in range(len(self._names)) if any(monomial[k] for monomial in part)]
            small = PolyRing([self._names[k] for k in used], QQ, lex)
            p = small.from_dict({tuple(monomial[k] for k in used): c for monomial, c in part.items()})
            coefficient, factors = p.factor_list() if len(p) > 1 else (QQ.one, [(p, 1)])
            symbols = [self._sympy[k] for k in used]
            factors = [f.as_expr(*symbols) ** n for f, n in factors]
            self._factors[known] = sympy.Mul(QQ.to_sympy(coefficient), *factors)
        return self._factors[known]


def _primitive(p):
    """Split {exponents: coefficient} into number, common monomial and the rest, whose terms are not all negative."""
    common = tuple(map(min, zip(*p, strict=True)))
    number = abs(functools.reduce(QQ.gcd, p.values())) * (-1 if all(c < 0 for c in p.values()) else 1)
    rest = {tuple(a - b for a, b in zip(m, common, strict=True)): c / number for m, c in p.items()}
    return QQ.to_sympy(number), common, rest
