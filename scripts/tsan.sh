#!/usr/bin/env bash
# The tests under ThreadSanitizer. Options go to ctest: scripts/tsan.sh -R estimate
# Debian's oneTBB is not compiled for it: the sanitizer does not see that a task begins after it was
# spawned, and takes that for races everywhere. So the same version is built with it, into
# build/tsan-tbb, from Debian's archive. The other libraries stay as they are.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

version=2021.8.0
sha256=7e9111b8bb59c8800bf6d0b06afe7b0891937443d2dae1ee1101c8e2ede6a7ef
tbb=$PWD/build/tsan-tbb
if [[ ! -e $tbb/lib_relwithdebinfo/libtbb.so.12 ]]; then
  mkdir -p "$tbb/source"
  python3 -c 'import sys, urllib.request as u; u.urlretrieve(*sys.argv[1:])' \
    "https://deb.debian.org/debian/pool/main/o/onetbb/onetbb_$version.orig.tar.xz" "$tbb/source.tar.xz"
  echo "$sha256  $tbb/source.tar.xz" | sha256sum --check --quiet
  tar --extract --file="$tbb/source.tar.xz" --directory="$tbb/source" --strip-components=1
  cmake -S "$tbb/source" -B "$tbb" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_SANITIZE=thread \
    -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_OUTPUT_DIR_BASE=lib
  cmake --build "$tbb" --target tbb
fi

cmake --preset tsan
cmake --build --preset tsan
export LD_LIBRARY_PATH=$tbb/lib_relwithdebinfo
export TSAN_OPTIONS=halt_on_error=1  # the first report ends the process, and so fails its test
exec ctest --preset tsan "$@"
