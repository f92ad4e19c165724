"""The functions of notebooks 00 to 03: each right, its cases, and how it is wrong (NAME.txt)."""
