"""What is refused, and in which words."""

import re

import pytest

from ir50p_lab.errors import InputError


def refused(words, function, *arguments, error=InputError, **options):
    """Assert that the call raises `error` with these words, one pattern or a list of texts; return all that it says."""
    with pytest.raises(error) as caught:
        function(*arguments, **options)
    said = str(caught.value)
    for word in [words] if isinstance(words, str) else map(re.escape, words):
        assert re.search(word, said), said
    return said
