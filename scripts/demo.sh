#!/usr/bin/env bash
# Turns a fresh clone into a picture: installs missing packages, builds the stages, and renders the
# U-shaped scene through the four stages. Settings may be added: scripts/demo.sh SPP=8
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_packages.sh --build
echo "Building the four stages into build/release"
cmake --preset release
cmake --build --preset release --target vpl-place vpl-eliminate vpl-estimate vpl-render

echo "Rendering scenes/u-shape"
make --no-print-directory -f pipelines/Makefile SCENE=scenes/u-shape/scene.toml OUT=out/u-shape \
  BIN=build/release/bin CANDIDATES=120k VPLS=3k PHOTONS=10M SPP=8 RENDER_FLAGS='--exposure 4.2' "$@"
out=out/u-shape
for setting; do [[ $setting == OUT=* ]] && out=${setting#OUT=}; done
echo "The picture: $(realpath -- "$out")/image.png"
