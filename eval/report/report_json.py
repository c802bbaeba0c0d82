"""Reads and checks report.json. The result is complete, so that the writers need no checks.

Every problem is a ReportError with one line: file, place inside it, problem, cure. README.md
describes the format.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*\Z")
BETTER = ("low", "high", "one", None)


class ReportError(Exception):
    """An error of the input; the message is one line."""


class Node:
    """A JSON value with its place in the file, which messages name."""

    def __init__(self, value: Any, source: Path, place: str = "") -> None:
        self.value, self.source, self.place = value, source, place

    def fail(self, problem: str, cure: str) -> ReportError:
        return ReportError(f"{self.source}: {self.place or 'top level'}: {problem}; {cure}")

    def child(self, key: str) -> Node:
        return Node(self.value[key], self.source, f"{self.place}.{key}" if self.place else key)

    def typed(self, kind: type | tuple[type, ...], name: str) -> Any:
        if not isinstance(self.value, kind) or (isinstance(self.value, bool) and kind is not bool):
            raise self.fail(f"expected {name}, found {shown(self.value)}", "correct the value")
        return self.value

    def get(self, key: str, kind: type | tuple[type, ...], name: str, default: Any = None) -> Any:
        """An optional member. null counts as absent."""
        if self.value.get(key) is None:
            return default
        return self.child(key).typed(kind, name)

    def text(self, key: str, default: str | None = None) -> str:
        if key not in self.value:
            if default is None:
                raise self.fail(f"'{key}' is missing", "add it, a text")
            return default
        result: str = self.child(key).typed(str, "a text")
        return result

    def items(self, key: str, required: bool = False) -> list[Node]:
        if key not in self.value:
            if required:
                raise self.fail(f"'{key}' is missing", "add it, a list")
            return []
        node = self.child(key)
        node.typed(list, "a list")
        return [Node(v, self.source, f"{node.place}[{i}]") for i, v in enumerate(node.value)]

    def objects(self, key: str, required: bool = False) -> list[Node]:
        nodes = self.items(key, required)
        for node in nodes:
            node.typed(dict, "an object {...}")
        return nodes


def shown(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else text[:37] + "..."


def load(path: Path) -> dict[str, Any]:
    """The checked report. File names are Paths; absent optional members have their defaults."""
    try:
        data = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as e:
        raise ReportError(f"{path}: byte {e.start}: not UTF-8; save it as UTF-8") from e
    except OSError as e:
        raise ReportError(f"{path}: {e.strerror}; check the name") from e
    try:
        value = json.loads(data, parse_constant=refuse_constant)
    except json.JSONDecodeError as e:
        raise ReportError(
            f"{path}: line {e.lineno}, column {e.colno}: {e.msg}; correct it, or "
            "rerun the evaluation that writes it"
        ) from e
    except ValueError as e:
        raise ReportError(f"{path}: {e}") from e
    root = Node(value, path)
    root.typed(dict, "an object {...}")
    report = {
        "title": root.text("title"),
        "lead": root.text("lead", ""),
        "provenance": root.get("provenance", dict, "an object {...}", {}),
        "tables": [table(n) for n in root.objects("tables")],
        "scenes": [scene(n) for n in root.objects("scenes")],
        "plots": [plot(n) for n in root.objects("plots")],
    }
    for key in ("tables", "scenes", "plots"):
        unique(root.objects(key))
    return report


def refuse_constant(name: str) -> float:
    raise ValueError(f"contains {name}, which is no JSON; write null for a value that is missing")


def identity(node: Node) -> str:
    text = node.text("id")
    if not ID.match(text):
        raise node.child("id").fail(f"'{text}' is no id", "use letters, digits and . _ -")
    return text


def unique(nodes: list[Node]) -> None:
    seen: set[str] = set()
    for node in nodes:
        if node.value["id"] in seen:
            raise node.fail(f"id '{node.value['id']}' is used twice", "give each its own")
        seen.add(node.value["id"])


def table(node: Node) -> dict[str, Any]:
    columns = []
    for c in node.objects("columns", required=True):
        better = c.value.get("better")
        if better not in BETTER:
            raise c.child("better").fail(
                f"{shown(better)} is unknown", 'use "low", "high", "one" or null'
            )
        columns.append(
            {
                "key": c.text("key"),
                "label": c.text("label"),
                "unit": c.get("unit", str, "a text", ""),
                "better": better,
                "digits": c.get("digits", int, "a number of digits", 3),
                "decimals": c.get("decimals", int, "a number of decimals"),
            }
        )
    if not columns:
        raise node.child("columns").fail("no columns", "list at least one")
    rows = []
    for r in node.objects("rows", required=True):
        cells = {c["key"]: cell(r, c["key"]) for c in columns}
        rows.append(
            {
                "group": r.get("group", str, "a text", ""),
                "cells": cells,
                "judged": not r.get("unjudged", bool, "true or false", False),
                "picture": picture_of(r),
                "diagram": r.get("diagram", str, "the name of a diagram"),
            }
        )
    keys = [c["key"] for c in columns]
    filters = [str(n.typed(str, "a column's key")) for n in node.items("filters")]
    if unknown := [key for key in filters if key not in keys]:
        raise node.child("filters").fail(
            f"no column has the key '{unknown[0]}'", "name keys of 'columns'"
        )
    if not filters and any(row["picture"] for row in rows):
        raise node.fail("rows have pictures, but no column filters", "name columns in 'filters'")
    return {
        "id": identity(node),
        "title": node.text("title"),
        "note": node.text("note", ""),
        "columns": columns,
        "rows": rows,
        "filters": filters,
    }


def picture_of(row: Node) -> dict[str, str] | None:
    """The image that a row is about: ids of scene, view and image."""
    if row.value.get("picture") is None:
        return None
    inner = row.child("picture")
    inner.typed(dict, "an object {...}")
    return {key: inner.text(key) for key in ("scene", "view", "image")}


def cell(row: Node, key: str) -> Any:
    """Value of a cell: a text, a number, None, or (value, error)."""
    value = row.value.get(key)
    if isinstance(value, dict):
        inner = row.child(key)
        return number(inner, "value"), number(inner, "error")
    if value is not None and (isinstance(value, bool) or not isinstance(value, (str, int, float))):
        raise row.child(key).fail(
            f"{shown(value)} is neither text nor number",
            'use those, null, or {"value": v, "error": e}',
        )
    return value


def number(node: Node, key: str) -> float:
    if key not in node.value:
        raise node.fail(f"'{key}' is missing", "add it, a number")
    return float(node.child(key).typed((int, float), "a number"))


def scene(node: Node) -> dict[str, Any]:
    views = node.objects("views", required=True)
    unique_id = identity(node)
    result = {
        "id": unique_id,
        "title": node.text("title"),
        "note": node.text("note", ""),
        "views": [view(v) for v in views],
    }
    unique(views)
    return result


def view(node: Node) -> dict[str, Any]:
    layers = [
        {"id": identity(n), "title": n.text("title")} for n in node.objects("layers", required=True)
    ]
    names = [layer["id"] for layer in layers]
    images = [image(n, names) for n in node.objects("images", required=True)]
    unique(node.objects("layers"))
    unique(node.objects("images"))
    pictures = [
        {
            "id": identity(n),
            "label": n.text("label"),
            "caption": n.text("caption", ""),
            "file": node.source.parent / n.text("file"),
        }
        for n in node.objects("pictures")
    ]
    unique(node.objects("pictures"))
    if not images:
        raise node.child("images").fail("no images", "list at least one")
    reference = node.get("reference", str, "the id of an image")
    if reference is not None and reference not in [i["id"] for i in images]:
        raise node.child("reference").fail(
            f"no image has the id '{reference}'", "name one of 'images', or null"
        )
    first = node.get("first", str, "the id of an image")
    if first is not None and first not in [i["id"] for i in images]:
        raise node.child("first").fail(
            f"no image has the id '{first}'", "name one of 'images', or leave it out"
        )
    exposure = node.get("exposure", (int, float), "a number of stops (EV)")
    contributions = node.get("contributions", str, "the name of a file")
    return {
        "id": identity(node),
        "title": node.text("title"),
        "note": node.text("note", ""),
        "reference": reference,
        "first": first,
        "exposure": exposure,
        "contributions": contributions and node.source.parent / contributions,
        "layers": layers,
        "images": images,
        "pictures": pictures,
    }


def image(node: Node, layers: list[str]) -> dict[str, Any]:
    files = node.child("files") if "files" in node.value else None
    if files is None or not files.typed(dict, "an object {...}"):
        raise node.fail("'files' is missing or empty", "name an EXR for at least one layer")
    found = {}
    for layer in files.value:
        if layer not in layers:
            raise files.child(layer).fail(
                f"no layer has the id '{layer}'", "name one of the view's 'layers'"
            )
        entry = files.child(layer)
        if isinstance(entry.value, dict):
            found[layer] = (node.source.parent / entry.text("file"), entry.text("layer", ""))
        else:
            found[layer] = (node.source.parent / entry.typed(str, "a file name"), "")
    return {
        "id": identity(node),
        "label": node.text("label"),
        "caption": node.text("caption", ""),
        "numbers": node.text("numbers", ""),
        "files": found,
    }


def plot(node: Node) -> dict[str, Any]:
    log = {axis: node.get(f"{axis}_log", bool, "true or false", False) for axis in "xy"}
    series = [line(n, log) for n in node.objects("series", required=True)]
    if not series:
        raise node.child("series").fail("no series", "list at least one")
    return {
        "id": identity(node),
        "title": node.text("title"),
        "caption": node.text("caption", ""),
        "x_label": node.text("x_label"),
        "y_label": node.text("y_label"),
        "x_log": log["x"],
        "y_log": log["y"],
        "series": series,
    }


def line(node: Node, log: dict[str, bool]) -> dict[str, Any]:
    data: dict[str, list[float]] = {}
    for axis in ("x", "y", "error"):
        if axis == "error" and node.value.get("error") is None:
            data["error"] = []
            continue
        entries = node.items(axis, required=True)
        data[axis] = [float(n.typed((int, float), "a number")) for n in entries]
        for n in entries:
            if not math.isfinite(n.value):
                raise n.fail("not a finite number", "leave the point out")
            if axis != "error" and log[axis] and n.value <= 0:
                raise n.fail(
                    f"{shown(n.value)} has no place on a logarithmic axis",
                    f'leave the point out, or set "{axis}_log": false',
                )
            if axis == "error" and n.value < 0:
                raise n.fail("a negative error", "write half the height of the bar")
    sizes = {len(data["x"]), len(data["y"]), len(data["error"] or data["x"])}
    if len(sizes) != 1 or not data["x"]:
        counts = ", ".join(f"{len(v)} of {k}" for k, v in data.items() if v or k != "error")
        raise node.fail(f"{counts}: lists of unequal length, or empty", "give each x its y")
    return {
        "label": node.text("label"),
        **data,
        "slope": node.get("slope", (int, float), "a number"),
        "dash": node.get("dash", bool, "true or false", False),
    }
