"""What the name of a prediction or a figure means, in words: names.txt."""

from functools import cache
from pathlib import Path


@cache
def titles():
    """Return {name: words} from names.txt."""
    lines = Path(__file__).with_name("names.txt").read_text("utf-8").splitlines()
    return dict(line.split(": ", 1) for line in lines)


def title(key):
    """Return the title of a number or figure of the lab book: from names.txt, else made from its key."""
    return titles().get(key, key.replace(".", ", ").replace("_", " "))
