"""Makes the page: a checked report as one HTML file that needs nothing else."""

from __future__ import annotations

import base64
import hashlib
import json
from html import escape
from pathlib import Path
from typing import Any

import contributions
from hdr_image import HdrStore, read_png
from html_table import Places, number_text, table_html
from plot_figure import DARK, LIGHT, page_svg, slope_text
from report_json import ReportError

WEB = Path(__file__).resolve().parent / "web"
SCRIPTS = (
    "dom.js",
    "hdr.js",
    "colour.js",
    "errors.js",
    "flip.js",
    "stage.js",
    "panel.js",
    "viewer.js",
    "table.js",
    "explorer.js",
    "main.js",
)


def page_html(report: dict[str, Any]) -> str:
    store = HdrStore()
    views: list[dict[str, Any]] = []
    scenes = "".join(scene_html(scene, store, views) for scene in report["scenes"])
    places = picture_places(report["scenes"])
    script = (
        '"use strict";\n(() => {\n'
        + "".join((WEB / name).read_text(encoding="utf-8") for name in SCRIPTS)
        + "})();\n"
    )
    data = json.dumps(
        {"views": views, "exponents": [i.exponent for i in store.images]},
        ensure_ascii=False,
        separators=(",", ":"),
    )
    body = [
        header_html(report),
        scenes and f'<div class="scenes">{scenes}</div>',
        "".join(table_html(t, places) for t in report["tables"]),
        plots_html(report["plots"]),
        provenance_html(report["provenance"]),
        # In a script element, "</" would end it and "<!--" would begin a comment.
        f'<script type="application/json" id="views">{data.replace("<", chr(92) + "u003c")}'
        "</script>",
        "".join(
            f'<script type="text/plain" id="hdr-{i}">{image.data}</script>\n'
            for i, image in enumerate(store.images)
        ),
        f"<script>{script}</script>",
    ]
    return head_html(report["title"], script) + "\n".join(body) + "\n</body>\n</html>\n"


def picture_places(scenes: list[dict[str, Any]]) -> Places:
    """Viewer and place in its list, by the ids of scene, view and image."""
    shown = [(scene["id"], view) for scene in scenes for view in scene["views"]]
    return {
        (scene, view["id"], image["id"]): (index, k)
        for index, (scene, view) in enumerate(shown)
        for k, image in enumerate(view["images"])
    }


def head_html(title: str, script: str) -> str:
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    # The policy makes the browser refuse all use of the network.
    policy = (
        f"default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
        f"script-src 'sha256-{digest}'"
    )
    style = (WEB / "page.css").read_text(encoding="utf-8")
    style = style.replace("/*series-light*/", series_colours(LIGHT))
    style = style.replace("/*series-dark*/", series_colours(DARK))
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="color-scheme" content="light dark">\n'
        f'<link rel="icon" href="data:,">\n<title>{escape(title)}</title>\n'
        f"<style>\n{style}</style>\n</head>\n<body>\n"
    )


def series_colours(colours: tuple[str, ...]) -> str:
    return " ".join(f"--s{i}: {colour};" for i, colour in enumerate(colours))


def header_html(report: dict[str, Any]) -> str:
    links = [(f"scene-{s['id']}", s["title"]) for s in report["scenes"]]
    links += [(f"table-{t['id']}", t["title"]) for t in report["tables"]]
    links += [("plots", "Plots")] if report["plots"] else []
    links += [("provenance", "Provenance")] if report["provenance"] else []
    items = "".join(f'<li><a href="#{at}">{escape(text)}</a></li>' for at, text in links)
    lead = "".join(f"<p>{escape(p)}</p>" for p in report["lead"].split("\n\n") if p.strip())
    return (
        f'<header class="page"><h1>{escape(report["title"])}</h1><div class="lead">{lead}</div>'
        f'<nav aria-label="Contents"><ul>{items}</ul></nav></header>'
    )


def provenance_html(provenance: dict[str, Any]) -> str:
    if not provenance:
        return ""
    rows = []
    for key, value in provenance.items():
        text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
        rows.append(f"<div><dt>{escape(key)}</dt><dd>{escape(text)}</dd></div>")
    return (
        '<section class="block" id="provenance"><h2>Provenance</h2><dl class="provenance">'
        + "".join(rows)
        + "</dl></section>"
    )


def scene_html(scene: dict[str, Any], store: HdrStore, views: list[dict[str, Any]]) -> str:
    parts = [f'<section class="block" id="scene-{scene["id"]}"><h2>{escape(scene["title"])}</h2>']
    if scene["note"]:
        parts.append(f'<p class="note">{escape(scene["note"])}</p>')
    for view in scene["views"]:
        parts.append(view_html(scene, view, store, views))
    return "\n".join(parts + ["</section>"])


