"""No folder has more code lines than it may."""

from code_lines import BUDGET_OF_ALL, BUDGET_OF_TESTS, BUDGETS, TESTS, folder_lines, too_large


def test_nothing_has_more_lines_than_it_may():
    assert sum(BUDGETS.values()) == BUDGET_OF_ALL
    product, tests = folder_lines(), folder_lines(TESTS)
    assert list(too_large(product, tests)) == []
    said = too_large(product | {"root": 999}, tests | {"more": BUDGET_OF_TESTS})
    assert [one.split(":")[0] for one in said] == ["root", "all", "tests"]
