"""Makes tables that mark the best value of each group."""

from __future__ import annotations

import math
from html import escape
from typing import Any

from diagrams import DIAGRAMS, diagram_svg
from report_json import ReportError

# Viewer and place in its list of images, by the ids of scene, view and image.
Places = dict[tuple[str, str, str], tuple[int, int]]
MINUS = "−"


def number_text(value: float, digits: int) -> str:
    """A number with `digits` significant digits; very small and large ones get an exponent."""
    if value == 0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if size < -4 or size > 6:
        mantissa, power = f"{value:.{digits - 1}e}".split("e")
        return f"{mantissa}e{int(power)}".replace("-", MINUS)
    rounded = round(value, digits - 1 - size)
    size = math.floor(math.log10(abs(rounded))) if rounded else size
    return f"{rounded:.{max(0, digits - 1 - size)}f}".replace("-", MINUS)


def cell_text(value: Any, digits: int, fixed: int | None = None) -> str:
    """Text of a cell with `fixed` decimals if given, else `digits` significant digits."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        centre = cell_text(value[0], digits, fixed)
        decimals = len(centre.partition(".")[2]) if "e" not in centre else None
        error = number_text(value[1], 2) if decimals is None else f"{value[1]:.{decimals}f}"
        return f"{centre} ± {error}"
    if fixed is not None:
        return f"{value:.{fixed}f}".replace("-", MINUS)
    if isinstance(value, int) and abs(value) >= 10**digits:
        return f"{value:,}".replace(",", "\u2009").replace("-", MINUS)
    return number_text(value, digits)


def badness(value: Any, better: str) -> float | None:
    """A rank that is smaller for better values, or None where the value is not judged."""
    if isinstance(value, tuple):
        value = value[0]
    if value is None or isinstance(value, str):
        return None
    if better == "one":
        return abs(math.log(value)) if value > 0 else math.inf
    result: float | None = value if better == "low" else -value
    return result


def groups_of(rows: list[dict[str, Any]]) -> list[tuple[str, list[dict[str, Any]]]]:
    """Groups of consecutive rows with equal names."""
    groups: list[tuple[str, list[dict[str, Any]]]] = []
    for row in rows:
        if not groups or groups[-1][0] != row["group"]:
            groups.append((row["group"], []))
        groups[-1][1].append(row)
    return groups


def best_rows(rows: list[dict[str, Any]], column: dict[str, Any]) -> set[int]:
    """Best rows of a group for a column; empty where fewer than two are judged."""
    if column["better"] is None:
        return set()
    found = {
        i: badness(row["cells"][column["key"]], column["better"])
        for i, row in enumerate(rows)
        if row["judged"]
    }
    judged = {i: v for i, v in found.items() if v is not None}
    if len(judged) < 2:
        return set()
    return {i for i, v in judged.items() if v == min(judged.values())}


def is_text(column: dict[str, Any], rows: list[dict[str, Any]]) -> bool:
    return any(isinstance(row["cells"][column["key"]], str) for row in rows)


def head(columns: list[dict[str, Any]], text: list[bool], sorts: bool) -> str:
    hints = {"low": "lower is better", "high": "higher is better", "one": "1 is best"}
    cells: list[str] = []
    for column, left in zip(columns, text, strict=True):
        hint = hints.get(column["better"], "")
        below = " · ".join(t for t in (column["unit"], hint) if t)
        small = f"<small>{escape(below)}</small>" if below else ""
        label = escape(column["label"])
        if sorts:
            label = f'<button type="button" data-column="{len(cells)}">{label}</button>'
        cells.append(f'<th scope="col"{" class=text" if left else ""}>{label}{small}</th>')
    return "<thead><tr>" + "".join(cells) + "</tr></thead>"


def plain(value: Any) -> str:
    """Value of a cell as filters and sorting compare it."""
    value = value[0] if isinstance(value, tuple) else value
    return "" if value is None else str(value)


def filters_html(table: dict[str, Any], columns: list[dict[str, Any]]) -> str:
    """Lists of the values of the columns that choose rows, and of the measures, to see one alone."""
    parts = ['<div class="filters">']
    for k, column in enumerate(columns):
        if column["key"] not in table["filters"]:
            continue
        found = list(dict.fromkeys(plain(row["cells"][column["key"]]) for row in table["rows"]))
        options = "".join(f'<option value="{escape(v)}">{escape(v)}</option>' for v in found if v)
        parts.append(
            f'<label>{escape(column["label"])} <select data-column="{k}">'
            f'<option value="">all</option>{options}</select></label>'
        )
    measures = [(k, column["label"]) for k, column in enumerate(columns) if column["better"]]
    if len(measures) > 1:
        options = "".join(f'<option value="{k}">{escape(name)}</option>' for k, name in measures)
        parts.append(
            '<label>measure <select class="measures"><option value="">all</option>'
            f"{options}</select></label>"
        )
    return "".join(parts) + "</div>"


def table_html(table: dict[str, Any], places: Places) -> str:
    columns = [c for c in table["columns"] if c["key"] != "group"]
    text = [is_text(c, table["rows"]) for c in columns]
    filtered = bool(table["filters"])
    parts = [
        f'<section class="block{" filtered" if filtered else ""}" id="table-{table["id"]}">'
        f"<h2>{escape(table['title'])}</h2>"
    ]
    if table["note"]:
        parts.append(f'<p class="note">{escape(table["note"])}</p>')
    if filtered:
        parts.append(filters_html(table, columns))
    # The table takes focus, so that arrow keys scroll it where it is wider than the page.
    parts.append(
        f'<div class="scroll" tabindex="0" role="region" '
        f'aria-label="{escape(table["title"])}"><table class="numbers">'
    )
    parts.append(head(columns, text, filtered))
    for group, rows in groups_of(table["rows"]):
        parts.append("<tbody>")
        if group:
            parts.append(
                f'<tr class="group"><th colspan="{len(columns)}" scope="rowgroup">'
                f"<span>{escape(group)}</span></th></tr>"
            )
        best = [best_rows(rows, c) for c in columns]
        parts += [row_html(i, row, columns, text, best, places) for i, row in enumerate(rows)]
        parts.append("</tbody>")
    parts.append("</table></div>")
    if any(c["better"] for c in columns):
        parts.append('<p class="fine"><b class="best">Bold</b>: the best of its group.</p>')
    return "\n".join(parts + ["</section>"])


def row_html(
    i: int,
    row: dict[str, Any],
    columns: list[dict[str, Any]],
    text: list[bool],
    best: list[set[int]],
    places: Places,
) -> str:
    cells = []
    for k, column in enumerate(columns):
        value = f' data-value="{escape(plain(row["cells"][column["key"]]))}"'
        shown = escape(cell_text(row["cells"][column["key"]], column["digits"], column["decimals"]))
        if i in best[k]:
            shown = f'<b class="best">{shown}<span class="hidden"> (best)</span></b>'
        kind = " class=text" if text[k] else ""
        if k == 0:
            shown = picture_button(row["picture"], shown, places)
            cells.append(f'<th scope="row"{kind}{value}>{shown}</th>')
        elif row["diagram"] and k == len(columns) - 1:
            drawn = diagram_html(row["diagram"])
            cells.append(f'<td{kind}{value}><div class="drawn">{drawn}<p>{shown}</p></div></td>')
        else:
            cells.append(f"<td{kind}{value}>{shown}</td>")
    return "<tr>" + "".join(cells) + "</tr>"


def diagram_html(name: str) -> str:
    if name not in DIAGRAMS:
        raise ReportError(f"no diagram has the name '{name}'; add it to eval/report/diagrams")
    return diagram_svg(name)


def picture_button(picture: dict[str, str] | None, shown: str, places: Places) -> str:
    """The first cell of a row, which shows its picture when it has one."""
    if picture is None:
        return shown
    key = (picture["scene"], picture["view"], picture["image"])
    if key not in places:
        raise ReportError(f"no view has the picture {'/'.join(key)}; name one of its 'images'")
    viewer, image = places[key]
    return (
        f'<button type="button" class="picture" aria-expanded="false" data-view="{viewer}" '
        f'data-image="{image}" title="Show the picture">{shown}</button>'
    )
