"""The functions of notebooks 06 and 07, one file each."""
