"""The student's lab book: predictions, notes and figures; beside it results, claims and progress."""

from ir50p_lab.course.lab_book.predictions import change, keep, measured, note, now, path, predict, read
from ir50p_lab.course.lab_book.student_file import LabBookError

__all__ = ["LabBookError", "change", "keep", "measured", "note", "now", "path", "predict", "read"]
