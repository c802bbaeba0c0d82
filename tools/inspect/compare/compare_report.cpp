#include "tools/inspect/compare/compare_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/common/files/escape_text.h"
#include "tools/common/process/exit_codes.h"
#include "tools/inspect/append_text.h"

namespace bnvpl {
namespace {

Json finiteOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// For a black reference some measures are 0/0 or x/0.
std::string orUndefined(double value) {
  if (!std::isfinite(value)) return "undefined";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

struct Limit {
  const char* what;
  double value;
  std::optional<double> most;
};
std::array<Limit, 3> limits(const Comparison& c, const CompareOptions& options) {
  return {{{"relMSE", c.relMse, options.maxRelMse},
           {"RMSE", c.rmse, options.maxRmse},
           {"RMSE / mean", c.rmseOverMean(), options.maxRmseOverMean}}};
}
// The negated comparison lets an undefined value exceed any limit.
bool exceeds(const Limit& limit) { return limit.most && !(limit.value <= *limit.most); }

Json channelJson(const Comparison::Channel& k) {
  return {{"name", k.name},
          {"mean", k.meanA},
          {"mean_reference", k.meanB},
          {"mean_ratio", finiteOrNull(k.meanA / k.meanB)},
          {"rmse", k.rmse},
          {"relmse", finiteOrNull(k.relMse)},
          {"smape", k.smape}};
}

Json flipJson(const Comparison::Flip& flip) {
  return {{"pixels_per_degree", flip.ppd},
          {"exposure_ev", flip.exposureEv},
          {"hdr_start_ev", flip.startEv},
          {"hdr_stop_ev", flip.stopEv},
          {"hdr_exposures", flip.exposures}};
}

void addFlipText(const Comparison::Flip& flip, std::string& out) {
  append(out, "FLIP           %.6g   (at %+g EV, %.4g pixels per degree)\n", flip.ldr,
         flip.exposureEv, flip.ppd);
  append(out, "HDR-FLIP       %.6g   (the largest of %zu exposures from %+.4g to %+.4g EV)\n",
         flip.hdr, flip.exposures, flip.startEv, flip.stopEv);
}

void addChannelText(const Comparison& c, std::string& out) {
  if (c.channels.size() == 1) return;
  append(out, "%-14s %-12s %-12s %s\n", "of each", "RMSE", "relMSE", "SMAPE");
  const auto row = [&](const Comparison::Channel& k) {
    append(out, "  %-12s %-12.6g %-12s %.6g\n", escapedLine(k.name).c_str(), k.rmse,
           orUndefined(k.relMse).c_str(), k.smape);
  };
  for (const Comparison::Channel& k : c.channels) row(k);
  if (c.luminance) row(*c.luminance);
}

}  // namespace

Json comparisonJson(const Comparison& c, const CompareOptions& options) {
  Json json{{"mean", c.meanA},
            {"mean_reference", c.meanB},
            {"mean_ratio", finiteOrNull(c.meanRatio())},
            {"rmse", c.rmse},
            {"rmse_over_mean", finiteOrNull(c.rmseOverMean())},
            {"relmse", finiteOrNull(c.relMse)},
            {"rmse_below_noise", c.rmseBelowNoise},
            {"relmse_below_noise", c.relMseBelowNoise},
            {"relmse_epsilon", c.epsilon},
            {"smape", c.smape},
            {"flip", c.flip ? Json(c.flip->ldr) : Json(nullptr)},
            {"hdr_flip", c.flip ? Json(c.flip->hdr) : Json(nullptr)},
            {"flip_settings", c.flip ? flipJson(*c.flip) : Json(nullptr)},
            {"mask_pixels", c.maskPixels ? Json(*c.maskPixels) : Json(nullptr)},
            {"worst_pixel", {c.worstPixel[0], c.worstPixel[1]}},
            {"channels", Json::array()}};
  for (const Comparison::Channel& k : c.channels) json["channels"].push_back(channelJson(k));
  json["luminance"] = c.luminance ? channelJson(*c.luminance) : Json(nullptr);
  json["within_limits"] = comparisonExitCode(c, options) == kExitOk;
  return json;
}

std::string comparisonText(const Comparison& c, const CompareOptions& options) {
  std::string out;
  append(out, "mean ratio     %s   (mean %.6g, reference %.6g)\n",
         orUndefined(c.meanRatio()).c_str(), c.meanA, c.meanB);
  for (const Comparison::Channel& k : c.channels) {
    if (c.channels.size() == 1) break;
    append(out, "  %-12s %s   (mean %.6g, reference %.6g)\n", escapedLine(k.name).c_str(),
           orUndefined(k.meanA / k.meanB).c_str(), k.meanA, k.meanB);
  }
  constexpr const char* kBelow = "   (below the reference's noise)";
  append(out, "RMSE           %.6g%s\n", c.rmse, c.rmseBelowNoise ? kBelow : "");
  append(out, "RMSE / mean    %s\n", orUndefined(c.rmseOverMean()).c_str());
  append(out, "relMSE         %s   (epsilon %.6g = %g times the squared mean of the reference)%s\n",
         orUndefined(c.relMse).c_str(), c.epsilon, options.epsilon,
         c.relMseBelowNoise ? kBelow : "");
  append(out, "SMAPE          %.6g\n", c.smape);
  if (c.flip) addFlipText(*c.flip, out);
  addChannelText(c, out);
  append(out, "worst pixel    (%zu, %zu)\n", c.worstPixel[0], c.worstPixel[1]);
  if (c.maskPixels) append(out, "mask           counts %.6g pixels\n", *c.maskPixels);
  for (const Limit& limit : limits(c, options)) {
    if (!exceeds(limit)) continue;
    append(out, "DIFFERENT: %s %s exceeds the limit %g\n", limit.what,
           orUndefined(limit.value).c_str(), *limit.most);
  }
  return out;
}

int comparisonExitCode(const Comparison& c, const CompareOptions& options) {
  const auto all = limits(c, options);
  return std::any_of(all.begin(), all.end(), exceeds) ? kExitDifferent : kExitOk;
}

}  // namespace bnvpl
