#!/usr/bin/env python3
"""Makes tables and a picture from docs/rooms.csv, which rooms.py writes.

They are the tables of docs/lab/evaluation.md named rooms and guided, the picture rooms.svg and
the first sentences about it in docs/results.md, and the range in README.md.
"""

import csv
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

import results_page
import write_docs
from bnvpl_eval import output
from bnvpl_eval.output import plt

RESULTS = write_docs.DOCS / "rooms.csv"
PAGE = write_docs.DOCS / "lab/evaluation.md"
MEASURES = {"relmse": "relMSE", "rmse": "RMSE", "smape": "SMAPE", "flip": "FLIP"}
APART = 1.25  # ratio of two times that are not equal
HALF = 0.45  # share of indirect light that is about half of the image
OTHERS = {
    "path": "path tracer",
    "light": "light tracer",
    "guided": "guided by VPLs",
    "spread-path": "path tracer with fireflies redistributed",
    "cycles": "Cycles",
}
COLOURS = {
    "path": "#0b62a3",
    "light": "#c77700",
    "guided": "#3a7d34",
    "spread-path": "#7fb2dd",
    "cycles": "#8b2f8f",
}
KEY = ("room", "setting", "light", "beside", "path_length")


def read() -> list[dict[str, Any]]:
    return list(csv.DictReader(RESULTS.open(newline=""))) if RESULTS.is_file() else []


def add(rows: list[dict[str, Any]]) -> None:
    """Adds rows, which replace older ones with the same values in the columns KEY."""
    of = {tuple(str(row[key]) for key in KEY): row for row in (*read(), *rows)}
    output.write_csv(RESULTS, list(of.values()))


def at_equal_time(row: dict[str, Any]) -> bool:
    """Whether the other's run took about our time, or its time is not known."""
    its = row.get("its_cpu_s")
    return not its or APART > float(its) / float(row["cpu_s"]) > 1.0 / APART


def ratio(row: dict[str, Any], column: str) -> float:
    """Value of the other integrator over ours."""
    return float(row[f"its_{column}"]) / max(1e-9, float(row[column]))


def two(value: float) -> str:
    """Two significant digits, without an exponent for the usual range."""
    return f"{float(f'{value:.2g}'):g}"


def indirect_mean(rows: list[dict[str, Any]]) -> float:
    """Our indirect mean over those of the others, weighted by their inverse squared RMSE.

    Each ratio is of one run. Redistributing fireflies lowers the error of pixels, not of the mean.
    """
    used = [row for row in rows if not str(row["beside"]).startswith("spread-")]
    weights = [float(row["its_rmse"]) ** -2 for row in used]
    return sum(weights) / sum(
        w * float(row["its_mean"]) / float(row["mean"]) for w, row in zip(weights, used, strict=True)
    )


def table(rows: list[dict[str, Any]]) -> str:
    """Table of the full images at the default setting."""
    shown: dict[str, dict[str, dict[str, Any]]] = {}
    indirect: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        if row["setting"] != "default":
            continue
        if row["light"] == "full":
            shown.setdefault(row["room"], {})[row["beside"]] = row
        if row["light"] == "indirect":
            indirect.setdefault(row["room"], []).append(row)
    others = [other for other in OTHERS if any(other in of for of in shown.values())]
    lines = [
        "| room | indirect | CPU s | mean, ours, path tracer's | indirect mean, ours / others' | "
        "relMSE: "
        + ", ".join(OTHERS[other] for other in others)
        + " / ours | path tracer: RMSE, SMAPE, FLIP / ours |",
        "|---|---|---|---|---|---|---|",
    ]
    for room, of in shown.items():
        path = of["path"]
        lines.append(
            "| "
            + " | ".join(
                [
                    room,
                    f"{float(path['indirect_share']):.0%}",
                    path["cpu_s"],
                    f"{float(path['mean']):.3f}, {float(path['its_mean']):.3f}",
                    f"{indirect_mean(indirect[room]):.3f}",
                    ", ".join(
                        two(ratio(of[other], "relmse")) if other in of else "-" for other in others
                    ),
                    ", ".join(two(ratio(path, column)) for column in ("rmse", "smape", "flip")),
                ]
            )
            + " |"
        )
    made = sorted(
        {
            f"tools of {row['tools']}, {row['date']}, {row['width']} pixels wide, reference "
            f"{row['reference']}"
            for row in rows
        }
    )
    return "\n".join([*lines, "", *(f"<!-- {line} -->" for line in made)])


