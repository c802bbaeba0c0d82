"""Diagrams of gathers that see a matrix of receivers and VPLs."""

from __future__ import annotations

from .shapes import CLUSTERS, STRONG, VPL, Drawing, Point

MATRIX: Point = (52, 18)
CELL: Point = (11, 8.5)
# The cluster of each column, by slice. Capitals: the column of a cluster that is computed.
ALIKE = ("aAabBbcCDdbbccaa", "abBacDaAbcdbCada", "DdCcaaBbbbAaddca")


def draw_row(d: Drawing, row: float, alike: str, sampled: bool) -> None:
    for column, cluster in enumerate(alike):
        fill = 0.95 if cluster.isupper() else 0.4 if sampled else 0
        draw_cell(d, row, column, CLUSTERS["abcd".index(cluster.lower())], fill)


def draw_cell(d: Drawing, row: float, column: int, colour: str, fill: float) -> None:
    corner = MATRIX[0] + CELL[0] * column, MATRIX[1] + CELL[1] * row
    d.box(corner, (CELL[0] - 1.5, CELL[1] - 1.5), colour if fill else STRONG, fill, 0.6)


def mrcs(d: Drawing) -> None:
    sampled = (1, 5, 8)
    for row in range(10):
        draw_row(d, row, ALIKE[1], row in sampled)
    for row in sampled:
        y = MATRIX[1] + CELL[1] * (row + 0.4)
        d.arrow((MATRIX[0] - 12, y), (MATRIX[0] - 3, y))
        d.text((MATRIX[0] - 15, y + 3), "row", "end")
    d.text((MATRIX[0], 11), "VPLs (colour: cluster)")
    d.text((MATRIX[0], 118), "rows → clusters → one column each")


def lightslice(d: Drawing) -> None:
    for s, alike in enumerate(ALIKE):
        for row in range(3):
            draw_row(d, 3.7 * s + row, alike, row == 1)
        y = MATRIX[1] + CELL[1] * (3.7 * s + 1.4)
        d.arrow((MATRIX[0] - 12, y), (MATRIX[0] - 3, y))
        d.text((MATRIX[0] - 15, y + 3), f"slice {s + 1}", "end")
    d.text((MATRIX[0], 11), "VPLs (colour: cluster)")
    d.text((MATRIX[0], 124), "each slice clusters by itself")


def matrix_completion(d: Drawing) -> None:
    kinds, full = "0010110100101101", (0, 2)
    lit = {"0": range(0, 6), "1": range(3, 10)}
    for column, kind in enumerate(kinds):
        for row in range(10):
            traced = column in full or (row * 7 + column * 3) % 10 in (0, 5)
            colour = VPL if row in lit[kind] else STRONG
            draw_cell(d, row, column, colour, 0.95 if traced else 0.25)
    for column in full:
        x = MATRIX[0] + CELL[0] * (column + 0.4)
        d.arrow((x, 116), (x, 107))
    d.text((MATRIX[0], 11), "VPLs (yellow: visible, grey: not)")
    d.text((MATRIX[0] - 5, 52), "samples\nof a tile", "end")
    d.text((MATRIX[0] + 36, 117), "strong: rays, pale: completed")
    d.text((MATRIX[0] - 5, 117), "in full", "end")