def view_html(
    scene: dict[str, Any], view: dict[str, Any], store: HdrStore, views: list[dict[str, Any]]
) -> str:
    index = len(views)
    images, size = pack_images(view, store)
    pictures, figures = [], []
    for k, picture in enumerate(view["pictures"]):
        width, height, data = read_png(picture["file"])
        at = f"picture-{index}-{k}"
        figures.append(figure_html(picture, at, width, height, data))
        if (
            width * size[1] == height * size[0]
        ):  # pictures of another shape appear below the viewer only
            pictures.append(
                {
                    "id": picture["id"],
                    "label": picture["label"],
                    "caption": picture["caption"],
                    "element": at,
                }
            )
    explorer, sizes = explorer_html(scene, view, index, size)
    views.append(
        {
            "title": f"{scene['title']}, {view['title']}",
            "contributions": sizes,
            "reference": view["reference"],
            "first": view["first"],
            "exposure": view["exposure"],
            "width": size[0],
            "height": size[1],
            "layers": view["layers"],
            "images": images,
            "pictures": pictures,
        }
    )
    note = f'<p class="note">{escape(view["note"])}</p>' if view["note"] else ""
    grid = f'<div class="figures">{"".join(figures)}</div>' if figures else ""
    return (
        f'<section class="view" id="view-{scene["id"]}-{view["id"]}">'
        f"<h3>{escape(view['title'])}</h3>{note}"
        f'<div class="viewer" data-view="{index}" role="group" '
        f'aria-label="{escape(scene["title"])}, {escape(view["title"])}: image comparison">'
        f"<noscript>The viewer needs JavaScript.</noscript></div>{explorer}{grid}</section>"
    )


def explorer_html(
    scene: dict[str, Any], view: dict[str, Any], index: int, size: tuple[int, int]
) -> tuple[str, dict[str, Any] | None]:
    """The place of the explorer of VPLs with its data, and their sizes; nothing without a list."""
    if not view["contributions"]:
        return "", None
    sizes, data = contributions.pack(view["contributions"])
    width, height = sizes["width"], sizes["height"]
    if abs(width * size[1] - height * size[0]) > size[0]:  # more than rounding of the height
        raise ReportError(
            f"{view['contributions']}: {width}x{height} pixels are not of the shape of the images' "
            f"{size[0]}x{size[1]}; make it for the same view"
        )
    at = f"contributions-{index}"
    label = escape(f"{scene['title']}, {view['title']}: which VPLs light what")
    html = (
        f'<h4>Which VPLs light what</h4><div class="explorer" data-view="{index}" role="group" '
        f'aria-label="{label}"></div><script type="text/plain" id="{at}">{data}</script>'
    )
    return html, {**sizes, "element": at}


def pack_images(
    view: dict[str, Any], store: HdrStore
) -> tuple[list[dict[str, Any]], tuple[int, int]]:
    """Data of each image for the viewer, and the size that all images share."""
    result: list[dict[str, Any]] = []
    size, first = (0, 0), None
    order = sorted(view["images"], key=lambda i: bool(i["id"] != view["reference"]))
    indices: dict[str, dict[str, int]] = {}
    for image in order:  # the reference comes first, as its size decides
        indices[image["id"]] = {}
        for layer, (path, channel) in image["files"].items():
            at = store.add(path, channel)
            found = (store.images[at].width, store.images[at].height)
            size, first = size if first else found, first or path
            if found != size:
                raise ReportError(
                    f"{path}: {found[0]}x{found[1]} pixels, but {first} has "
                    f"{size[0]}x{size[1]}; render both at one size"
                )
            indices[image["id"]][layer] = at
    for image in view["images"]:
        result.append(
            {
                "id": image["id"],
                "label": image["label"],
                "caption": image["caption"],
                "numbers": image["numbers"],
                "files": indices[image["id"]],
            }
        )
    return result, size


def figure_html(picture: dict[str, Any], at: str, width: int, height: int, data: str) -> str:
    caption = escape(picture["label"])
    if picture["caption"]:
        caption = f"<b>{caption}.</b> {escape(picture['caption'])}"
    return (
        f'<figure><img id="{at}" width="{width}" height="{height}" '
        f'alt="{escape(picture["label"])}" src="data:image/png;base64,{data}">'
        f"<figcaption>{caption}</figcaption></figure>"
    )


def plots_html(plots: list[dict[str, Any]]) -> str:
    if not plots:
        return ""
    parts = ['<section class="block" id="plots"><h2>Plots</h2>']
    for plot in plots:
        parts.append(
            f'<figure class="plot" id="plot-{plot["id"]}"><h3>{escape(plot["title"])}</h3>'
            f"{page_svg(plot, True)}{page_svg(plot, False)}"
        )
        caption = escape(plot["caption"])
        parts.append(f"<figcaption>{caption}</figcaption>{data_html(plot)}</figure>")
    return "\n".join(parts + ["</section>"])


def data_html(plot: dict[str, Any]) -> str:
    """Table of the values of a plot, for readers who cannot see it or want to copy them."""
    rows = []
    for s in plot["series"]:
        slope = "" if s["slope"] is None else f" <small>{slope_text(s['slope'])}</small>"
        rows.append(
            f'<tbody><tr class="group"><th colspan="3" scope="rowgroup">'
            f"<span>{escape(s['label'])}{slope}</span></th></tr>"
        )
        for i, (x, y) in enumerate(zip(s["x"], s["y"], strict=True)):
            error = number_text(s["error"][i], 3) if s["error"] else "–"
            rows.append(
                f"<tr><td>{number_text(x, 5)}</td><td>{number_text(y, 4)}</td><td>{error}</td></tr>"
            )
        rows.append("</tbody>")
    return (
        '<details><summary>The numbers</summary><div class="scroll" tabindex="0" '
        f'role="region" aria-label="Numbers of the plot {escape(plot["title"])}">'
        '<table class="numbers"><thead><tr>'
        f'<th scope="col">{escape(plot["x_label"])}</th>'
        f'<th scope="col">{escape(plot["y_label"])}</th><th scope="col">± error</th></tr>'
        f"</thead>{''.join(rows)}</table></div></details>"
    )
