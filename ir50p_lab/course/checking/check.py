"""check(name, answer): what a student wrote is tried, graded, and kept if it is right."""

import ast
import hashlib
import random
import timeit

from ir50p_lab.course import lab_book
from ir50p_lab.course.checking.cell import extract
from ir50p_lab.course.checking.grade import grade
from ir50p_lab.course.checking.in_notebook import check_here
from ir50p_lab.course.checking.judge_text import CannotTake, has_dots
from ir50p_lab.course.checking.note import Note, show, with_full_stop
from ir50p_lab.course.checking.numbers import check_number
from ir50p_lab.course.checking.tasks import task
from ir50p_lab.course.lab_book.progress import record
from ir50p_lab.course.robot import student_package
from ir50p_lab.course.robot.catalogue import ORDER, is_function, stays, work_at
from ir50p_lab.errors import InputError

_BEFORE_SCRAMBLE, _BEFORE_LOAN = 3, 6  # different failing sources


def check(name, answer=...):
    """Say in a sentence what was found in an answer; a function that is right becomes part of `my_robot`.

    name: of a function ("rot_z"), a stage of a class ("PID.p") or a number exercise ("start-1").
    answer: the function or class itself, or the number.
    Shows a sentence and returns None. For a function that stays in its notebook it returns the one to go on with: the
    student's if it is right, else the course's. Raises nothing, whatever the answer does.
    """
    if stays(str(name)):
        return check_here(name, answer)
    if not is_function(str(name)):
        return check_number(name, answer)
    wanted = task(name)
    work_at(name)
    if answer is ...:
        return _show("open", name, f"not written yet: {wanted.returns}")
    try:
        source = extract(answer, wanted.function, wanted.leans_on, wanted.given, wanted.function_arguments)
    except CannotTake as reason:
        return _show("wrong", name, f"not yet: {with_full_stop(str(reason))}")
    if dots := has_dots(source.text):
        where = f": there are still dots in `{dots[0]}`" if dots[0].strip(".") else ""
        return _show("open", name, f"not written yet{where}. It returns {wanted.returns}.")
    result = grade(wanted, source)
    if result.state == "right":
        return _keep(source, wanted, result.says)
    return _wrong(source, wanted, result)


def reset(name):
    """Start a function again: yours is moved to my_robot/old, and the course's stands in for it."""
    if not is_function(str(name)):
        raise InputError(f"{name!r} is not a function of my_robot; those are {', '.join(ORDER)}")
    student_package.put_aside(name)
    lab_book.change(lambda book: book["attempts"].pop(name, None))
    print(f"{name}: started again; what you had is in {student_package.folder() / 'old'}")


def _keep(source, wanted, remark):
    whole = "." in wanted.name and student_package.whose(wanted.function) == "yours"
    try:
        lent = student_package.keep(source, wanted, task)
        record(wanted.name)
    except (OSError, lab_book.LabBookError) as error:
        return _show("right", wanted.name, f"right, but it could not be kept: {error}")
    more = f" {', '.join(lent)}, which it calls, came along on loan: write your own." if lent else ""
    more += f" Your finished {wanted.function} was moved to my_robot/old: check it again last." if whole else ""
    kind = "class" if isinstance(wanted.reference, type) else "function"
    text = f"right, and yours: from now on my_robot.{wanted.function} is this {kind}.{more} {remark}".rstrip()
    return _show("right", wanted.name, text, _beside(source, wanted))


def _beside(source, wanted):
    """Both listings, and both speeds of a function."""
    title = "yours beside the course's"
    if wanted.cases is not None:
        case, both = wanted.cases()[0], (student_package.load(wanted.name), wanted.reference)
        speeds = [min(timeit.repeat(lambda f=f: f(*case), number=20, repeat=3)) / 20 * 1e6 for f in both]
        if min(speeds) >= 1:  # the clock of a browser tab is too coarse for short functions
            title += f": {speeds[0]:.0f} and {speeds[1]:.0f} microseconds a call"
    return [(title, f"# yours\n{source.text}\n\n# the course's, without its checks\n{wanted.solution_text}")]


def _wrong(source, wanted, result):
    mark = hashlib.sha256(ast.dump(ast.parse(source.text)).encode()).hexdigest()[:12]

    def edit(book):
        tried = book["attempts"].get(wanted.name, {})
        marks = tried if isinstance(tried, dict) else dict.fromkeys(tried, "")  # older books have no sentences
        book["attempts"][wanted.name] = marks | {mark: result.says[:100]}
        return len(book["attempts"][wanted.name])

    tries, says = 0, f"not yet: {with_full_stop(result.says)}"
    try:
        tries = lab_book.change(edit)
    except lab_book.LabBookError as error:
        says += f" (This try was not counted: {error}.)"
    more = [("one input that fails", result.example)] if result.example else []
    if tries >= _BEFORE_LOAN and not any(map(student_package.is_there, (wanted.name, wanted.function))):
        student_package.lend(wanted, task)
        says += (
            f" The course lends you its {wanted.name}, so that you can go on; it is marked as a loan in your report."
        )
    elif tries >= _BEFORE_SCRAMBLE:
        lines = [line for line in wanted.solution_text.splitlines() if line.strip()]
        random.Random(wanted.name).shuffle(lines)
        more.append(("the lines of a solution, in the wrong order", "\n".join(line.strip() for line in lines)))
    else:
        more += [(f"hint {k + 1}", hint) for k, hint in enumerate(wanted.hints) if hint]
    return _show("wrong", wanted.name, says, more, open_first=bool(result.example))


def _show(state, name, text, more=(), *, open_first=False):
    show(Note(state, str(name), text, tuple(more), open_first))
