"""The lab book itself: what the student predicted, measured, noted and kept, as readable JSON."""

import re
from datetime import datetime

from ir50p_lab import home
from ir50p_lab.course.lab_book.student_file import LabBookError, read_json, write_json, writing


def path():
    """Where the lab book lies: results/lab_book.json in the student's folder."""
    return home.home() / "results" / "lab_book.json"


def read():
    """Return {"predictions": {name: ...}, "notes", "figures", "contest": [...], "attempts": {function: [...]}}."""
    empty = {"predictions": {}, "notes": [], "figures": [], "contest": [], "attempts": {}}
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
    """The time, as it is written into the lab book."""
    return datetime.now().astimezone().isoformat(timespec="seconds")


def predict(name, guess, unit=""):
    """Write down a guess before the run that answers it: predict("fk.height", 0.3, "m").

    With the dots it says that a guess is missing, and goes on. The first number counts; a later one is shown, too.
    """
    if guess is ...:
        print(f"{name}: put your guess in place of the dots, in {unit or 'numbers'}. Then run the cell.")
        return
    guess = _number(name, guess)

    def edit(book):
        entry = book["predictions"].setdefault(name, {"guess": guess, "unit": unit, "guessed": now()})
        if "guess" not in entry:
            entry.update(guess=guess, unit=unit, guessed=now(), late="truth" in entry)
        if entry["guess"] != guess:
            entry["changed"] = guess
        return entry

    entry = change(edit)
    changed = f" (changed to {_say(entry['changed'], unit)}; the first one counts)" if entry["guess"] != guess else ""
    print(f"{name}: your guess is {_say(entry['guess'], unit)}{changed}")


def measured(name, value, unit=""):
    """Show what came out beside what was guessed, and write it down. unit: where nothing was predicted."""
    value = _number(name, value)

    def edit(book):
        entry = book["predictions"].setdefault(name, {})
        entry.update(truth=value, measured=now())
        entry.setdefault("unit", unit)
        return entry

    entry = change(edit)
    unit = entry["unit"]
    if "guess" not in entry:
        print(f"{name}: {_say(value, unit)}")
    else:
        off = f", {_say(entry['guess'] - value, unit, sign=True)} off"
        print(f"{name}: you guessed {_say(entry['guess'], unit)}, it is {_say(value, unit)}{off}.")


def note(text):
    """Write a remark into the lab book; the report shows it with its time. The same remark is kept once."""
    text = str(text).strip()
    if text in ("", "..."):
        print("note: write what you saw between the quotation marks, then run the cell.")
        return
    change(
        lambda book: text in (one["text"] for one in book["notes"]) or book["notes"].append({"text": text, "at": now()})
    )
    print("noted")


def keep(figure, name):
    """Put a matplotlib figure into the lab book as `name`; the report shows the last one of each name."""
    file = f"{re.sub(r'[^a-zA-Z0-9]+', '_', name).strip('_') or 'figure'}.png"
    place = path().parent / "figures" / file
    with writing(place, place.parent):
        figure.savefig(place, dpi=120, bbox_inches="tight")

    def edit(book):
        book["figures"] = [one for one in book["figures"] if one["file"] != file]
        book["figures"].append({"name": name, "file": file, "at": now()})

    change(edit)
    print(f"kept: {name}")


def _number(name, value):
    try:
        return float(value)
    except (TypeError, ValueError):
        raise LabBookError(f"{name}: a prediction is one number, got {value!r:.60}") from None


def _say(value, unit, sign=False):
    return f"{value:{'+' if sign else ''}.4g} {unit}".strip()
