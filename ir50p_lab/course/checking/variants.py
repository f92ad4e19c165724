"""A right solution with one step changed, every step in every usual way: what a slip of the pen computes."""

import ast
import copy
import inspect
import math
import re
from collections import defaultdict
from functools import cache

import numpy as np

from ir50p_lab.course.checking.task import Mistake, picked, table

_OPERATIONS = {ast.MatMult: "@", ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
_OWN_WORDS = ("condition", "loop", "what_it_returns", "half_a_turn", "the_identity", "frame_1", "frame_2", "frame_3")
_NAMED = re.compile(
    r" \((?:that on )?(?P<named>[\w ]+)\)|: look at (?:the )?(?P<place>[\w ]+)$"
    r"|`(?P<quoted>[\w ]+)`(?= (?:is|has|counts|stands))"
)

_SAYS_LITTLE = re.compile("^something stands|something else belongs$")
_MANY_NAMES = 14  # exchanging each for each of more takes seconds


def variants(task):
    """Yield Slips: the loan and the other solutions of a task with one step changed, or one kind of step throughout."""
    from ir50p_lab.course.robot.catalogue import task as find

    room = {"np": np, "math": math, **{name: find(name).right for name in task.leans_on}}
    for text in (task.loan, *task.routes):
        for says, code in _spoilt(text):
            names = dict(room)
            exec(code, names)
            wrong = names[task.function]
            yield Mistake(wrong if task.result is None else picked(wrong, task.result), says, of_code=True)


def in_words_of(function, says):
    """A sentence on a variant without the names that only the course's solution has; and whether it is still whole."""
    function = inspect.unwrap(function)
    file = getattr(getattr(function, "__code__", None), "co_filename", "")
    codes = [getattr(one, "__code__", None) for one in getattr(function, "__globals__", {}).values()]
    known = set(_OWN_WORDS)
    for code in codes:
        if code is not None and code.co_filename == file:
            known |= {*code.co_varnames, *code.co_names}

    lost = []

    def kept(match):
        name = (match["named"] or match["place"] or match["quoted"]).replace(" ", "_")
        if name in known:
            return match[0]
        if name.isdigit():  # the missing number is for the student to find
            return ""
        lost.append(not match["place"])
        return "something" if match["quoted"] else ""

    words = _NAMED.sub(kept, says)
    if _SAYS_LITTLE.search(words):
        return "", False
    return words, not any(lost)


@cache
def _spoilt(text):
    """Pairs (words, code) of a solution: nodes are changed in place, and back."""
    tree = ast.parse(text)
    found = []
    for function in tree.body:
        alike = defaultdict(dict)
        for node, words, other, place in _all_changes(function):
            found.append((f"{words}: look at {place}", _compiled(tree, {node: other})))
            for kind in () if words.startswith("`") else (words, f"{words}: look at {place}"):
                alike[kind].setdefault(node, other)
        found += [(words, _compiled(tree, changes)) for words, changes in alike.items() if len(changes) > 1]
    return [(words, code) for words, code in found if code]


def _compiled(tree, changes):
    before = {node: (node.__class__, dict(node.__dict__)) for node in changes}
    for node, other in changes.items():
        node.__class__, node.__dict__ = other.__class__, dict(other.__dict__)
    try:
        if any(map(_endless, ast.walk(tree))):
            return None
        return compile(ast.fix_missing_locations(tree), "<variant>", "exec")
    except (SyntaxError, ValueError):
        return None
    finally:
        for node, (kind, parts) in before.items():
            node.__class__, node.__dict__ = kind, parts


def _endless(node):
    """Tell whether a loop goes through a list that it makes longer."""
    grown = (one.value for one in ast.walk(node) if isinstance(one, ast.Attribute) and one.attr == "append")
    return isinstance(node, ast.For) and ast.dump(node.iter) in map(ast.dump, grown)


def _all_changes(function):
    """Every change of every node of a function: node, words, the other node, where it stands."""
    local = {one.id for one in ast.walk(function) if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)}
    local |= {one.arg for one in function.args.args}
    last = [one for one in ast.walk(function) if isinstance(one, ast.Return)][-1]
    statements = _statements(function)
    filled = {
        node.value for node in ast.walk(function) if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store)
    }
    lists = [node.iter for node in ast.walk(function) if isinstance(node, ast.For) and isinstance(node.iter, ast.List)]
    margins = [one for one in ast.walk(function) if isinstance(one, ast.Compare) and any(map(_tiny, ast.walk(one)))]
    left_alone = filled.union(*map(ast.walk, lists), *map(ast.walk, margins))
    for node in [one for one in ast.walk(function) if one not in left_alone]:
        place = _place(statements.get(id(node)))
        for words, other in _changes(node, local, last):
            yield node, words, other, place


def _statements(function):
    """The innermost statement that holds each node."""
    found = {}
    for statement in ast.walk(function):
        if isinstance(statement, ast.stmt):
            found |= {id(node): statement for node in ast.walk(statement)}
    return found


def _place(statement):
    """Where a step stands, by what it computes: names of a solution are words."""
    match statement:
        case ast.Assign(targets=[target]):
            name = next(one.id for one in ast.walk(target) if isinstance(one, ast.Name))
            place = re.sub(r"^(?!out$)(?=.*_|[a-z]{3})", "the ", re.sub(r"^T(?=\d)", "frame ", name)).replace("_", " ")
        case ast.If():
            place = "the condition"
        case ast.For():
            place = "the loop"
        case _:
            place = "what it returns"
    return place


