#include "tools/inspect/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace bnvpl {
namespace {

bool take(const Image& image, const std::vector<std::string>& names, Layer& layer) {
  layer.channels.clear();
  layer.data.clear();
  for (const std::string& name : names) {
    const std::vector<float>* data = image.find(name);
    if (data == nullptr) return false;
    layer.channels.push_back(name);
    layer.data.push_back(data);
  }
  return true;
}

std::string layerNames(const Image& image) {
  std::set<std::string> names;
  for (const ImageChannel& channel : image.channels) {
    const size_t dot = channel.name.rfind('.');
    names.insert(dot == std::string::npos ? channel.name : channel.name.substr(0, dot));
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "nothing" : text;
}

void requireFinite(const fs::path& file, const Layer& layer) {
  for (size_t c = 0; c < layer.data.size(); ++c) {
    for (size_t i = 0; i < layer.data[c]->size(); ++i) {
      if (std::isfinite((*layer.data[c])[i])) continue;
      const size_t width = static_cast<size_t>(layer.width);
      throw InputError(file, "channel " + layer.channels[c] + " is not finite at pixel (" +
                                 std::to_string(i % width) + ", " + std::to_string(i / width) +
                                 "); rerun vpl-render");
    }
  }
}

double meanOf(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += double{v};
  return values.empty() ? 0.0 : sum / double(values.size());
}

void addMeans(const Layer& a, const Layer& b, Comparison& c) {
  for (size_t k = 0; k < b.data.size(); ++k) {
    c.channels.push_back({b.channels[k], meanOf(*a.data[k]), meanOf(*b.data[k])});
    c.meanA += c.channels[k].meanA / double(b.data.size());
    c.meanB += c.channels[k].meanB / double(b.data.size());
  }
}

void addErrors(const Layer& a, const Layer& b, const Layer& second, Comparison& c) {
  const size_t pixels = b.data[0]->size(), width = static_cast<size_t>(b.width);
  double squared = 0.0, relative = 0.0, worst = -1.0;
  for (size_t i = 0; i < pixels; ++i) {
    double pixelSquared = 0.0;
    for (size_t k = 0; k < b.data.size(); ++k) {
      const double value = double{(*a.data[k])[i]};
      const double b1 = double{(*b.data[k])[i]}, b2 = double{(*second.data[k])[i]};
      const double error = (value - b1) * (value - b2), reference = 0.5 * (b1 + b2);
      pixelSquared += error;
      if (error != 0.0) relative += error / (reference * reference + c.epsilon);
    }
    squared += pixelSquared;
    if (pixelSquared > worst) {
      worst = pixelSquared;
      c.worstPixel = {i % width, i / width};
    }
  }
  const double count = double(pixels * b.data.size());
  c.mse = std::max(0.0, squared / count);
  c.rmse = std::sqrt(c.mse);
  c.relMse = std::max(0.0, relative / count);
}

Json finiteOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

struct Limit {
  const char* what;
  double value, most;  // negative: no limit
};
std::array<Limit, 3> limits(const Comparison& c, const CompareOptions& options) {
  return {{{"relMSE", c.relMse, options.maxRelMse},
           {"RMSE", c.rmse, options.maxRmse},
           {"RMSE / mean", c.rmseOverMean(), options.maxRmseOverMean}}};
}
// Written so that an undefined value exceeds any limit.
bool exceeds(const Limit& limit) { return limit.most >= 0.0 && !(limit.value <= limit.most); }

}  // namespace

Layer findLayer(const fs::path& file, const Image& image, const std::string& name) {
  Layer layer;
  layer.name = name;
  layer.width = image.width;
  layer.height = image.height;
  const std::string dot = name.empty() ? "" : name + ".";
  if (take(image, {dot + "R", dot + "G", dot + "B"}, layer)) return layer;
  if (take(image, {dot + "X", dot + "Y", dot + "Z"}, layer)) return layer;
  if (!name.empty() && take(image, {name}, layer)) return layer;
  throw InputError(file,
                   (name.empty() ? "has no channels R, G, B" : "has no layer '" + name + "'") +
                       "; it holds " + layerNames(image));
}

Comparison compareLayers(const fs::path& fileA, const Layer& a, const fs::path& fileB,
                         const Layer& b, const CompareOptions& options, const Layer* second) {
  const auto size = [](const Layer& l) {
    return std::to_string(l.width) + " x " + std::to_string(l.height) + " pixels of " +
           std::to_string(l.data.size()) + " channels";
  };
  const auto sameShape = [&](const Layer& l) {
    return l.width == b.width && l.height == b.height && l.data.size() == b.data.size();
  };
  if (second != nullptr && !sameShape(*second)) {
    throw InputError(fileB, size(b) + ", but its second half has " + size(*second) +
                                "; render both from one scene.toml");
  }
  if (!sameShape(a)) {
    throw InputError(fileA, size(a) + ", but " + fileB.string() + " has " + size(b) +
                                "; render both from one scene.toml");
  }
  requireFinite(fileA, a);
  requireFinite(fileB, b);
  Comparison c;
  addMeans(a, b, c);
  c.epsilon = options.epsilon * c.meanB * c.meanB;
  addErrors(a, b, second != nullptr ? *second : b, c);
  return c;
}

Json comparisonJson(const Comparison& c, const CompareOptions& options) {
  Json json{{"mean", c.meanA},
            {"mean_reference", c.meanB},
            {"mean_ratio", finiteOrNull(c.meanRatio())},
            {"rmse", c.rmse},
            {"rmse_over_mean", finiteOrNull(c.rmseOverMean())},
            {"relmse", finiteOrNull(c.relMse)},
            {"relmse_epsilon", c.epsilon},
            {"worst_pixel", {c.worstPixel[0], c.worstPixel[1]}},
            {"channels", Json::array()}};
  for (const Comparison::Channel& k : c.channels) {
    json["channels"].push_back({{"name", k.name},
                                {"mean", k.meanA},
                                {"mean_reference", k.meanB},
                                {"mean_ratio", finiteOrNull(k.meanA / k.meanB)}});
  }
  json["within_limits"] = comparisonExitCode(c, options) == kExitOk;
  return json;
}

std::string comparisonText(const Comparison& c, const CompareOptions& options) {
  char line[256];
  std::string text;
  const auto add = [&](auto... values) {
    std::snprintf(line, sizeof line, values...);
    text += line;
  };
  add("mean ratio     %.6g   (mean %.6g, reference %.6g)\n", c.meanRatio(), c.meanA, c.meanB);
  for (const Comparison::Channel& k : c.channels) {
    if (c.channels.size() == 1) break;
    add("  %-12s %.6g   (mean %.6g, reference %.6g)\n", k.name.c_str(), k.meanA / k.meanB, k.meanA,
        k.meanB);
  }
  add("RMSE           %.6g\n", c.rmse);
  add("RMSE / mean    %.6g\n", c.rmseOverMean());
  add("relMSE         %.6g   (epsilon %.6g = %g times the squared mean of the reference)\n",
      c.relMse, c.epsilon, options.epsilon);
  add("worst pixel    (%zu, %zu)\n", c.worstPixel[0], c.worstPixel[1]);
  for (const Limit& limit : limits(c, options)) {
    if (!exceeds(limit)) continue;
    add("DIFFERENT: %s %.6g exceeds the limit %g\n", limit.what, limit.value, limit.most);
  }
  return text;
}

int comparisonExitCode(const Comparison& c, const CompareOptions& options) {
  const auto all = limits(c, options);
  return std::any_of(all.begin(), all.end(), exceeds) ? kExitDifferent : kExitOk;
}

}  // namespace bnvpl
