#!/bin/sh
# Every glTF file of ours must be valid by Khronos' gltf-validator: what tests write and load, Blender's
# export, our room. Needs Node.js and npm.
#
#   scripts/validate_gltf.sh [BUILD]     BUILD: folder with bin/gltf_test; build/release unless given
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/release}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/files"
# These load what is not valid, on purpose: missing or foreign images, coordinates that are not there,
# normals of any length, clearcoat maps without texture coordinates. gltf-validator does not decompress.
lenient="ExtensionsSetTheirParameters ImagesComeFromFilesAndDataUris OneSetOfTextureCoordinatesCounts ReadsNormalsAndTurns DecodesMeshopt"
BNVPL_KEEP_GLTF="$work/files" "$build/bin/gltf_test" > "$work/log" || { cat "$work/log" >&2; exit 1; }
for test in $lenient; do rm -r "$work/files/$test"*; done
cp scenes/gltf-room/room.glb "tests/scene/blender/gltf room.glb" "$work/files"
npm install --silent --no-save --prefix "$work" gltf-validator@2.0.0-dev.3.10 > /dev/null
cat > "$work/validate.cjs" <<'EOF'
const { validateBytes } = require('gltf-validator'), fs = require('fs'), path = require('path');
const files = fs.readdirSync('files', { recursive: true, withFileTypes: true })
  .filter(f => /\.(gltf|glb)$/.test(f.name)).map(f => path.join(f.path, f.name)).sort();
(async () => {
  let wrong = 0;
  for (const file of files) {
    const beside = uri => fs.promises.readFile(path.join(path.dirname(file), decodeURIComponent(uri)));
    const { issues } = await validateBytes(new Uint8Array(fs.readFileSync(file)),
      { uri: file, externalResourceFunction: async uri => new Uint8Array(await beside(uri)) });
    for (const m of issues.messages.filter(m => m.severity === 0)) console.log(`${file}: ${m.code} ${m.pointer}: ${m.message}`);
    wrong += issues.numErrors > 0;
  }
  console.log(`${files.length} files, ${wrong} with errors`);
  process.exit(wrong > 0 ? 5 : 0);
})();
EOF
cd "$work" && node validate.cjs
