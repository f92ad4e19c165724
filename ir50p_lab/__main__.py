"""The launcher: ``python3 -m ir50p_lab`` (Windows: ``py -m ir50p_lab``).

This file and ``__init__.py`` keep to a syntax that Pythons too old to run the course still understand (2.7 on), so
that they answer with a sentence; everything newer is in ``launcher/`` and imported after the gate.
"""

import sys

if sys.version_info < (3, 11):
    sys.exit(
        "The IR50P lab book needs Python 3.11 or newer; this is Python %d.%d.%d (%s).\n"
        "Get a newer one from https://www.python.org/downloads/ and start it by its own name, "
        "for example: python3.13 -m ir50p_lab (Windows: py -3.13 -m ir50p_lab)"
        % (sys.version_info[0], sys.version_info[1], sys.version_info[2], sys.executable)
    )

from ir50p_lab.launcher.commands import main

sys.exit(main(sys.argv[1:]))
