"""Exercises: check(name, answer) says in a sentence what it found; progress() shows what is done.

In a notebook:

    answer = ...                # the stub runs as it is
    check("start-1", answer)    # "start-1: not answered yet. To find: ..."

For instructors: solution("start-1") returns the right answer, exercises() lists the names. The progress file is
progress.json in the student's folder (IR50P_HOME), or the file that the environment variable IR50P_PROGRESS names.

Adding exercises
----------------
One module per notebook in this folder, named after the prefix of its exercises: "ik-1" lives in ik.py, which is
imported only when an "ik-" exercise is asked for. It defines two names:

    NOTEBOOK = "02_inverse_kinematics"     # stem of the notebook's file name
    EXERCISES = (Exercise(...), ...)

    Exercise(
        "ik-1",
        "the joint angles q of the branch front/up for p = (0.3, 0.1, 0.4) m",       # the task, one line
        Number(right, unit="rad", tolerance=1e-3, angle=True),
        why="All four branches put the tip on the same point; the joint limits choose.",
        slips={"That is the elbow-down branch: the sign of sin q3 chooses.": down, ...},
    )

Kinds of answer (each documents its options):
    Number(right, unit=, tolerance=, because=, angle=)   number, vector or matrix
    Function(right, cases, unit=, tolerance=)            tried out on the cases, values compared

Rules:
- Compute `right` with the package and with constants of this module (IR50P, not load_arm()): the student's
  variables, or another arm, must not move it. Task and figures in the notebook state the same constants.
- `slips`: {what to say: a wrong answer, or a function of the right one (np.negative)}; for a Function the wrong
  function. Numbers bring common slips along: the sign; degrees (unit="rad"); millimetres (unit="m");
  functions those of `checking/distortions.py`. Name at least three, with different messages, none equal to another
  or to the right answer. A message says what is wrong and where to look, never the answer. The student's answer is
  repeated in front of it.
- `why` is read after a right answer: one line on what it is good for.
- `hint=` is added to the message for an answer that is wrong in no known way.
- A function stub in a notebook is `def answer(q): ...`; a stub with several parts may be `(..., ...)`.
- `pytest tests/course/exercises` tries every exercise of every module; read start.py as the example.
"""

import textwrap
from dataclasses import replace

from ir50p_lab.course.checking.note import Note, show
from ir50p_lab.course.exercises._answers import Exercise, grade
from ir50p_lab.course.exercises._catalogue import everything, find
from ir50p_lab.course.exercises._functions import Function
from ir50p_lab.course.exercises._numbers import Number
from ir50p_lab.course.lab_book.progress import read_progress, record
from ir50p_lab.course.lab_book.student_file import LabBookError
from ir50p_lab.errors import InputError

__all__ = ["Exercise", "Function", "Number", "check", "exercises", "grade", "progress", "solution"]


def check(name: str, answer=...) -> None:
    """Say in one or two sentences what was found in an answer; a right one is noted in the progress file.

    name: of the exercise, such as "pose-1". answer: as the question asks; `...` is the stub. Shows a sentence and
    returns None; raises nothing, whatever the answer.
    """
    try:
        exercise = find(name)
    except InputError as error:
        show(Note("unknown", "check", str(error)))
        return
    note = grade(exercise, answer)
    if note.state == "right":
        try:
            record(exercise.name)
        except LabBookError as error:
            note = replace(note, text=f"{note.text} (Not noted: {error})")
    show(note)


def solution(name: str):
    """Return the right answer of an exercise: a float, an array (a copy) or a function.

    Raises InputError for an unknown name.
    """
    right = find(name).kind.right
    return right if callable(right) else right.copy()[()]


def exercises() -> list[str]:
    """Return the names of all exercises, in the order of the notebooks."""
    return [exercise.name for _, exercise in everything()]


def progress() -> None:
    """Print all exercises by notebook: done or open."""
    try:
        done, note = read_progress(), ""
    except LabBookError as error:
        done, note = {}, str(error)
    last = None
    for notebook, one in everything():
        if notebook != last:
            print(notebook)
        last = notebook
        state = "done" if one.name in done else "open"
        print(f"  {one.name:<10} {state}  {textwrap.shorten(one.task, 80, placeholder=' ...')}")
    known = exercises()
    print(f"{sum(name in done for name in known)} of {len(known)} exercises done. {note}".strip())
