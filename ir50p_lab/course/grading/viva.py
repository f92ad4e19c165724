"""Three questions for a talk of five minutes, from what one student handed in."""

from ir50p_lab.course.lab_book.names import title


def questions(submission, verdicts):
    """Return three sentences: on a guess that missed, on the function that took most attempts, on a loan."""
    return [_on_a_guess(submission.predictions), _on_tries(submission.attempts), _on_a_loan(verdicts)]


def missed(entry):
    """Return by what share of the truth a guess is off, 0 if it is within its tolerance."""
    off = abs(entry["guess"] - entry["truth"])
    return off / max(abs(entry["truth"]), 1e-9) if off > entry["within"] * abs(entry["truth"]) else 0.0


def _on_a_guess(predictions):
    """The guess that missed most; one with a reason comes first."""
    off = {name: entry for name, entry in predictions.items() if missed(entry)}
    if not off:
        return "No guess of yours missed. Of which one were you least sure, and why?"
    name, entry = max(off.items(), key=lambda one: (one[1]["why"] != "", missed(one[1])))
    said = f"“{entry['why'][:200]}” Explain that with a sketch." if entry["why"] else "Why is it so?"
    numbers = f"you guessed {entry['guess']:.4g} {entry['unit']}, it is {entry['truth']:.4g}"
    return f"{title(name)}: {numbers}. {said}"


def _on_tries(attempts):
    name = max(attempts, key=lambda one: len(attempts[one]), default=None)
    if name is None:
        return "Which of your functions took you longest, and what was the idea in the end?"
    last = next((f" The last time it said: “{one}”" for one in reversed(attempts[name]) if one), "")
    return f"{name} took {len(attempts[name])} wrong answers.{last} What was it, in the end?"


def _on_a_loan(verdicts):
    first = {state: name for name, (state, _) in reversed(verdicts.items())}
    if "loan" in first:
        return f"{first['loan']} is on loan: go through its lines, and say what yours lacked."
    if "wrong" in first:
        return f"{first['wrong']} is not right: where would you look first?"
    return "Open the function that you are proudest of: which line holds the idea?"
