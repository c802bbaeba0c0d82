#!/usr/bin/env python3
"""Renders the pictures of docs/guide.md: each artefact beside its cure, from the tools themselves.

    docs/make_guide_pictures.py [--bin build/release/bin] [NAME ...]    # some minutes on two cores
"""
import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy
import OpenImageIO

ROOT = Path(__file__).resolve().parents[1]


class Case:
    """A scene and a view; for each of two pictures the options of place, eliminate, estimate and render."""

    def __init__(self, scene, size, exposure, bad, good):
        self.scene, self.size, self.exposure, self.pictures = scene, size, exposure, (bad, good)


CASES = {
    'blotches': Case('u-shape/scene.toml', '480x360', 5,
                     ('-n 15k', '-n 1500', '--photons 50k', '--spp 16'),
                     ('-n 60k', '-n 3000', '--photons 10M', '--spp 16')),
    'arcs': Case('veach-door/scene.toml', '640x360', 1.5,
                 ('-n 20k', '-n 500', '--photons 4M', '--gather lightcuts --error 0.1 --spp 8 --only indirect'),
                 ('-n 240k', '-n 12k', '--photons 10M', '--spp 16 --only indirect')),
    'dark-corners': Case('cornell/scene.toml', '480x480', 0,
                         ('-n 12k', '-n 300', '--photons 2M', '--compensate none --spp 32 --only indirect'),
                         ('-n 12k', '-n 300', '--photons 2M', '--spp 32 --only indirect')),
    'leaks': Case('u-shape/scene.toml', '480x360', 3,
                  ('-n 60k', '-n 3000', '--photons 2M --method even --recentre off', '--compensate none --spp 16'),
                  ('-n 60k', '-n 3000', '--photons 2M', '--spp 16')),
    'specks': Case('veach-door/table.toml', '640x360', 2,
                   ('-n 120k', '-n 3000', '--photons 4M', '--spp 4'),
                   ('-n 120k', '-n 3000', '--photons 4M', '--spp 48 --near-field-rays 4 --error 0.15')),
    'direct-noise': Case('cornell/scene.toml', '480x480', 0,
                         ('-n 12k', '-n 300', '--photons 200k', '--spp 1 --near-field-rays 1 --only direct'),
                         ('-n 12k', '-n 300', '--photons 200k', '--spp 64 --near-field-rays 1 --only direct')),
}


def render(tools, case, options, folder):
    def run(tool, *words):
        subprocess.run([tools / tool, *map(str, words), '--quiet'], cwd=folder, check=True)

    scene = ROOT / 'scenes' / case.scene
    place, eliminate, estimate, image = (o.split() for o in options)
    run('vpl-place', scene, '-o', 'c.vpl', *place)
    run('vpl-eliminate', 'c.vpl', '-o', 'v.vpl', *eliminate)
    run('vpl-estimate', scene, 'v.vpl', '-o', 'l.vpl', *estimate)
    run('vpl-render', scene, 'l.vpl', '-o', 'i.exr', '--png', 'i.png', '--size', case.size,
        '--exposure', case.exposure, *image)
    return OpenImageIO.ImageBuf(str(folder / 'i.png')).get_pixels(OpenImageIO.UINT8)[:, :, :3]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('names', nargs='*', help=f'some of {", ".join(CASES)}')
    parser.add_argument('--bin', default=ROOT / 'build/release/bin', type=Path, help='folder of the executables')
    options = parser.parse_args()
    for name in options.names or CASES:
        with tempfile.TemporaryDirectory(prefix='bnvpl-guide.') as folder:
            pair = [render(options.bin.resolve(), CASES[name], o, Path(folder)) for o in CASES[name].pictures]
        gap = numpy.full((pair[0].shape[0], 8, 3), 255, numpy.uint8)
        both = numpy.ascontiguousarray(numpy.hstack([pair[0], gap, pair[1]]))
        spec = OpenImageIO.ImageSpec(both.shape[1], both.shape[0], 3, OpenImageIO.UINT8)
        out = OpenImageIO.ImageBuf(spec)
        out.set_pixels(OpenImageIO.ROI(), both)
        out.write(str(ROOT / 'docs/images' / f'guide-{name}.png'))
        print(f'docs/images/guide-{name}.png', flush=True)


if __name__ == '__main__':
    main()
