#!/usr/bin/env bash
# Checks all Python files with ruff and mypy --strict; pyproject.toml has their settings.
# The exit status is 0 only if both ran and found nothing, 1 if they found something, and 2 if one
# of them is missing.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

missing=0
require() {
  command -v "$1" >/dev/null && return
  echo "check_python.sh: $1 is not installed; $2" >&2
  missing=1
}
require ruff "pip install ruff"
require mypy "apt-get install mypy, or pip install mypy"
((missing)) && exit 2

failed=0
mapfile -t files < <(git ls-files '*.py')
echo "ruff: ${#files[@]} files"
ruff check --quiet "${files[@]}" || failed=1

# Programs import the modules of their own folder and of the folders that they add to sys.path, and
# some names occur in several folders. So each group of folders is checked with a path of its own.
check() {
  echo "mypy: ${*:2}"
  MYPYPATH=$1 mypy --no-error-summary --explicit-package-bases --python-executable /usr/bin/python3 \
    --cache-dir "build/mypy/${1//[:\/]/_}" "${@:2}" || failed=1
}
check install install/*.py tests/install/*.py
check blender:python blender/bnvpl_blender/*.py blender/tests/*.py
check bench:pipelines:eval:python bench/*.py
check docs:eval/scaling:eval/report:eval:pipelines docs/*.py
check eval:eval/report:pipelines:python eval/*.py eval/bnvpl_eval eval/tests/*.py
check eval/cycles:pipelines eval/cycles/*.py
check eval/scaling:bench:pipelines eval/scaling/*.py
check eval/report:pipelines eval/report/*.py
check pipelines:pipelines/slurm pipelines/*.py pipelines/slurm/*.py
check python:python/examples:python/tests python/bnvpl python/examples/*.py python/tests/*.py
check scenes scenes/generate.py scenes/generator
check scenes/gltf-room scenes/gltf-room/*.py
check scripts scripts/*.py
check tests/bytes:pipelines:python tests/{bytes,formats,images,pipeline,shards}/*.py tests/inspect/*/*.py
check tests/cluster:pipelines:pipelines/slurm:eval/scaling tests/cluster/*.py
check tests/faults tests/faults/*.py
check tests/scene/blender tests/scene/blender/*.py
check scripts tests/source/*.py
((failed)) || echo "clean"
exit "$failed"
