// Checks whether files are intact and belong together: `vpl-inspect check`.
#pragma once

#include <optional>
#include <span>

#include "formats/vpl/vpl_table.h"
#include "scene/scene.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {

struct CheckedFile {
  fs::path file;
  std::string what;               // "lit, 3000 rows" or "OpenEXR, 640 x 480 pixels, 3 channels"
  std::optional<VplStage> stage;  // .vpl files only
  std::string checksum;           // .vpl files only; 16 hex digits
  std::string scene;              // content hash, 16 hex digits; empty if the file names none
  std::optional<Film> film;       // images only
  std::string moreOptions;        // images only: options of the command that no history records
  std::vector<StageRecord> chain;
};

// Reads and verifies the whole file. Throws InputError, also if the file contradicts its own
// history or an image holds a value that is not finite.
CheckedFile checkFile(const fs::path& file);

// Throws InputError, which names the stage to rerun, for files of different scenes, and for a file
// whose history names another input than the given file of that stage. Unrelated files pass.
void checkTogether(std::span<const CheckedFile> files);

// Throws InputError for files that were made from another scene or name none, and for images and
// VPLs kept by rejection that were made for another view. Images may have another size than the
// scene's film, and VPLs may be placed for another view.
void checkScene(std::span<const CheckedFile> files, const Scene& scene);

// Says that the stage of this record used another view than the scene's; empty if it did not.
std::string brokenView(const CheckedFile& file, const StageRecord& record, const Scene& scene);
// The views that VPLs were placed for, unless the scene's view is among them; then empty. Another
// view is no error.
std::string placedForAnotherView(std::span<const CheckedFile> files, const Scene& scene);

}  // namespace bnvpl
