// What vpl-render shows while it renders: --png by passes, and --preview.
#pragma once

#include <optional>
#include <string>

#include "tools/render/outputs.h"
#include "tools/render/preview/live_viewer.h"

namespace bnvpl {

class Previews {
 public:
  // `viewer`: address of a viewer, or empty. Throws UsageError.
  explicit Previews(const std::string& viewer);
  // What a film is to show. The options must outlive it.
  FilmPreview begin(const ImagePaths& paths, const Values& options, const Film& film);
  // Shows the image as it is written, and says in the summary whether a viewer was there.
  void finish(const Image& image, Summary& summary);

 private:
  std::optional<ViewerAddress> address_;
  std::optional<LiveViewer> viewer_;
};

}  // namespace bnvpl
