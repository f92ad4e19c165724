"""How the grade of an answer looks, in a notebook and as plain text."""

import html
import re
from dataclasses import dataclass

# Okabe-Ito colours (safe for colour-blind readers); the words carry the meaning, the bar only supports it.
_COLOURS = {"right": "#009E73", "open": "#999999", "mistake": "#E69F00", "wrong": "#E69F00"}


@dataclass(frozen=True)
class Note:
    """A sentence with a bar, and what can be opened below it.

    more: pairs (title, text), of which the first may be open from the start.
    """

    state: str
    name: str
    text: str
    more: tuple[tuple[str, str], ...] = ()
    open_first: bool = False

    def __repr__(self) -> str:
        """Plain text."""
        shown = [f"{title}:\n{text}" for title, text in self.more[: int(self.open_first)]]
        return "\n".join([f"{self.name}: {self.text}", *shown])

    def _repr_html_(self) -> str:
        colour = _COLOURS.get(self.state, "#D55E00")
        text = re.sub(r"`([^`]+)`", r"<code>\1</code>", html.escape(self.text, quote=False))
        folds = "".join(
            f"<details{' open' if self.open_first and k == 0 else ''}><summary>{html.escape(title)}</summary>"
            f"<pre>{html.escape(text)}</pre></details>"
            for k, (title, text) in enumerate(self.more)
        )
        return (
            f'<div style="border-left: 5px solid {colour}; padding: 2px 0 2px 12px; margin: 2px 0">'
            f"<b>{html.escape(self.name)}</b>: {text}{folds}</div>"
        )


def show(note: Note) -> None:
    """Display a Note in a notebook; print it elsewhere."""
    from IPython.display import display

    display(note)


def with_full_stop(says):
    """Return a sentence with its full stop; a question has its mark already."""
    return says if says.endswith(("?", ".")) else f"{says}."
