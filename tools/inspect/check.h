// Whether files are whole, and whether they belong together: `vpl-inspect check`.
#pragma once

#include <optional>
#include <span>

#include "formats/vpl_table.h"
#include "scene/scene.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {

struct CheckedFile {
  fs::path file;
  std::string what;               // "lit, 3000 rows" or "OpenEXR, 640 x 480 pixels, 3 channels"
  std::optional<VplStage> stage;  // of a .vpl file
  std::string checksum;           // of a .vpl file, 16 hex digits
  std::string scene;              // content hash, 16 hex digits; empty where the file names none
  std::optional<Film> film;       // of an image
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

// Refuses files that were made from another scene, or that name none, and those of which a stage
// looked at another view than the scene's: images, whose size may be their own, and what rejection
// kept. VPLs may be placed for another view. Throws InputError.
void checkScene(std::span<const CheckedFile> files, const Scene& scene);

// What is wrong with the view that the stage of this record looked at, or empty.
std::string brokenView(const CheckedFile& file, const StageRecord& record, const Scene& scene);
// Which views VPLs of these files were placed for, where the scene's is none of them, which is no
// error; else empty.
std::string placedForAnotherView(std::span<const CheckedFile> files, const Scene& scene);

}  // namespace bnvpl
