"""The class on one page, without a script: what was guessed wrong, what was answered wrong, and each student."""

import html
import math
import re
from collections import Counter
from statistics import median

from ir50p_lab.course.grading.viva import missed, questions
from ir50p_lab.course.lab_book.names import title
from ir50p_lab.course.robot.catalogue import ORDER, notebook_of

_COLOURS = {"right": "#009E73", "wrong": "#D55E00", "loan": "#E69F00", "open": "#DDDDDD"}
_STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 76rem; margin: 1.5rem auto; padding: 0 1rem; color: #222 }
table { border-collapse: collapse } h2 { margin-top: 2rem } summary { cursor: pointer } .self { color: #666 }
td, th { padding: 3px 14px 3px 0; text-align: left; vertical-align: top; border-bottom: 1px solid #ddd }
svg { border-bottom: 1px solid #bbb }
.bar { display: flex; width: 200px; height: 13px; margin-top: 5px } .bar span { height: 13px }
"""
_FEWEST, _MOST = 3, 12  # guesses that make a histogram; histograms
_STEP, _SIDE = 1.25, 6  # a bar of a histogram is a quarter more; bars to each side of the truth
_REPORTED = "<p class=self>Grey: self-reported, a text editor can change it.</p>"


def page(handed_in, found):
    """Return the text of the page; found: [{function: (state, sentence)}] of the submissions."""
    parts = [
        f"<h1>The class: {len(handed_in)} hand-ins</h1>",
        "<h2>Predictions that the class missed most</h2>" + _predictions(handed_in) + _REPORTED,
        "<h2>Functions</h2>" + _functions(handed_in, found) + _REPORTED,
        "<h2>Students</h2><p>A row opens to three questions for a talk.</p>" + _students(handed_in, found) + _REPORTED,
    ]
    head = f"<!doctype html><html lang='en'><meta charset='utf-8'><title>The class</title><style>{_STYLE}</style>"
    return f"{head}{''.join(parts)}</html>"


def _predictions(handed_in):
    entries = {}
    for one in handed_in:
        for name, entry in one.predictions.items():
            entries.setdefault(name, []).append(entry)
    enough = {name: many for name, many in entries.items() if len(many) >= _FEWEST}
    shares = {name: sum(missed(one) > 0 for one in many) / len(many) for name, many in enough.items()}
    rows = []
    for name in sorted(shares, key=shares.get, reverse=True)[:_MOST]:
        many = enough[name]
        truth = f"{median(one['truth'] for one in many):.4g} {many[0]['unit']}"
        reasons = Counter(one["why"][:150] for one in many if one["why"]).most_common(3)
        said = "<br>".join(f"{count} × <q>{_text(why)}</q>" for why, count in reasons)
        hits = f"{round(shares[name] * len(many))} of {len(many)}"
        rows.append((_text(title(name)), hits, _histogram(many), _text(truth), said))
    steps = "guess over truth, in steps of a quarter; farther: at an end"
    return _table(("what", "missed by", steps, "truth", "reasons given"), rows, "self")


def _histogram(entries):
    """First guesses over the truth, dashed in the middle; what is farther or of the other sign stands at the ends."""
    counts = Counter(_place(one["guess"], one["truth"]) for one in entries)
    most = max(counts.values())
    tall = {12 * place: 36 * count / most for place, count in sorted(counts.items())}
    bars = "".join(f'<rect x="{x}" y="{40 - y:.1f}" width="10" height="{y:.1f}"/>' for x, y in tall.items())
    middle, width = 12 * _SIDE + 5, 12 * (2 * _SIDE + 1)
    low, high = (sum(sign * (one["guess"] - one["truth"]) > 0 for one in entries) for sign in (-1, 1))
    about = f'role="img" aria-label="{low} too low, {high} too high"'
    dashes = f'<path d="M{middle} 0V40" stroke="#D55E00" stroke-width="2" stroke-dasharray="4 3"/>'
    return f'<svg width="{width}" height="40" {about} fill="#56B4E9">{bars}{dashes}</svg>'


def _place(guess, truth):
    if guess == truth:
        return _SIDE
    if not truth or guess / truth <= 0:
        return 2 * _SIDE if guess > truth else 0
    return min(max(_SIDE + round(math.log(guess / truth, _STEP)), 0), 2 * _SIDE)


def _functions(handed_in, found):
    rows = []
    for name in ORDER:
        of_all = [verdicts.get(name, ("open", "")) for verdicts in found]
        counts = Counter(state for state, _ in of_all)
        if counts["open"] == len(found):
            continue
        said = Counter(_without_numbers(says) for state, says in of_all if state == "wrong")
        tried = Counter(_without_numbers(says) for one in handed_in for says in one.attempts.get(name, ()) if says)
        rows.append((notebook_of(name), f"<code>{name}</code>", _bar(counts), _commonest(said), _commonest(tried)))
    key = "".join(f"<span style='color:{colour}'>■</span> {state} &nbsp;" for state, colour in _COLOURS.items())
    head = ("", "function", "the class", "what is wrong with it", "commonest wrong answers on the way (self-reported)")
    return f"<p>{key}</p>{_table(head, rows)}"


def _commonest(said):
    return "<br>".join(f"{count} × {_text(says)}" for says, count in said.most_common(2))


def _without_numbers(says):
    return re.sub(r"-?\d[\d.e-]*", "#", says)[:140]


def _students(handed_in, found):
    rows = []
    for one, verdicts in zip(handed_in, found, strict=True):
        counts = Counter(verdicts.get(name, ("open", ""))[0] for name in ORDER)
        asked = "".join(f"<li>{_text(question)}</li>" for question in questions(one, verdicts))
        told = {name: says for name, (state, says) in verdicts.items() if state == "wrong"}
        wrong = "".join(f"<p><code>{name}</code>: {_text(says)}</p>" for name, says in told.items())
        names = _text(" and ".join([one.name, *one.partners]))
        opened = f"<details><summary>{names}</summary><ol>{asked}</ol>{wrong}</details>"
        lent = ", ".join(name for name, (state, _) in verdicts.items() if state == "loan")
        reasons = sum(bool(entry["why"]) for entry in one.predictions.values())
        said = f"<span class=self>{len(one.predictions)} predictions, {reasons} reasons</span>"
        helped = "; ".join(_text(text[:80]) for text in one.helped[:5])
        rows.append((opened, _bar(counts), lent, said, f"<span class=self>{helped}</span>", _text(one.trouble)))
    return _table(("student", "functions", "on loan", "", "what helped", "trouble"), rows)


def _bar(counts):
    shares = {state: counts[state] / counts.total() for state in _COLOURS}
    words = ", ".join(f"{counts[state]} {state}" for state in _COLOURS if counts[state])
    parts = [f"<span style='background:{_COLOURS[state]};width:{x:.1%}'></span>" for state, x in shares.items()]
    return f"<span class=bar>{''.join(parts)}</span><small>{words}</small>"


def _table(head, rows, kind=""):
    if not rows:
        return "<p>Nothing yet.</p>"
    top = "".join(f"<th>{one}</th>" for one in head)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table class='{kind}'><tr>{top}</tr>{body}</table>"


def _text(value):
    return html.escape(str(value))
