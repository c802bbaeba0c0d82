// Whether files are whole, and whether they belong together: `vpl-inspect check`.
#pragma once

#include <optional>
#include <span>

#include "formats/vpl_table.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {

struct CheckedFile {
  fs::path file;
  std::string what;               // "lit, 3000 rows" or "OpenEXR, 640 x 480 pixels, 3 channels"
  std::optional<VplStage> stage;  // of a .vpl file
  std::string checksum;           // of a .vpl file, 16 hex digits
  std::string scene;              // content hash, 16 hex digits; empty where the file names none
  std::string moreOptions;        // of an image: those of its command that no history tells
  std::vector<StageRecord> chain;
};

// Reads and verifies everything. Throws InputError; also when the file contradicts its own history
// or an image holds a value that is not a number.
CheckedFile checkFile(const fs::path& file);

// Refuses files of different scenes, and a file whose history names an input other than the given
// file of that stage. Files that do not speak of each other pass. Throws InputError that names the
// stage to rerun.
void checkTogether(std::span<const CheckedFile> files);

// Refuses files that were made from another scene than `sceneHash` (16 hex digits), or that name
// none; `scene` is its name in the message of the InputError.
void checkScene(std::span<const CheckedFile> files, const std::string& scene,
                const std::string& sceneHash);

}  // namespace bnvpl
