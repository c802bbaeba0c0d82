#include "scene/read/pbrt/read_pbrt.h"

#include "scene/read/pbrt/build.h"
#include "scene/read/pbrt/syntax/parser.h"

namespace bnvpl {

void readScenePbrt(const fs::path& file, const Defines&, SceneBuilder& builder) {
  pbrt::Description description;
  pbrt::Notes notes;
  pbrt::parse(file, description, notes);
  for (const std::string& name : description.files) builder.addFile(name);
  pbrt::build(description, file.parent_path(), notes, builder);
  for (const std::string& line : notes.lines()) builder.warn(line);
}

}  // namespace bnvpl
