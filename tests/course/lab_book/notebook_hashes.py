"""Adds the notebooks as they are now to `data/notebook_hashes.txt`, by which `update` tells edited ones."""

from pathlib import Path

from ir50p_lab.course.lab_book.update import notebook_hash

ROOT = Path(__file__).parents[3]

if __name__ == "__main__":
    known = ROOT / "data" / "notebook_hashes.txt"
    hashes = set(known.read_text(encoding="utf-8").split())
    hashes |= {notebook_hash(path) for path in (ROOT / "notebooks").glob("*.ipynb")}
    known.write_text("\n".join(sorted(hashes)) + "\n", encoding="utf-8")
