#include "core/memory.h"
#include "tools/common/options/film_size.h"
#include "tools/merge/merge.h"
#include "tools/render/outputs.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

namespace {

Film filmOf(const ShardRun& whole) {
  try {
    return parseSize(fieldOf<std::string>(fieldOf<Json>(whole.run, "view"), "size"));
  } catch (const UsageError&) {
    throw InputError("the shards have a film of a strange size; make them again");
  }
}

}  // namespace

std::vector<fs::path> mergeRendered(ShardSet& shards, const MergeOutput& output, OutputSet& files,
                                    Summary& summary) {
  const ShardRun& whole = shards.whole();
  Values options = optionsOf(whole, renderSpec(), resolveRender);
  if (budgetOf(options)) throw InputError("shards of passes cannot be merged; make them again");
  options.set(kExposureOption, output.exposure);
  const Film film = filmOf(whole);
  const auto groups = fieldOf<std::vector<std::string>>(whole.sources, "light_groups");
  requireMemory(bytesPerPixelOf(options, groups.size()) * film.width * film.height,
                "an image of " + sizeText(film) + " pixels", "choose a smaller --size");
  RenderResult result = joinRendered(film, options, shards.source(), groups);
  takeSources(whole.sources, result);
  finishImage(result, options, whole.history);
  reportRender(result, options, summary);
  if (findNonFinite(result.image))
    throw InputError("the shards hold values that are not finite; make them again");
  addImages(files, {output.product, output.png}, result.image, options, summary);
  return {};
}

}  // namespace bnvpl