def _changes(node, local, last):
    """Pairs (words, the node in its place)."""
    match node:
        case ast.BinOp(left=left, op=op, right=right) if not (_tiny(left) or _tiny(right)):
            yield from _of_table(node, _OPERATIONS.get(type(op)), left, right)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            yield "a minus is missing", operand
        case ast.Call(func=ast.Attribute(attr=name), args=args):
            yield from _of_table(node, name, *args)
        case ast.Call(func=ast.Name(id="range"), args=[count]):
            yield from _of_table(node, "range", count)
        case ast.Call(func=function, args=args):
            for turned in (args[1:] + args[:1], args[-1:] + args[:-1]) if len(args) > 2 else ():
                words = f"the arguments of `{ast.unparse(function)}` stand in another order than it takes them"
                yield words, ast.Call(function, turned, [])
            for k in range(len(args) - 1):
                swapped = [*args[:k], args[k + 1], args[k], *args[k + 2 :]]
                words = f"arguments {k + 1} and {k + 2} of `{ast.unparse(function)}` have changed places"
                yield words, ast.Call(function, swapped, [])
        case ast.Attribute(value=ast.Name(id="np"), attr="pi"):
            yield from _of_table(node, "pi")
        case ast.Attribute(value=value, attr="T"):
            yield "a transpose is missing", value
        case ast.Subscript(value=value, slice=ast.Tuple(elts=[*places]), ctx=ast.Load()):
            yield "the whole is taken where a part of it is needed", value
            other = ast.Subscript(value, ast.Tuple(places[::-1], ast.Load()), node.ctx)
            yield "a row is read where a column belongs", other
            for k, place in enumerate(places):
                for step in (1, -1, 2, -2, -3) if isinstance(place, ast.Constant) else ():
                    moved = [*places[:k], ast.Constant(place.value + step), *places[k + 1 :]]
                    words = "another row or column is read than the one needed, counted from 0"
                    yield words, ast.Subscript(value, ast.Tuple(moved, ast.Load()), node.ctx)
        case ast.Subscript(value=value, slice=ast.Constant(value=int(k)), ctx=ast.Load()):
            for step in (1, -1, 2, -2, -3):
                if k + step >= 0:
                    words = f"number {k + step} of {ast.unparse(value)} is taken, not the one needed, counted from 0"
                    yield words, ast.Subscript(value, ast.Constant(k + step), node.ctx)
        case ast.Subscript(value=value, slice=ast.Name() as k, ctx=ast.Load()):
            for words, op in (("late: the first round needs number 0", ast.Add()), ("early", ast.Sub())):
                moved = ast.BinOp(k, op, ast.Constant(1))
                yield f"{ast.unparse(value)} is read one place too {words}", ast.Subscript(value, moved, node.ctx)
            words = f"number 1 of {ast.unparse(value)} is taken each time"
            yield words, ast.Subscript(value, ast.Constant(0), node.ctx)
        case ast.For(target=target, iter=rounds, body=body):
            yield "it returns inside the loop, after the first round", ast.For(target, rounds, [*body, last], [])
        case ast.Assign(targets=[ast.Subscript()]):
            yield "a part of it is never filled in", ast.Pass()
        case ast.Tuple(elts=elts, ctx=ast.Store()):
            for k in range(len(elts) - 1):
                swapped = [*elts[:k], elts[k + 1], elts[k], *elts[k + 2 :]]
                words = f"{ast.unparse(elts[k])} and {ast.unparse(elts[k + 1])} have changed places"
                yield words, ast.Tuple(swapped, ast.Store())
        case ast.Name(id=name, ctx=ast.Load()) if name in local:
            for other in sorted(local - {name}) if len(local) < _MANY_NAMES else ():
                yield f"`{other.replace('_', ' ')}` stands where something else belongs", ast.Name(other, ast.Load())
            yield from _of_table(node, "a name")


def _of_table(node, step, *parts):
    """What the table makes of a step: the name of a function of NumPy, an operation, "a name"; a, b: its parts."""
    own = dict(zip("ab", parts, strict=False)) | {"step": copy.copy(node)}
    words = {letter: _subject(part) for letter, part in own.items()}
    words["name"] = words["step"] if isinstance(node, ast.Name) else step
    for says, changes in table("steps"):
        for of, other in (change.split("  ->  ") for change in changes):
            if of == step:
                yield says.format(**words), _Filled(own).visit(_parsed(other))


class _Filled(ast.NodeTransformer):
    """Puts nodes in place of names."""

    def __init__(self, nodes):
        self.nodes = nodes

    def visit_Name(self, node):
        """The node that a name stands for."""
        return self.nodes.get(node.id, node)


def _parsed(text):
    return ast.parse(text, mode="eval").body


def _subject(node):
    """What an expression is about: its first name, in words."""
    names = [one.id for one in ast.walk(node) if isinstance(one, ast.Name) and one.id not in ("np", "math")]
    text = names[0].replace("_", " ") if names else ast.unparse(node)
    return "half a turn" if text == "np.pi" else "the identity" if "eye" in text else text


def _tiny(node):
    """A margin for rounding, 1e-9."""
    return isinstance(node, ast.Constant) and isinstance(node.value, float) and 0 < node.value < 1e-6
