// Options of the methods that use a TileIntegrator.
#pragma once

#include "tools/common/options/option.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

inline constexpr WholeOption kDirectSamplesOption =
    neededBy({kDirectIsShown}, wholeOption("direct-samples", "0", 0, 4096, "",
                                           "camera samples of direct light for each sample; 0: "
                                           "chosen by variance and cost; 1: the sample itself"));
constexpr WholeOption reuseOption(std::string_view defaultText, std::string_view help) {
  return neededBy({kIndirectIsShown}, wholeOption("reuse", defaultText, 1, 32, "", help));
}
inline constexpr OptionKey<uint64_t> kReuseKey = reuseOption("1", {}).key();
constexpr TextOption controlOption(std::string_view defaultText) {
  return neededBy({kIndirectIsShown},
                  choiceOption("control", defaultText, "vpls|none",
                               "control variate of indirect light within a pixel: the VPLs' "
                               "prediction along more camera rays, or none"));
}
inline constexpr OptionKey<std::string> kControlKey = controlOption("none").key();
constexpr SwitchOption allocateOption(std::string_view help) {
  return neededBy({kIndirectIsShown, valueIs(kDirectSamplesOption, "0")},
                  switchOption("allocate", "on", help));
}
inline constexpr OptionKey<bool> kAllocateKey = allocateOption({}).key();

// Samples a pixel to which preparations are fitted: a budget of time or error has no number of its
// own.
inline uint64_t preparedSpp(const Values& options) {
  constexpr uint64_t kSppOfBudgets = 256;
  const uint64_t spp = options[kSppOption];
  return spp < static_cast<uint64_t>(kUnlimitedSpp) ? spp : kSppOfBudgets;
}
// Limit of the photons of an image, which are made once for all of its passes and shards.
inline constexpr uint64_t kMaxCausticPhotons = 16000000;

}  // namespace bnvpl
