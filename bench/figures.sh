#!/usr/bin/env bash
# The figures of docs/results.md: each scene through the four stages at the thesis' counts, beside light
# placement and random placement, judged against the path tracer on a small film.
#   bench/figures.sh OUT [scene ...]     scenes: u-shape veach-door sponza veach-ajar
# REFERENCE_SPP and SPP set the samples of the two reference halves and of the VPL renders; UNIFORM= leaves
# out the uniform density.
# Sponza and Veach-ajar need SPONZA_DIR and VEACH_AJAR_DIR in the environment.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
bin=build/release/bin
out=$1
shift
mkdir -p "$out"

# A copy of a scene.toml with another film, beside the original so that file names stay valid.
film() { # scene.toml width height
  local copy="${1%.toml}.film-$2x$3.toml" # ignored by git
  sed -E "s/^width = .*/width = $2/; s/^height = .*/height = $3/" "$1" > "$copy"
  echo "$copy"
}

figure() { # name vpls width height reference-spp
  local name=$1 vpls=$2 width=$3 height=$4 spp=$5
  local scene=scenes/$name/scene.toml
  local small picture
  small=$(film "$scene" "$width" "$height")
  picture=$(film "$scene" $((width * 5)) $((height * 5)))
  trap 'rm -f scenes/*/*.film-*.toml' EXIT
  local o=$out/$name
  for seed in 1 2; do # two halves: their difference is the reference's own noise
    [ -f "$o.ref$seed.exr" ] || $bin/vpl-render "$small" -o "$o.ref$seed.exr" --integrator path \
      --only indirect --spp "$spp" --seed "$seed" --quiet
  done
  $bin/vpl-place "$scene" -o "$o.candidates.vpl" -n 120k --quiet
  $bin/vpl-eliminate "$o.candidates.vpl" -o "$o.blue.vpl" -n "$vpls" --quiet
  $bin/vpl-eliminate "$o.candidates.vpl" -o "$o.uniform.vpl" -n "$vpls" --density uniform --quiet
  $bin/vpl-eliminate "$o.candidates.vpl" -o "$o.random.vpl" -n "$vpls" --method random --quiet
  for set in blue ${UNIFORM-uniform} random; do
    $bin/vpl-estimate "$scene" "$o.$set.vpl" -o "$o.$set.lit.vpl" --photons 10M --stats "$o.$set.json" --quiet
  done
  $bin/vpl-place "$scene" -o "$o.light.lit.vpl" --method light -n "$vpls" --quiet
  echo "$name: half difference of the reference"
  $bin/vpl-inspect compare "$o.ref1.exr" "$o.ref2.exr"
  for set in blue ${UNIFORM-uniform} random light; do
    $bin/vpl-render "$small" "$o.$set.lit.vpl" -o "$o.$set.exr" --only indirect --spp "${SPP:-32}" --quiet
    echo "$name: $set"
    $bin/vpl-inspect compare "$o.$set.exr" "$o.ref1.exr" --second-half "$o.ref2.exr"
  done
  $bin/vpl-render "$picture" "$o.blue.lit.vpl" -o "$o.picture.exr" --spp 8 --png "$o.png" --layers all
}

for name in "${@:-u-shape}"; do
  case $name in
    u-shape) figure u-shape 3k 64 48 "${REFERENCE_SPP:-65536}" ;;
    veach-door) figure veach-door 6k 64 36 "${REFERENCE_SPP:-65536}" ;;
    sponza) figure sponza 3k 64 36 "${REFERENCE_SPP:-8192}" ;;
    veach-ajar) figure veach-ajar 6k 64 36 "${REFERENCE_SPP:-65536}" ;;
    *) echo "$0: no scene '$name'" >&2; exit 2 ;;
  esac
done
