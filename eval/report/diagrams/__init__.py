"""The diagrams of vpl-render's methods: what each decides, on one small drawing.

Each is drawn after the theory.md of its method.
"""

from __future__ import annotations

from collections.abc import Callable

from . import cells, cuts, matrices, near, pairs, points
from .shapes import Drawing

# Title and function, by the name of the gather, compensation or kind of light.
DIAGRAMS: dict[str, tuple[str, Callable[[Drawing], None]]] = {
    "adaptive-tree": (
        "Clusters of much variance are split; a random descent draws a VPL of each of the others.",
        cuts.adaptive_tree,
    ),
    "all": (
        "A receiver sends a shadow ray to every VPL.",
        points.all_vpls,
    ),
    "grid-hierarchy": (
        "Near VPLs light a receiver themselves, farther ones through the lights of ever "
        "coarser grids.",
        cells.grid_hierarchy,
    ),
    "illumination-cut": (
        "Pairs of a group of receivers and a cluster of VPLs, for the whole film; a group "
        "shares visibility where its rays agree.",
        pairs.illumination_cut,
    ),
    "interleaved": (
        "Each pixel of a 3x3 pattern gathers every ninth VPL; a filter averages 3x3 pixels.",
        points.interleaved,
    ),
    "lie": (
        "A cell knows the VPLs that it sees, does not see, or sees in part.",
        cells.lie,
    ),
    "lightcuts": (
        "A cut of the light tree, with a ray to one representative of each cluster.",
        cuts.lightcuts,
    ),
    "lightslice": (
        "Slices of like receivers, each with its own clusters of columns.",
        matrices.lightslice,
    ),
    "matrix-completion": (
        "Visibility of samples and VPLs: few columns are traced in full, the others are "
        "completed.",
        matrices.matrix_completion,
    ),
    "mrcs": (
        "Sampled rows of the matrix cluster its columns; one column of each is computed.",
        matrices.mrcs,
    ),
    "multidimensional": (
        "Pairs of nodes of two trees, of a pixel's samples and of VPLs; each pair is one "
        "term.",
        pairs.multidimensional,
    ),
    "paquette": (
        "A node of an octree stands for its VPLs, with a ray to one, where the bound allows; "
        "else it is opened.",
        cells.paquette,
    ),
    "shirley": (
        "A cell knows its bright VPLs and tests them all, and a few of the dim ones.",
        cells.shirley,
    ),
    "stochastic": (
        "A cut of fixed size; a random descent draws a VPL of each cluster, which gets a ray.",
        cuts.stochastic,
    ),
    "tilecuts": (
        "One cut for all receivers of a tile; each takes a random VPL of each cluster.",
        cuts.tilecuts,
    ),
    "ward": (
        "Sorted VPLs: rays to the brightest, an expected visibility for the others.",
        points.ward,
    ),
    "kollig-keller": (
        "Rays go on from vertex to vertex; bounded VPLs and lights light each.",
        near.kollig_keller,
    ),
    "local": (
        "Ends of the rays of a block of receivers light the whole block, without shadow rays.",
        near.local,
    ),
    "near-field": (
        "Rays from a receiver add the light that the bound takes from VPLs at their ends.",
        near.near_field,
    ),
    "none": (
        "Within a distance the light of a VPL is bounded, and nothing is added.",
        near.none,
    ),
    "point": (
        "The attenuation of a point with a bound, beside that without.",
        near.point,
    ),
    "disk": (
        "The attenuation of a disk beside that of a bounded point.",
        near.disk,
    ),
    "yuksel": (
        "An attenuation without a bend beside that of a bounded point.",
        near.yuksel,
    ),
    "spherical": (
        "A receiver takes the mean over the cone of a sphere around the VPL; one ray runs to its "
        "centre.",
        near.spherical,
    ),
}


def diagram_svg(name: str) -> str:
    title, draw = DIAGRAMS[name]
    drawing = Drawing()
    draw(drawing)
    return drawing.svg(f"{name}: {title}")
