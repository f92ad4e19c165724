"""Numbers of notebooks 04 and 05."""

NUMBERS = ()
