#include "tools/common/film_size.h"
#include "tools/merge/merge.h"
#include "tools/render/outputs.h"

namespace bnvpl {

std::vector<fs::path> mergeRendered(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                    Summary& summary) {
  const ShardRun& whole = shards.whole();
  Values options = resolveRender(whole.given);
  options.set("exposure", output.exposure);
  const Film film = parseSize(whole.run.at("view").at("size").get<std::string>());
  RenderResult result = joinRendered(film, options, shards.source());
  result.vpls = whole.sources.at("vpls").get<size_t>();
  finishImage(result, options, whole.history);
  reportRender(result, options, summary);
  addImages(files, {output.product, output.png}, result.image, options, summary);
  return {};
}

}  // namespace bnvpl
