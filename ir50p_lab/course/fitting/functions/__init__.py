"""The functions of notebooks 12 and 13, each with the sentences beside it that `check` speaks."""