def guided_table(rows: list[dict[str, Any]]) -> str:
    """Table of the path tracer's errors over those of guided paths, in the default setting's time.

    It is empty where their rows come from two builds.
    """
    of: dict[str, dict[str, dict[str, Any]]] = {}
    for row in rows:
        if (row["setting"], row["light"]) == ("default", "full"):
            of.setdefault(row["room"], {})[row["beside"]] = row
    both = [(room, by["path"], by["guided"]) for room, by in of.items() if "guided" in by]
    if apart := [room for room, path, guided in both if guided["tools"] != path["tools"]]:
        print(
            f"rooms: {PAGE.name} keeps its table of guided paths, as theirs and the path "
            f"tracer's are of two builds in {', '.join(apart)}; "
            "cure: rooms.py --also guided",
            file=sys.stderr,
        )
        return ""

    def times(path: dict[str, Any], guided: dict[str, Any], column: str) -> float:
        return float(path[f"its_{column}"]) / max(1e-9, float(guided[f"its_{column}"]))

    lines = [
        "| view | CPU s | spp, guided, path tracer's | relMSE | RMSE | SMAPE | FLIP | means, "
        "guided, path tracer's |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for room, path, guided in sorted(both, key=lambda row: -times(row[1], row[2], "relmse")):
        errors = [
            two(times(path, guided, column)) for column in ("relmse", "rmse", "smape", "flip")
        ]
        lines.append(
            "| "
            + " | ".join(
                [
                    room,
                    guided["cpu_s"],
                    f"{guided['its_spp']}, {path['its_spp']}",
                    *errors,
                    f"{float(guided['its_mean']):.3f}, {float(path['its_mean']):.3f}",
                ]
            )
            + " |"
        )
    return "\n".join(lines)


def spelled(value: float) -> str:
    """Two significant digits, with commas between thousands."""
    return f"{float(f'{value:.2g}'):,g}" if value < 1e6 else two(value)


def span(values: list[float]) -> str:
    return f"{spelled(min(values))} to {spelled(max(values))}"


def exceptions(found: list[tuple[str, str, float]]) -> str:
    """Where (room, measure, ratio) is behind; nothing where it is nowhere."""
    behind = [f"{name} of {room} ({two(r)})" for room, name, r in found if r < 1.0]
    return f" but in {', '.join(behind)}" if behind else ""


def of_full_images(
    rows: list[dict[str, Any]], setting: str, beside: str
) -> list[dict[str, Any]]:
    wanted = (setting, "full", beside)
    return [row for row in rows if (row["setting"], row["light"], row["beside"]) == wanted]


def facts(rows: list[dict[str, Any]]) -> str:
    """What the ratios of the full images say."""
    default, draft = (of_full_images(rows, setting, "path") for setting in ("default", "draft"))

    def all_ratios(found: list[dict[str, Any]]) -> list[tuple[str, str, float]]:
        return [
            (row["room"], name, ratio(row, column))
            for row in found
            for column, name in MEASURES.items()
        ]

    paths = {row["room"]: row for row in default}
    guided = [
        (row["room"], name, float(paths[row["room"]][f"its_{m}"]) / float(row[f"its_{m}"]))
        for row in of_full_images(rows, "default", "guided")
        for m, name in MEASURES.items()
    ]
    half, less = (
        [ratio(r, "relmse") for r in default if (float(r["indirect_share"]) >= HALF) == much]
        for much in (True, False)
    )
    lines = (
        "- Where indirect light is about half of the image or more, the path tracer has "
        f"{span(half)} times the relMSE, else {span(less)} times.",
        f"- Ours is ahead of the path tracer in relMSE, RMSE, SMAPE and FLIP in all views"
        f"{exceptions(all_ratios(default))}. So is the preset `draft`"
        f"{exceptions(all_ratios(draft))}, by {two(min(ratio(r, 'relmse') for r in draft))} times "
        f"in relMSE and {two(min(ratio(r, 'flip') for r in draft))} in FLIP at least.",
        f"- Guided paths are ahead of the path tracer{exceptions(guided)}.",
    )
    return "\n".join(
        textwrap.fill(line, 118, subsequent_indent="  ", break_on_hyphens=False) for line in lines
    )


def put_range(page: Path, rows: list[dict[str, Any]]) -> None:
    """The range of the path tracer's relMSE over ours, within a sentence of the page."""
    found = [ratio(row, "relmse") for row in of_full_images(rows, "default", "path")]
    text = f"<!-- range -->{span(found)} times our relMSE in {len(found)} views<!-- end -->"
    old = page.read_text()
    output.write_page(page, re.sub(r"<!-- range -->.*?<!-- end -->", text, old, flags=re.S))


def put(page: Path, name: str, table: str) -> None:
    """Replaces the text between the page's comments of that name."""
    text = f"<!-- {name} -->\n{table}\n<!-- end of {name} -->"
    output.write_page(
        page,
        re.sub(
            f"<!-- {name} -->.*?<!-- end of {name} -->",
            lambda _: text,
            page.read_text(),
            flags=re.S,
        ),
    )


def plot(rows: list[dict[str, Any]], path: Path) -> None:
    """Plots the others' relMSE and FLIP over ours: filled at default, hollow at draft."""
    rooms = list(dict.fromkeys(row["room"] for row in rows))
    figure, axes = plt.subplots(
        1, 2, figsize=(11, 0.36 * len(rooms) + 1.6), sharey=True, layout="constrained"
    )
    for ax, column, title in zip(axes, ("relmse", "flip"), ("relMSE", "FLIP"), strict=True):
        for row in rows:
            if row["light"] != "full" or row["beside"] not in OTHERS:
                continue
            colour, filled = COLOURS[row["beside"]], row["setting"] == "default"
            ax.plot(
                ratio(row, column),
                rooms.index(row["room"]),
                "o",
                color=colour,
                markersize=7,
                markerfacecolor=colour if filled else "none",
                label=OTHERS[row["beside"]] if filled else None,
            )
        ax.axvline(1, color="#444444", linewidth=1)
        ax.set_xscale("log")
        ax.grid(axis="x", alpha=0.3)
        ax.set_xlabel(f"{title} at equal CPU time, theirs / ours")
    axes[0].set_yticks(range(len(rooms)), rooms)
    axes[0].invert_yaxis()
    marks = dict(zip(*reversed(axes[0].get_legend_handles_labels()), strict=True))
    figure.suptitle(" ")  # room for the legend
    figure.legend(marks.values(), marks.keys(), loc="upper center", ncols=len(marks), frameon=False)
    output.save(
        path,
        output.output_guard.SVG,
        lambda partial: figure.savefig(partial, metadata={"Date": None}),
    )
    plt.close(figure)


def write() -> None:
    rows = [row for row in read() if row["path_length"] == "0" and at_equal_time(row)]
    put(PAGE, "rooms", table(rows))
    if guided := guided_table(rows):
        put(PAGE, "guided", guided)
    results_page.write()
    put(write_docs.DOCS / "results.md", "facts", facts(rows))
    put_range(write_docs.DOCS.parent / "README.md", rows)
    plot(rows, write_docs.DOCS / "images/rooms.svg")


if __name__ == "__main__":
    write()
