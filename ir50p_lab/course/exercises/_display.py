"""How a verdict and the progress table look, in a notebook and as plain text."""

from __future__ import annotations

import html
import re
import textwrap
from dataclasses import dataclass

# Okabe-Ito colours (safe for colour-blind readers); the words carry the meaning, the bar only supports it.
_COLOURS = {"right": "#009E73", "open": "#999999", "slip": "#E69F00", "wrong": "#E69F00"}


@dataclass(frozen=True)
class Note:
    """One or two sentences: a bar and text in a notebook, a line elsewhere."""

    state: str
    name: str
    text: str

    def __repr__(self) -> str:
        """Plain text."""
        return f"{self.name}: {self.text}"

    def _repr_html_(self) -> str:
        colour = _COLOURS.get(self.state, "#D55E00")
        text = re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(self.text, quote=False))
        return (
            f'<div style="border-left: 5px solid {colour}; padding: 2px 0 2px 12px; margin: 2px 0">'
            f"<b>{html.escape(self.name)}</b>: {text}</div>"
        )


@dataclass(frozen=True)
class Table:
    """The exercises by notebook: rows of (notebook, name, task, time or None), and a note below."""

    rows: tuple[tuple[str, str, str, str | None], ...]
    note: str = ""

    @property
    def _summary(self) -> str:
        done = sum(when is not None for *_, when in self.rows)
        return f"{done} of {len(self.rows)} exercises done. {self.note}".strip()

    def __repr__(self) -> str:
        """Plain text, one exercise a line."""
        lines, last = [], None
        for notebook, name, task, when in self.rows:
            if notebook != last:
                lines.append(notebook)
            last = notebook
            state = "done" if when else "open"
            lines.append(f"  {name:<10} {state}  {textwrap.shorten(task, 80, placeholder=' ...')}")
        return "\n".join([*lines, self._summary])

    def _repr_html_(self) -> str:
        body, last = [], None
        for notebook, name, task, when in self.rows:
            first = notebook if notebook != last else ""
            last = notebook
            state = f'<b style="color: #009E73">done</b> {when[:10]}' if when else "open"
            cells = (
                f"<b>{html.escape(first)}</b>",
                f"<nobr>{html.escape(name)}</nobr>",
                html.escape(task, quote=False),
                state,
            )
            row = "".join(f'<td style="text-align: left; padding: 3px 12px">{cell}</td>' for cell in cells)
            body.append(f"<tr>{row}</tr>")
        head = "".join(f'<th style="text-align: left">{title}</th>' for title in ("notebook", "", "task", "state"))
        return f"<table><tr>{head}</tr>{''.join(body)}</table><p>{html.escape(self._summary)}</p>"


def show(thing: Note | Table) -> None:
    """Display in a notebook; print elsewhere."""
    from IPython.display import display

    display(thing)
