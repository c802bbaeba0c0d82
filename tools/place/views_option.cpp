#include "tools/place/views_option.h"

#include <algorithm>
#include <cmath>

namespace bnvpl {

std::vector<uint64_t> parseViewShares(const std::string& text) {
  std::vector<uint64_t> shares;
  uint64_t all = 0;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const auto share = parseReal(text.substr(begin, end - begin));
    const bool whole =
        share && *share >= 1 && *share <= kMaxViewTurns && *share == std::floor(*share);
    all += shares.emplace_back(whole ? static_cast<uint64_t>(*share) : 0);
    if (!whole || all > kMaxViewTurns) {
      throw UsageError("--view-shares '" + text +
                       "' is not a list of whole numbers such as 2,1,1, of at most " +
                       std::to_string(kMaxViewTurns) + " together");
    }
    begin = end + 1;
  }
  return shares;
}

PlaceViews placeViews(const SceneOptions& options, std::vector<uint64_t> shares,
                      const PlaceMethod& method, Scene& scene) {
  std::vector<View> views = viewsOf(options, scene);
  if (views.size() > 1 && !method.forView) {
    throw UsageError("--method " + std::string(method.name) +
                     " asks for no view; leave all but one out");
  }
  if (shares.empty()) shares.assign(views.size(), 1);
  if (shares.size() != views.size()) {
    throw UsageError("--view-shares has " + std::to_string(shares.size()) + " parts for " +
                     std::to_string(views.size()) + " views; give one for each --view or --camera");
  }
  if (shares.size() > kMaxViewTurns)
    throw UsageError("more than " + std::to_string(kMaxViewTurns) + " views; name fewer");
  return {std::move(views), std::move(shares)};
}

void recordViews(const PlaceViews& of, Json& record) {
  if (of.views.size() == 1) {
    record["view"] = viewRecord(of.views.front().camera, of.views.front().film);
    return;
  }
  for (size_t v = 0; v < of.views.size(); ++v) {
    Json one = viewRecord(of.views[v].camera, of.views[v].film);
    one["share"] = of.turns.shares()[v];
    record["views"].push_back(std::move(one));
  }
}

}  // namespace bnvpl
