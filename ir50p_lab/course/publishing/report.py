"""The lab report: what a student predicted, measured, explained, noted, kept and wrote, as one HTML file.

`python3 -m ir50p_lab report` writes results/report_DATE.html in the student's folder, pictures included.
"""

import argparse
import base64
import html
import textwrap
from datetime import date, datetime
from pathlib import Path

from ir50p_lab.bench import result_files
from ir50p_lab.course import lab_book, my_robot
from ir50p_lab.course.checking import numbers
from ir50p_lab.course.lab_book.names import title
from ir50p_lab.course.lab_book.progress import read_progress
from ir50p_lab.course.robot import student_package
from ir50p_lab.course.robot.catalogue import ORDER, notebook_of
from ir50p_lab.home import setting

_STYLE = """
body { font: 16px/1.5 sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #222 }
table { border-collapse: collapse; margin: 1rem 0 } td, th { padding: 3px 14px 3px 0; text-align: left }
th { border-bottom: 2px solid #999 } td { border-bottom: 1px solid #ddd; vertical-align: top }
pre { background: #f4f4f4; padding: 10px; overflow-x: auto } figure { margin: 1rem 0 } img { width: 100% }
.loan { color: #B35900; font-weight: bold } h1, h2 { font-weight: 600 }
"""


def report(name="") -> str:
    """Return the report as the text of an HTML page. name: of the student."""
    book = lab_book.read()
    parts = [
        f"<h1>Lab report: the IR50P</h1><p>{_names(name, book['partners'])}<br>{date.today():%d %B %Y}</p>",
        _origin(),
        _section("Predicted and measured", _predictions(book["predictions"])),
        _section("Notes", "".join(_note(one) for one in book["notes"])),
        _section("What helped", "".join(_note(one) for one in book["helped"])),
        _section("Figures kept", "".join(_figure(one) for one in book["figures"])),
        _section("Exercises and functions", _done(book["attempts"])),
        _section("My robot", _listings()),
    ]
    return f"<!doctype html><meta charset='utf-8'><title>Lab report</title><style>{_STYLE}</style>{''.join(parts)}"


def _names(name, partners):
    """The first line: the name given, then the partners of the lab book; a line to fill in where there are none."""
    others = [one for one in partners if one != name]
    return _text(" and ".join([name, *others] if name else others)) or "Name: ______________"


def _note(one):
    return f"<p>{_text(one['text'])} <small>{_when(one['at'])}</small></p>"


def _named(key):
    """Return the title of a number or figure of the lab book: from names.txt, else made from its key."""
    return _text(title(key))


def _when(text):
    """A time of the lab book, to the minute, as people write it."""
    when = datetime.fromisoformat(text) if text else None
    return f"{when.day} {when:%B %Y, %H:%M}" if when else ""


def _section(title, content):
    return f"<h2>{title}</h2>{content or '<p>Nothing yet.</p>'}"


def _text(value):
    return html.escape(str(value))


def _table(head, rows):
    line = "".join(f"<th>{_text(one)}</th>" for one in head)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><tr>{line}</tr>{body}</table>" if rows else ""


def _origin():
    """On which bench: simulated or real, unit and seed, as the results say."""
    unit = setting("IR50P_UNIT")
    seed = setting("IR50P_SEED")
    rows = [
        (_text(one), "simulated" if one.simulated else "real", "withdrawn" if one.withdrawn else "")
        for one in result_files.every()
    ]
    chosen = f"<p>Simulated arm: unit {_text(unit or 'of the course')}, seed {_text(seed or 'of the notebook')}.</p>"
    return chosen + (_table(["results of my own", "", ""], rows) if rows else "")


def _predictions(predictions):
    rows = []
    for name, entry in predictions.items():
        unit = entry.get("unit", "")
        guess = _number(entry.get("guess"), unit)
        for before in entry.get("earlier", []):
            if "guess" in before:
                guess += f" <small>(at first {_number(before['guess'], unit)})</small>"
        if "changed" in entry:
            guess += f" <small>(later {_number(entry['changed'], unit)})</small>"
        if entry.get("late"):
            guess += " <small>(after the answer)</small>"
        truth = _number(entry.get("truth"), unit)
        rows.append((_named(name), guess, truth, _text(entry.get("why", "")), _when(entry.get("guessed", ""))))
    return _table(["what", "my guess", "measured", "why", "when"], rows)


def _number(value, unit):
    return "" if value is None else _text(f"{value:.4g} {unit}".strip())


def _figure(one):
    path = lab_book.path().parent / "figures" / one["file"]
    if not path.exists():
        return f"<p>{_named(one['name'])}: the picture {_text(path.name)} is gone.</p>"
    picture = base64.b64encode(path.read_bytes()).decode("ascii")
    name = _named(one["name"])
    words = html.escape(one.get("words", name))
    return f'<figure><img src="data:image/png;base64,{picture}" alt="{words}"><figcaption>{name}</figcaption></figure>'


def _done(attempts):
    done = read_progress()
    rows = [
        (notebook_of(name), _text(name), _whose(name), str(len(attempts.get(name, []))))
        for name in ORDER
        if student_package.is_there(name) or name in attempts
    ]
    solved = [
        (one.notebook, _text(textwrap.shorten(one.task, 80, placeholder=" ...")), _when(done[one.name]))
        for one in numbers.everything()
        if one.name in done
    ]
    functions = _table(["notebook", "function", "whose", "answers that were wrong"], rows)
    return functions + _table(["notebook", "exercise", "done"], solved)


def _whose(name):
    whose = my_robot.whose(name)
    return f"<span class='loan'>{whose}</span>" if whose == "on loan" else whose


def _listings():
    shown = []
    for name in ORDER:
        if student_package.is_there(name):
            text = student_package.read(student_package.path_of(name))
            shown.append(f"<h3>{_text(name)} ({_whose(name)})</h3><pre>{_text(text)}</pre>")
    return "".join(shown)


def main(arguments=None):
    """Write the report and say where it is."""
    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab report", description="Write your lab report.")
    parser.add_argument("--name", default="", help="your name, beside those of `partners`")
    parser.add_argument("--to", type=Path, help="file to write (default: results/report_DATE.html in your folder)")
    chosen = parser.parse_args(arguments)
    path = chosen.to or lab_book.path().parent / f"report_{date.today():%Y-%m-%d}.html"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(report(chosen.name), encoding="utf-8")
    print(f"Your report: {path}")


if __name__ == "__main__":
    main()
