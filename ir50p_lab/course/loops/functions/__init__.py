"""The functions of notebooks 08 and 09, one file each."""
