"""The print of a calibration board: its size, and which points are black."""

import functools

import numpy as np

from ir50p_lab.vision.calibration.board import Charuco

_PER_SQUARE = 350  # pixels: of a marker 252 where it has 0.72 of a square, whole ones for each of its 7 cells


def print_range(board):
    """x and y range (from, to) m of the sheet, border included."""
    columns, rows = board.pattern
    s, b = board.square, board.border
    return (-s - b, columns * s + b), (-s - b, rows * s + b)


def black(board, u, v):
    """Where (n,) the print is black at u, v (n,) m; u is along the rows."""
    columns, rows = board.pattern
    i, j = np.floor(u / board.square).astype(int) + 1, np.floor(v / board.square).astype(int) + 1
    inside = (i >= 0) & (i <= columns) & (j >= 0) & (j <= rows)
    dark = inside & ((i + j) % 2 == 0)
    if board.kind == "charuco":
        light = np.flatnonzero(inside & ~dark)
        picture = _markers(columns, rows, board.square, board.marker, board.dictionary)
        row, column = (((at[light] / board.square + 1) * _PER_SQUARE).astype(int) for at in (v, u))
        dark[light] = picture[row, column] == 0
    return dark


@functools.lru_cache(maxsize=8)
def _markers(columns, rows, square, marker, dictionary):
    """The whole board as OpenCV draws it, _PER_SQUARE pixels a square."""
    size = (columns + 1) * _PER_SQUARE, (rows + 1) * _PER_SQUARE
    return Charuco((columns, rows), square, marker, dictionary).opencv().generateImage(size)
