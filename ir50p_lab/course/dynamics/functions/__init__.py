"""The functions of notebooks 04 and 05, one file each."""
