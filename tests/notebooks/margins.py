"""How far are the claims of the notebooks from failing? Over units, noise and random draws:

    python tests/notebooks/margins.py 10 12 14 17            # 20 units; a quarter of an hour a notebook on one core
    python tests/notebooks/margins.py 12 --units 5 --jobs 2

Unit k is IR50P_UNIT=k, with every `default_rng(n)` and `seed=n` of the cells moved on by 100 k. Each `claim` has a
room, the distance of its value from its limit (several of an array); a claim whose mean room is under 3 standard
deviations of it is listed, and so is every cell that fails. With --all, every claim is.
"""

import argparse
import json
import os
import re
import sys
import tempfile
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from pathlib import Path

import nbformat
import numpy as np
from notebook_runner import FOLDER, NOTEBOOKS, sockets
from tqdm import tqdm

ENOUGH = 3.0  # standard deviations


def drawn(source, unit):
    """The cell with other random draws."""
    return re.sub(r"(default_rng\(|\bseed=)(\d+)", lambda found: f"{found[1]}{int(found[2]) + 100 * unit}", source)


def run(path, unit):
    """Run a notebook on copy `unit`, past every cell that fails: {claim: [room, ...]}, [(cell, error), ...]."""
    from nbclient import NotebookClient

    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.source = drawn(cell.source, unit)
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder, "claims.jsonl")
        log.touch()
        os.environ |= {"IR50P_UNIT": str(unit), "IR50P_CLAIMS": str(log), "IR50P_BENCH": "simulated"}
        os.environ |= {"IR50P_HOME": folder, "IR50P_PROGRESS": f"{folder}/progress.json", "IR50P_RECORDINGS": folder}
        where = {"metadata": {"path": str(FOLDER)}}
        with sockets() as config:
            NotebookClient(notebook, timeout=600, allow_errors=True, resources=where, config=config).execute()
        rooms = defaultdict(list)
        for line in map(json.loads, log.read_text(encoding="utf-8").splitlines()):
            rooms[line["claim"]] += line["room"]
    outputs = ((k, out) for k, cell in enumerate(notebook.cells) for out in cell.get("outputs", []))
    return dict(rooms), [(k, f"{out.ename}: {out.evalue}") for k, out in outputs if out.output_type == "error"]


def margins(rooms):
    """Of one claim, rooms of many runs: the mean room over its spread, and the smallest room, both at the worst place.

    A claim that was not reached in some run, or with another number of values, is judged by those alike.
    """
    most = max(map(len, rooms))
    rooms = np.array([room for room in rooms if len(room) == most])
    spread = rooms.std(axis=0, ddof=1) if len(rooms) > 1 else np.zeros(most)
    mean = rooms.mean(axis=0)
    ratio = np.divide(mean, spread, out=np.copysign(np.full(most, np.inf), mean), where=spread > 1e-9 * np.abs(mean))
    return float(ratio.min()), float(rooms.min())


def main():
    """Read the command line, run, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("notebooks", nargs="*", help="numbers, as 07; default: all")
    parser.add_argument("--units", type=int, default=20, help="0, 1, ... up to this number")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--all", action="store_true", help="list every claim")
    given = parser.parse_args()
    chosen = [path for path in NOTEBOOKS if not given.notebooks or path.stem[:2] in given.notebooks]
    weak = 0
    with ProcessPoolExecutor(given.jobs, max_tasks_per_child=1) as pool:
        for path in chosen:
            units = range(given.units)
            runs = list(tqdm(pool.map(run, repeat(path), units), total=len(units), desc=path.stem, disable=None))
            print(f"\n{path.stem}: {len(units)} units")
            texts = dict.fromkeys(text for rooms, _ in runs for text in rooms)
            for text in texts:
                ratio, least = margins([rooms[text] for rooms, _ in runs if text in rooms])
                weak += ratio < ENOUGH
                if given.all or ratio < ENOUGH:
                    print(f"  {ratio:8.1f} sd, least room {least:9.3g}  {text}", flush=True)
            for unit, (_, failed) in zip(units, runs, strict=True):
                weak += len(failed)
                for cell, error in failed:
                    print(f"  unit {unit}, cell {cell}: {error}", flush=True)
    return weak > 0


if __name__ == "__main__":
    sys.exit(main())
