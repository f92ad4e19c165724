"""The print of a calibration board: its size, and which points are black."""

import functools

import numpy as np

from ir50p_lab.vision.calibration.board import Charuco


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
        at = np.flatnonzero(inside & ~dark)
        dark[at] = _marker(board, u[at], v[at], i[at], j[at])
    return dark


def _marker(board, u, v, i, j):
    """Where the markers in the white squares i, j are black at u, v."""
    columns, rows = board.pattern
    numbers, bits = _markers(columns, rows, board.square, board.marker, board.dictionary)
    cells = bits.shape[1]
    gap = (board.square - board.marker) / 2
    x = np.floor((u - (i - 1) * board.square - gap) / board.marker * cells).astype(int)
    y = np.floor((v - (j - 1) * board.square - gap) / board.marker * cells).astype(int)
    on = (x >= 0) & (x < cells) & (y >= 0) & (y < cells)
    dark = np.zeros(len(u), dtype=bool)
    dark[on] = bits[numbers[j[on], i[on]], y[on], x[on]] == 0
    return dark


@functools.lru_cache(maxsize=8)
def _markers(columns, rows, square, marker, dictionary):
    """Number of the marker in each square [row, column], -1 for none; their bits (n, cells, cells), 0 is black."""
    board = Charuco((columns, rows), square, marker, dictionary).opencv()
    numbers = np.full((rows + 1, columns + 1), -1)
    cells = board.getDictionary().markerSize + 2
    bits = []
    for corners, number in zip(board.getObjPoints(), board.getIds().ravel(), strict=True):
        i, j = (np.mean(corners, axis=0)[:2] // square).astype(int)
        numbers[j, i] = len(bits)
        bits.append(board.getDictionary().generateImageMarker(int(number), cells))
    return numbers, np.array(bits)
