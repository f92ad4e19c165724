"""The lab book itself: what the student predicted, measured, explained, noted and kept, as readable JSON."""

import math
import re
from datetime import datetime

from ir50p_lab import home
from ir50p_lab.course.lab_book.student_file import LabBookError, read_json, write_json, writing


def path():
    """Return where the lab book is: results/lab_book.json in the student's folder."""
    return home.home() / "results" / "lab_book.json"


def read():
    """Return {"predictions": {name: ...}, "notes", "figures", "contest", "helped", "partners", "attempts"}.

    A prediction's `earlier` lists what stood in it before.
    """
    empty = {"predictions": {}, "notes": [], "figures": [], "contest": [], "helped": [], "attempts": {}, "partners": []}
    return read_json(
        path(), empty, lambda found: all(isinstance(found.get(key, one), type(one)) for key, one in empty.items())
    )


def change(edit):
    """Read the lab book, let `edit(book)` change it, write it in one step; return what edit returned."""
    book = read()
    answer = edit(book)
    write_json(path(), book, path().parent)
    return answer


def now():
    """Return the time in the form in which it is written into the lab book."""
    return datetime.now().astimezone().isoformat(timespec="seconds")


def predict(name, guess, unit="", *more, within=0.1, choices=()):
    """Write down a guess before the run that answers it: predict("fk.height", 0.3, "m").

    As long as the dots are there, it says that a guess is missing, and goes on. What is no answer is refused with a
    sentence and does not count. Until it is measured, a guess may be replaced once; one that comes later is shown, but
    does not count.

    Args: guess: a number. within: how far it may be off before `measured` asks why, as a share of what is measured.
    choices: numbers of which the guess is one, or {number: what it means}. more: what a decimal comma leaves over.
    """
    if refusal := _refusal(guess, unit, more, choices):
        print(f"{name}: {refusal}")
        return

    def edit(book):
        entry = book["predictions"].setdefault(name, {})
        if isinstance(choices, dict):
            entry["words"] = {f"{number:g}": word for number, word in choices.items()}
        return _take_guess(entry, float(guess), unit, 0 if choices else within)

    print(f"{name}: {change(edit)}")


def measured(name, value, unit="", by=""):
    """Show what came out next to what was guessed, and write it down. unit: needed where nothing was predicted.

    by: whose function made the value, as `badge_of` and `my_robot.whose` return it: unless it is "yours", the value is
    not written down; "": a fact of the course.

    If the guess is off by more than its prediction allows, and no reason is written down yet, it asks for one.
    """
    try:
        value = float(value)
    except (TypeError, ValueError):
        raise LabBookError(f"{name}: a measured value is one number, got {value!r:.60}") from None

    def edit(book):
        entry = book["predictions"].setdefault(name, {})
        _write(entry, "truth", value)
        entry.setdefault("unit", unit)
        return entry

    own = by in ("", "yours")
    entry = change(edit) if own else read()["predictions"].get(name, {})
    unit, kept = entry.get("unit", unit), "" if own else f" ({by}: not written down)"
    if "guess" not in entry:
        print(f"{name}: {_say(value, unit)}{kept}")
        return
    words = entry.get("words", {})
    guess, truth = (words.get(f"{number:g}", _say(number, unit)) for number in (entry["guess"], value))
    print(f"{name}: you guessed {guess}, it is {truth}{kept}")
    if own and abs(entry["guess"] - value) > entry["within"] * abs(value) and "why" not in entry:
        print(f'Why? One sentence: why("{name}", "...")')


def why(name, text):
    """Write down, in a sentence, why something came out as it did: why("p.ends", "..."). The report shows it."""
    text = str(text).strip()
    if text in ("", "...", str(...)):
        print(f"{name}: put your sentence in place of the dots. Then run the cell.")
        return

    def edit(book):
        if entry := book["predictions"].get(name):
            _write(entry, "why", text)
        return entry

    print(f"{name}: noted" if change(edit) else f"{name}: nothing of this name was predicted or measured")


def partners(*names):
    """Write down who works together, partners("A. Name", "B. Name"), for the report. Without names: print who does."""
    names = [str(name).strip() for name in names if str(name).strip()]

    def edit(book):
        book["partners"] = names or book["partners"]
        return book["partners"]

    print("This lab book belongs to", " and ".join(change(edit)) or 'nobody yet: partners("A. Name", "B. Name")')


def note(text):
    """Write a remark into the lab book; the report shows it with its time. The same remark is kept only once."""
    _keep_text("notes", text, "note: write what you saw")


def helped_by(text):
    """Write down who or what helped, and with what, for the report: helped_by("an assistant explained the half angle").

    The same sentence is kept only once.
    """
    _keep_text("helped", text, "helped_by: write who or what helped, and with what,")


def _keep_text(where, text, asked):
    text = str(text).strip()
    if not text or text.endswith("..."):
        print(f"{asked} between the quotation marks, then run the cell.")
        return
    change(lambda book: text in (one["text"] for one in book[where]) or book[where].append({"text": text, "at": now()}))
    print("noted")


def keep(figure, name):
    """Put a matplotlib figure into the lab book as `name`; the report shows the last figure of each name."""
    file = f"{re.sub(r'[^a-zA-Z0-9]+', '_', name).strip('_') or 'figure'}.png"
    place = path().parent / "figures" / file
    with writing(place, place.parent):
        figure.savefig(place, dpi=200, bbox_inches="tight")

    def edit(book):
        book["figures"] = [one for one in book["figures"] if one["file"] != file]
        words = figure.describe() if hasattr(figure, "describe") else name
        book["figures"].append({"name": name, "file": file, "at": now(), "words": words})

    change(edit)
    print(f"kept: {name}")


def _refusal(guess, unit, more, choices):
    """Say why this is not a prediction; "" for one that is."""
    if more or not isinstance(unit, str) or "," in str(guess):
        return "a decimal comma? Python takes 0,35 for two numbers: write 0.35. Nothing was written down."
    asked = f"one of {', '.join(map(str, choices))}" if choices else f"one number ({unit})" if unit else "one number"
    if guess is ...:
        return f"put your guess in place of the dots, {asked}. Then run the cell."
    try:
        number = float(guess)
    except (TypeError, ValueError):
        number = math.nan
    if math.isfinite(number) and (not choices or number in choices):
        return ""
    return f"{guess!r:.40} is not an answer, so it does not count: give {asked}."


def _take_guess(entry, guess, unit, within):
    """Let a guess count if it still may; return the sentence about it."""
    said = f"your guess is {_say(guess, unit)}"
    if "guess" not in entry:
        entry["late"] = "truth" in entry
    elif guess != entry["guess"]:
        first = _say(entry["guess"], entry["unit"])
        if "truth" in entry or any("guess" in one for one in entry.get("earlier", [])):
            _write(entry, "changed", guess)
            return f"your guess stays {first}: {_say(guess, unit)} comes too late to count"
        said += f", in place of {first}"
    _write(entry, "guess", guess)
    entry.update(unit=unit, within=within)
    return said


_TIMES = {"guess": "guessed", "truth": "measured", "changed": "changed_at", "why": "explained"}


def _write(entry, key, value):
    """Write a value and its time into an entry; another value that stood there moves to `earlier`, a list."""
    time = _TIMES[key]
    if key in entry and entry[key] == value:
        return
    if key in entry:
        entry.setdefault("earlier", []).append({key: entry[key], time: entry.get(time, "")})
    entry.update({key: value, time: now()})


def _say(value, unit):
    return f"{value:.4g} {unit}".strip()
