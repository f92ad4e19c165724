"""The print of a calibration board: which points are black, and where its corners are."""

import numpy as np


def inner_corners(board):
    """Inner corners (n, 3) m of the flat print, row by row: x = column, y = row, in squares."""
    columns, rows = board.pattern
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    return np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]) * float(board.square)


def print_range(board):
    """x and y range (from, to) m of the sheet, border included."""
    columns, rows = board.pattern
    s, b = board.square, board.border
    return (-s - b, columns * s + b), (-s - b, rows * s + b)


def black(board, u, v):
    """Where (n,) the print is black at u, v (n,) m, and a code (n,) of the square."""
    columns, rows = board.pattern
    i, j = np.floor(u / board.square).astype(int) + 1, np.floor(v / board.square).astype(int) + 1
    inside = (i >= 0) & (i <= columns) & (j >= 0) & (j <= rows)
    dark = inside & ((i + j) % 2 == 0)
    return dark, dark.astype(np.int16)
