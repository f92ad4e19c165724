"""The page to try: what a visitor sees move before anything is installed.

`python3 -m ir50p_lab try-page` runs docs/try/try.ipynb and writes docs/try/index.html; nothing else does.
"""

import hashlib
from pathlib import Path

from ir50p_lab.course.live_arm.view import BUNDLE
from ir50p_lab.course.publishing import export as pages
from ir50p_lab.course.publishing import pictures
from ir50p_lab.home import PROJECT

FOLDER = PROJECT / "docs" / "try"
NOTEBOOK, PAGE, MADE_FROM = FOLDER / "try.ipynb", FOLDER / "index.html", FOLDER / "made_from.txt"
_STYLE, _SCRIPT = FOLDER / "try.css", FOLDER / "try.js"
_SOURCES = (NOTEBOOK, _STYLE, _SCRIPT, BUNDLE, Path(pages.__file__), Path(pictures.__file__))


def fingerprint():
    """Return a hash of what the page is made from: its notebook, the view of the arm, and how pages are written."""
    return hashlib.sha256("".join(path.read_text("utf-8") for path in _SOURCES).encode()).hexdigest()


def main():
    """Run the notebook, and write the page and the hash of what it was made from."""
    (made,) = pages.export(NOTEBOOK, FOLDER, pdf=False, code=False, title="The IR50P lab book: a page to try")
    page, style, script = (path.read_text(encoding="utf-8") for path in (made, _STYLE, _SCRIPT))
    page = page.replace("</style></head>", f"{style}</style></head>", 1)
    PAGE.write_text(page.replace("</body>", f"<script type='module'>{script}</script></body>"), encoding="utf-8")
    made.unlink()
    MADE_FROM.write_text(fingerprint() + "\n", encoding="utf-8")
    print(f"{PAGE}: {PAGE.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
