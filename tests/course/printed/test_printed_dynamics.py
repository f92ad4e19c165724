"""The printed equations of 1.5 are held as printed: each mistake is where the module says, and nowhere else."""

import pytest
from printed_law import TWICE_B

from ir50p_lab.course.printed import dynamics as printed
from ir50p_lab.modelling import derive, same_function

wrong = printed.wrong_entries


@pytest.fixture(scope="module")
def thesis():
    return derive(links="thesis")


@pytest.fixture(scope="module")
def M(thesis):
    return thesis.M.subs({thesis.symbols[f"j{i}"]: 0 for i in "123"})


def test_lists(thesis, M):
    assert wrong(printed.M_LIST, M) == [(1, 1)]
    right = printed.M_LIST.copy()
    right[0, 0] += printed.m2 * printed.lc2**2 * (printed.c2**2 - printed.c2)  # the one correction: c2 -> c2^2
    assert same_function(right, M)
    swapped = printed.DM["112"].xreplace({printed.m2: printed.m3})  # m3 for m2, but not in the term of link 2
    term = -2 * printed.lc2**2 * printed.c2 * printed.s2
    assert same_function(swapped + (printed.m2 - printed.m3) * term, M[0, 0].diff(printed.q2))
    assert same_function(-printed.DM["223"].xreplace({printed.m2: printed.m3}), M[1, 1].diff(printed.q3))
    assert same_function(printed.DM["233"], thesis.b(2, 3, 3))
    assert same_function(printed.B["322"].xreplace({printed.m2: printed.m3}), thesis.b(3, 2, 2))


def test_doubled_symbols_end_in_the_right_values(thesis, M):
    for name, source in TWICE_B.items():
        i, j, k = (int(digit) - 1 for digit in source or "111")
        right = M[i, j].diff(thesis.q[k]) if source else 0
        assert same_function(2 * thesis.b(*map(int, name)), right)
