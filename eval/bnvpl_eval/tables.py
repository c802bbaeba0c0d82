"""Makes tables of the report. Several parts share columns; rows are reduced to their columns."""

from typing import Any

SHARED: dict[str, dict[str, Any]] = {
    "label": {"label": "VPLs", "better": None},
    "seeds": {"label": "seeds", "better": None},
    "mean_ratio": {"label": "mean ratio", "better": "one"},
    "rmse_over_mean": {"label": "RMSE / mean", "better": "low"},
    "bias_over_mean": {"label": "bias / mean", "better": "low"},
    "std_over_mean": {"label": "noise / mean", "better": "low"},
    "relmse": {"label": "relMSE", "better": "low"},
    "smape": {"label": "SMAPE", "better": "low"},
    "flip": {"label": "FLIP", "better": "low"},
    "hdr_flip": {"label": "HDR-FLIP", "better": "low"},
    "cpu_s": {"label": "time", "unit": "CPU s", "better": "low"},
}


def column(key: str, label: str = "", unit: str = "", better: str | None = None) -> dict[str, Any]:
    """A column that parts share, or a new one."""
    made = {"key": key, **SHARED.get(key, {"label": label, "better": better})}
    if label:
        made["label"] = label
    if unit:
        made["unit"] = unit
    return made


# Columns with the standard errors, which are shown behind the values.
ERRORS = {
    "mean_ratio": "mean_ratio_error",
    "rmse_over_mean": "rmse_error",
    "relmse": "relmse_error",
    "smape": "smape_error",
    "flip": "flip_error",
    "hdr_flip": "hdr_flip_error",
}


def cell(row: dict[str, Any], key: str) -> Any:
    value, error = row.get(key), row.get(ERRORS.get(key, ""))
    return value if value is None or error is None else {"value": value, "error": error}


def table(
    name: str, title: str, note: str, columns: list[dict[str, Any]], rows: list[dict[str, Any]]
) -> dict[str, Any]:
    """A table. Rows have a 'group', and may have more entries than are shown."""
    keys = ["group", *(c["key"] for c in columns)]
    return {
        "id": name,
        "title": title,
        "note": note,
        "columns": columns,
        "rows": [{key: cell(row, key) for key in keys} for row in rows],
    }
