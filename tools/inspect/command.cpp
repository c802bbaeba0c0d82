#include "tools/inspect/command.h"

namespace bnvpl {

void saveStats(const char* command, Json figures, const Summary& start, const ToolOptions& tool) {
  Summary summary = start;
  summary.add(command, std::move(figures));
  OutputSet files;
  summary.save(tool, files);
}

}  // namespace bnvpl
