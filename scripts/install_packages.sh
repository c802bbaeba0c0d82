#!/usr/bin/env bash
# Installs the packages that the build and the tests need on Debian 12 and 13 and Ubuntu 24.04, and those named as
# arguments. Does nothing when all are installed.
#   scripts/install_packages.sh [--build] [PACKAGE ...]   --build: no packages of tests, evaluation and Python
set -euo pipefail

# Ubuntu has another package of libjpeg-turbo, and Chromium as a snap only.
jpeg=libjpeg62-turbo-dev
browser=(chromium chromium-driver)
if [[ $(. /etc/os-release 2>/dev/null && echo "${ID:-}") == ubuntu ]]; then
  jpeg=libjpeg-turbo8-dev
  browser=()
fi

packages=(
  build-essential cmake ninja-build pkg-config python3
  libembree-dev libtbb-dev                                # ray tracing, threads
  libflann-dev liblz4-dev                                 # kd-tree; FLANN's headers need lz4
  libopenvdb-dev libboost-iostreams-dev                   # point grid; FindOpenVDB requires Boost
  libopenexr-dev libpng-dev "$jpeg"                       # images
  zlib1g-dev libstb-dev                                   # gzip; TGA, BMP
  libtinyobjloader-dev libtomlplusplus-dev libcli11-dev   # meshes, scene.toml, options
  libtinygltf-dev libdraco-dev libmeshoptimizer-dev       # glTF, and its compressions
  nlohmann-json3-dev libxxhash-dev                        # provenance, checksums
  libgtest-dev libbenchmark-dev                           # tests, benchmarks
)
others=(
  python3-numpy python3-matplotlib python3-openimageio    # evaluation, package
  python3-xxhash python3-pip python3-yaml                 # Python package; test of the workflow
  "${browser[@]}" python3-selenium                        # test of its report
)
if [[ ${1:-} == --build ]]; then
  shift
else
  packages+=("${others[@]}")
fi
packages+=("$@")

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "No apt here, so nothing is installed. The build needs what Debian calls:"
  echo "  ${packages[*]}"
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "All ${#packages[@]} packages are installed."
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "Missing: ${missing[*]}" >&2
    echo "Neither root nor sudo here; run as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300)

echo "Installing ${#missing[@]} packages with ${as_root[*]:+sudo }apt-get: ${missing[*]}"
"${apt[@]}" update
"${apt[@]}" install --yes --no-install-recommends "${missing[@]}"
