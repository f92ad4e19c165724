"""The functions of notebook 10, one file each."""
