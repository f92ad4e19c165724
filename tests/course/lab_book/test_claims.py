"""Claims: the sentence that is printed is the one that is raised; margins come out as they went in."""

import json

import numpy as np
import pytest

from ir50p_lab.course import ClaimError, claim
from ir50p_lab.errors import InputError


@pytest.mark.parametrize(
    ("value", "limits", "words", "room"),
    [
        (0.25, {"below": 1}, "0.25 (below 1)", [0.75]),
        (0.25, {"above": 0.2, "below": 1}, "0.25 (below 1 and above 0.2)", [0.75, 0.05]),
        ([2, 3], {"above": [1, 1.5]}, "[2, 3] (above [1, 1.5])", [1, 1.5]),
        (9.99, {"near": 10, "within": 0.1}, "9.99 (within 0.1 of 10)", [0.11, 0.09]),
    ],
)
def test_a_claim_that_holds_is_said_with_value_and_limit(value, limits, words, room, capsys, monkeypatch, tmp_path):
    log = tmp_path / "claims.jsonl"
    monkeypatch.setenv("IR50P_CLAIMS", str(log))
    claim("it is so", value, **limits)
    assert capsys.readouterr().out == f"it holds: it is so: {words}\n"
    (line,) = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
    assert line["claim"] == "it is so"
    np.testing.assert_allclose(line["room"], room, atol=1e-12)


@pytest.mark.parametrize(
    ("value", "limits"),
    [
        (1, {"below": 1}),
        ([0.5, np.nan], {"below": 1}),
        ([2, 0.5], {"above": 1}),
        (10.2, {"near": 10, "within": 0.1}),
        (9.8, {"near": 10, "within": 0.1}),
    ],
)
def test_a_claim_that_fails_raises_the_same_sentence(value, limits):
    with pytest.raises(ClaimError, match=r"does not hold: it is so: .*\(") as failed:
        claim("it is so", value, **limits)
    assert isinstance(failed.value, AssertionError)


@pytest.mark.parametrize("limits", [{}, {"near": 1}, {"within": 1}])
def test_a_claim_without_a_limit_says_nothing(limits):
    with pytest.raises(InputError, match="needs a limit"):
        claim("it is so", 1, **limits)
