"""The course as a book: the pages of `export` with a bar, a search and a reference. `python3 -m ir50p_lab book`.

The notebooks are run as they are, each with a home of its own: a page shows what readers see who have written
nothing yet. A copy that was run is used again until its notebook or the package changes.
"""

import argparse
import html
import json
import os
import re
import shutil
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import jinja2
import nbformat
from tqdm.auto import tqdm

from ir50p_lab.course.publishing.export import execute, export
from ir50p_lab.course.publishing.reference import reference
from ir50p_lab.errors import LabError
from ir50p_lab.home import PROJECT, replace_text

_DOCS, _COPIES = PROJECT / "docs", PROJECT / "build" / "book"
_TEXTS = "glossary index_of_equations public_names instructor with_the_arm on_the_wall with_a_camera where_it_runs"
_TEXTS += " from_matlab developing"
_TITLE = "The IR50P lab book"


def book(to, *, run=True):
    """Write the book into a folder; return its first page. run: False takes the outputs that are stored.

    Raises LabError if a cell fails.
    """
    notebooks = sorted((PROJECT / "notebooks").glob("[0-9A][0-9]_*.ipynb"))
    sources = [PROJECT / "README.md", *notebooks, *(_DOCS / f"{name}.md" for name in _TEXTS.split())]
    names = ["index.html", *(f"{source.stem}.html" for source in sources[1:])]
    with tempfile.TemporaryDirectory() as room, ThreadPoolExecutor(os.cpu_count()) as pool:
        public = Path(room, "public_names.md")
        public.write_text(reference(), "utf-8")
        ready = tqdm(pool.map(lambda one: _ready(one, public, run), sources), "pages", len(sources))
        pages = [export(one, room, run=False, pdf=False, title=_TITLE)[0].read_text("utf-8") for one in ready]
    places = dict(zip(sources, names, strict=True)) | {_DOCS / "try" / "index.html": "try.html"}
    sections = [_sections(*one) for one in zip(names, pages, strict=True)]
    template = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent)).get_template("book.html")
    to.mkdir(parents=True, exist_ok=True)
    for here, (source, page) in enumerate(zip(sources, pages, strict=True)):
        parts = re.split("(?=</head>)|(?<=<body>)<main>|</main>", _linked(page, source.parent, places))
        bound = template.render(parts=parts, sections=sections, here=here)
        (to / names[here]).write_text(bound, "utf-8")
    found = [[one for one in page if one[1] != "Predictions"] for page in sections]  # who learns shall not find them
    (to / "search.js").write_text(f"const SECTIONS = {json.dumps(found, ensure_ascii=False)};", "utf-8")
    shutil.copy(_DOCS / "try" / "index.html", to / "try.html")
    return to / "index.html"


def _ready(source, public, run):
    """Path of what `export` makes the page of: a text, or a notebook that was run."""
    if source.suffix == ".md" or not run:
        return public if source.name == public.name else source
    copy = _COPIES / source.name
    made_from = [source, *(path for path in (PROJECT / "ir50p_lab").rglob("*.py") if "publishing" not in path.parts)]
    if not copy.is_file() or copy.stat().st_mtime < max(path.stat().st_mtime for path in made_from):
        nb = nbformat.read(source, as_version=4)
        with tempfile.TemporaryDirectory() as home:
            execute(nb, source, IR50P_HOME=home, IR50P_ARM="")
        copy.parent.mkdir(parents=True, exist_ok=True)
        replace_text(copy, nbformat.writes(nb))
    return copy


def _sections(name, page):
    """[address, heading, text] of each section; the first heading is the page's."""
    _, *parts = re.split(r'<h[123] id="([^"]*)">(.*?)</h[123]>', page, flags=re.DOTALL)
    return [[f"{name}#{at}", _plain(head), _plain(text)] for at, head, text in zip(*[iter(parts)] * 3, strict=True)]


def _plain(page):
    page = re.sub(r"<(script|style|svg)\b.*?</\1>|<[^>]+>|¶", " ", page, flags=re.DOTALL)
    return " ".join(html.unescape(page).split())


def _linked(page, folder, places):
    """The page with links to files of the project leading to their pages; of other files the words are left."""

    def link(found):
        path, place, words = found.groups()
        name = places.get((folder / path).resolve())
        return f'<a href="{name}{place}">{words}</a>' if name else words

    return re.sub(r'<a href="(?!\w+:)([^"#]+)(#[^"]*|)"[^>]*>(.*?)</a>', link, page, flags=re.DOTALL)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python3 -m ir50p_lab book", description=__doc__.partition(". ")[0])
    parser.add_argument("folder", nargs="?", type=Path, default=Path("book"), help="where it goes (default: book)")
    try:
        print(book(parser.parse_args().folder))
    except LabError as problem:
        sys.exit(str(problem))
