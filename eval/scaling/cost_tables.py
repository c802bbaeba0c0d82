"""Prints cost_model.json as Markdown."""

import statistics
from typing import Any

Json = dict[str, Any]
FIGURES = {"cpu_s": "CPU s", "memory_MiB": "MiB", "file_bytes": "bytes"}


def rates(model: Json) -> list[str]:
    rows = ["| stage | CPU seconds | memory, MiB | bytes of the file |", "|---|---|---|---|"]
    for stage, figures in model["rates"].items():
        cells = []
        for figure in FIGURES:
            terms = figures.get(figure, {})
            cells.append(
                "<br>".join(
                    f"{rate:.3g}" + ("" if name == "start" else f" x {name}")
                    for name, rate in terms.items()
                )
            )
        rows.append(f"| {stage} | " + " | ".join(cells) + " |")
    return rows


def short(n: float) -> str:
    for size, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if n >= size:
            return f"{n / size:.3g}{letter}"
    return f"{n:g}"


def counts(check: Json) -> str:
    given = check["counts"]
    words = [
        f"{short(given[key])} {name}"
        for key, name in (
            ("candidates", "candidates"),
            ("vpls", "VPLs"),
            ("photons", "photons"),
            ("pixels", "pixels"),
            ("spp", "spp"),
        )
        if key in given
    ]
    if given.get("shards", 1) > 1:
        words.append(
            f"{given['shards']} shards"
            if check["stage"].startswith("merge")
            else f"one of {given['shards']} shards"
        )
    return ", ".join(words)


def error(measured: float, predicted: float) -> float:
    return 100 * (predicted / measured - 1)


def summary(model: Json) -> list[str]:
    def line(what: str, errors: list[float]) -> str:
        median = statistics.median([abs(e) for e in errors])
        return (
            f"- {what}: {sum(abs(e) <= 20 for e in errors)} of {len(errors)} within 20 %, median "
            f"{median:.0f} %, most {max(errors, key=abs):+.0f} %."
        )

    own = [c for c in model["checks"] if "scaled_cpu_s" not in c]
    others = [c for c in model["checks"] if "scaled_cpu_s" in c]
    return [
        line("CPU seconds, the fitted room", [error(*c["figures"]["cpu_s"]) for c in own]),
        line(
            "CPU seconds, other scenes, as if they were that room",
            [error(*c["figures"]["cpu_s"]) for c in others],
        ),
        line(
            "CPU seconds, other scenes, scaled",
            [error(c["figures"]["cpu_s"][0], c["scaled_cpu_s"]) for c in others],
        ),
        line("Memory", [error(*c["figures"]["memory_MiB"]) for c in model["checks"]]),
        line(
            "Bytes of files",
            [
                error(*c["figures"]["file_bytes"])
                for c in model["checks"]
                if "file_bytes" in c["figures"]
            ],
        ),
    ]


def checks(model: Json) -> list[str]:
    rows = [
        *summary(model),
        "",
        "| scene, triangles | stage | counts | CPU s: took | predicted | error | scaled, error | "
        "MiB: took | predicted | error |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for check in model["checks"]:
        took, said = check["figures"]["cpu_s"]
        mib = check["figures"]["memory_MiB"]
        scaled = check.get("scaled_cpu_s")
        rows.append(
            f"| {check['scene']}, {short(check['triangles'])} | {check['stage']} | "
            f"{counts(check)} | {took:.2f} | {said:.2f} | "
            f"{error(took, said):+.0f} % | "
            + (f"{scaled:.2f}, {error(took, scaled):+.0f} %" if scaled else "")
            + f" | {mib[0]:.0f} | {mib[1]:.0f} | {error(*mib):+.0f} % |"
        )
    return rows


def tables(model: Json) -> str:
    return "\n".join([*rates(model), "", *checks(model)]) + "\n"
