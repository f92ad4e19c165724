"""The notebooks and the tests marked `numeric`, as on other processors and with other copies of the arm.

    python3 -m ir50p_lab test --everywhere              every leg; one that passed is not run again
    python3 -m ir50p_lab test --everywhere nehalem      one leg (further arguments go to pytest)
    python3 -m ir50p_lab test --everywhere --turn       the notebooks of one leg, another one for each commit

What passed is remembered in .everywhere/ and forgotten when any file that the legs read changes.
"""

import hashlib
import json
import os
import platform
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

PARALLEL = ("-n", str(os.cpu_count() + 1), "--dist", "worksteal")  # one more than cores: some tests wait for a board
ROOT = Path(__file__).parents[1]
STATE = ROOT / ".everywhere"
READ = ("ir50p_lab", "tests", "notebooks", "data", "pyproject.toml", "environment-test.txt")
ONCE = ("--all", "-k", "not in_a_chain")  # each notebook once: what it hands on does not depend on the processor
SOURCES = {".py", ".ipynb", ".js", ".ino", ".h", ".toml", ".txt", ".csv", ".json", ".npz", ".jpg", ".png"}


def legs():
    """{name: environment variables}. Processors are changed on x86-64 only: nothing else obeys these variables."""
    found = {
        "native": {},
        "generic": {"NUMBA_CPU_NAME": "generic"},
        "no-dispatch": {"NPY_DISABLE_CPU_FEATURES": _numpy_features(), "OPENCV_CPU_DISABLE": _opencv_features()},
        "unit-1": {"IR50P_UNIT": "1"},
        "unit-2": {"IR50P_UNIT": "2"},
        "rounding": {"PYTHONPATH": str(ROOT / "tests" / "rounding")},
    }
    if platform.machine().lower() in ("x86_64", "amd64"):
        found |= {"haswell": {"OPENBLAS_CORETYPE": "Haswell"}, "nehalem": {"OPENBLAS_CORETYPE": "Nehalem"}}
    return found


def _numpy_features():
    """What this NumPy would choose at run time on this processor."""
    import numpy as np

    return " ".join(np.show_config(mode="dicts")["SIMD Extensions"].get("found", []))


def _opencv_features():
    """What this OpenCV would choose at run time on this processor: marked * in its list, ? where the processor lacks it."""
    import cv2

    return ",".join(f.strip("*") for f in cv2.getCPUFeaturesLine().split() if f.startswith("*") and not f.endswith("?"))


def run(name, variables, arguments):
    """Run one leg. Returns {"passed", "failed", "seconds"}; names of tests that failed."""
    STATE.mkdir(exist_ok=True)
    report = STATE / f"{name}.xml"
    report.unlink(missing_ok=True)
    environment = os.environ | variables
    if "NUMBA_CPU_NAME" in variables:  # its machine code is kept apart, for the next run
        environment["NUMBA_CACHE_DIR"] = str(STATE / f"numba-{name}")
    command = [sys.executable, "-m", "pytest", *PARALLEL, f"--junitxml={report}", *arguments]
    begin = time.monotonic()
    code = subprocess.run(command, env=environment, cwd=ROOT).returncode
    seconds = time.monotonic() - begin
    cases = list(ElementTree.parse(report).iter("testcase")) if report.exists() else []
    failed = [f"{case.get('classname')}::{case.get('name')}" for case in cases if _has_failed(case)]
    return {"passed": len(cases) - len(failed), "failed": failed, "seconds": round(seconds), "code": code}


def _has_failed(case):
    return case.find("failure") is not None or case.find("error") is not None


def digest():
    """Of every file that the legs read."""
    state = hashlib.sha256()
    for place in READ:
        for path in sorted((ROOT / place).rglob("*")) if (ROOT / place).is_dir() else [ROOT / place]:
            if path.suffix in SOURCES:
                state.update(f"{path.relative_to(ROOT)}\n".encode() + path.read_bytes())
    return state.hexdigest()


def table(results):
    """Return the table of all legs: {name: what `run` returned, with "remembered" for those of an earlier run}."""
    lines = [f"{'leg':<12}{'passed':>7}{'failed':>7}{'minutes':>9}"]
    for name, result in results.items():
        minutes = f"{result['seconds'] / 60:.1f}"
        note = "  (an earlier run)" if result.get("remembered") else ""
        lines.append(f"{name:<12}{result['passed']:>7}{len(result['failed']):>7}{minutes:>9}{note}")
        lines += [f"    {test}" for test in result["failed"]]
        if result["code"] and not result["failed"]:
            lines.append(f"    pytest ended with code {result['code']}")
    return "\n".join(lines)


def main(arguments):
    """Run the legs that have not passed yet; print the table; return the exit code."""
    known = legs()
    if "--turn" in arguments:
        commit = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True
        ).stdout
        names = [name for name in known if name != "native"]  # every run of all tests is that one
        name = names[int(commit, 16) % len(names)]
        print(f"The notebooks, leg '{name}'", flush=True)
        rest = [argument for argument in arguments if argument != "--turn"]
        return run(name, known[name], ["-m", "notebook", *rest])["code"]
    chosen = [argument for argument in arguments if argument in known]
    further = [argument for argument in arguments if argument not in known]
    memory = STATE / "passed.json"
    key = digest() + " ".join(further)
    try:
        remembered = json.loads(memory.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        remembered = {}
    passed = remembered.get(key, {})
    results = {}
    for name in chosen or known:
        if name in passed:
            results[name] = passed[name] | {"remembered": True}
            continue
        print(f"\n== leg {name}: {known[name] or 'this machine as it is'}", flush=True)
        results[name] = run(name, known[name], ["-m", "notebook or numeric", *ONCE, *further])
        if results[name]["code"] == 0:
            passed[name] = results[name]
            memory.write_text(json.dumps({key: passed}), encoding="utf-8")
    print(f"\n{table(results)}")
    return max(result["code"] for result in results.values())
