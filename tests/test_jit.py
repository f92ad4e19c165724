"""What is compiled while somebody waits says so."""

import numba

from ir50p_lab.jit import says_that_it_compiles
from ir50p_lab.vision import find_balls


def test_the_first_call_says_that_it_compiles_and_no_other(capsys):
    twice = numba.njit(lambda x: 2 * x)

    @says_that_it_compiles
    def seek(x):
        return twice(x)

    assert seek(1) == 2 and capsys.readouterr().out.count("seek is compiled, once") == 1
    assert seek(2) == 4 and capsys.readouterr().out == ""
    assert find_balls.__wrapped__  # it wears this
