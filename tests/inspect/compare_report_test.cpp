// What `compare` prints, and its exit codes.
#include "tools/inspect/compare/compare_report.h"

#include <gtest/gtest.h>

#include "tests/support/flat_image.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

Comparison compare(const Image& a, const Image& b, const Mask& mask = {}) {
  return compareLayers("a.exr", findLayer("a.exr", a, ""), "b.exr", findLayer("b.exr", b, ""),
                       CompareOptions{}.epsilon, nullptr, mask);
}

TEST(CompareReport, ABlackReferenceExceedsAnyLimit) {
  const Comparison c = compare(flatImage(2, 1, 1, 1, 1), flatImage(2, 1, 0, 0, 0));
  CompareOptions limits;
  limits.maxRelMse = 1e30;
  EXPECT_EQ(comparisonExitCode(c, limits), kExitDifferent);
  EXPECT_EQ(comparisonJson(c, limits)["relmse"], nullptr);
}

TEST(CompareReport, LimitsDecideTheExitCode) {
  const Comparison c =
      compare(flatImage(1, 1, 3, 3, 3), flatImage(1, 1, 2, 2, 2));  // RMSE 1, over mean 0.5
  const auto code = [&](std::optional<double> CompareOptions::*limit, double value) {
    CompareOptions options;
    options.*limit = value;
    return comparisonExitCode(c, options);
  };
  EXPECT_EQ(comparisonExitCode(c, {}), kExitOk);
  EXPECT_EQ(code(&CompareOptions::maxRmse, 1.0), kExitOk);
  EXPECT_EQ(code(&CompareOptions::maxRmse, 0.99), kExitDifferent);
  EXPECT_EQ(code(&CompareOptions::maxRmseOverMean, 0.5), kExitOk);
  EXPECT_EQ(code(&CompareOptions::maxRmseOverMean, 0.49), kExitDifferent);
  EXPECT_EQ(code(&CompareOptions::maxRelMse, 0.25), kExitOk);
  EXPECT_EQ(code(&CompareOptions::maxRelMse, 0.24), kExitDifferent);
  EXPECT_EQ(code(&CompareOptions::maxRmse, 0.0), kExitDifferent);
}

TEST(CompareReport, OnlyLightHasALuminance) {
  Image image = flatImage(1, 1, 1, 1, 1);
  for (const char* name : {"N.X", "N.Y", "N.Z"}) image.add(name) = {0.5f};
  const Layer normals = findLayer("a.exr", image, "N");
  const Json json = comparisonJson(compareLayers("a.exr", normals, "a.exr", normals), {});
  EXPECT_EQ(json["luminance"], nullptr);
  EXPECT_EQ(json["flip"], nullptr);
}

TEST(CompareReport, JsonHoldsAllMeasures) {
  Image a = flatImage(2, 1, 1, 1, 1);
  a.channels[0].data = {3, 1};
  a.channels[1].data = {1, 0};
  Comparison c = compare(a, flatImage(2, 1, 1, 1, 1), Mask{{1.0, 0.5}});
  FlipMaps maps;
  maps.ldr = {0.25f, 0.5f};
  maps.hdr = {0.5f, 1.0f};
  maps.startEv = -4.0;
  addFlip(maps, Mask{{1.0, 0.5}}, c);
  const Json json = comparisonJson(c, {});
  EXPECT_DOUBLE_EQ(json["flip"].get<double>(), (0.25 + 0.25) / 1.5);
  EXPECT_DOUBLE_EQ(json["hdr_flip"].get<double>(), 1.0 / 1.5);
  EXPECT_EQ(json["flip_settings"]["hdr_start_ev"], -4.0);
  EXPECT_EQ(json["smape"], c.smape);
  EXPECT_EQ(json["mask_pixels"], 1.5);
  EXPECT_EQ(json["channels"][0]["rmse"], c.channels[0].rmse);
  EXPECT_EQ(json["channels"][1]["smape"], c.channels[1].smape);
  EXPECT_EQ(json["luminance"]["relmse"], c.luminance->relMse);
  for (const char* key : {"mean", "mean_reference", "mean_ratio", "rmse", "rmse_over_mean",
                          "relmse", "relmse_epsilon", "worst_pixel", "within_limits"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

}  // namespace
}  // namespace bnvpl
