"""The functions of notebooks 08 and 09: each right, its trials, and how it is wrong (NAME.txt)."""
