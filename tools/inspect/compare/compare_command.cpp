// `vpl-inspect compare`: options, reading of files, and output of figures and pictures.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "formats/image/exr_io.h"
#include "formats/image/png_io.h"
#include "images/difference_image.h"
#include "images/error_map.h"
#include "tools/common/files/standard_streams.h"
#include "tools/common/options/choice.h"
#include "tools/common/options/exposure.h"
#include "tools/common/options/help.h"
#include "tools/common/stage/run_files.h"
#include "tools/inspect/command.h"
#include "tools/inspect/compare/compare_report.h"
#include "tools/inspect/file_kind.h"
#include "tools/inspect/provenance.h"

namespace bnvpl {
namespace {

struct CompareRequest {
  fs::path imageA, imageB, secondB, mask, diff;
  std::string layer, layerA, layerB;  // layerA and layerB override `layer`
  CompareOptions limits;
  std::string exposure;       // for LDR-FLIP, stops or auto
  std::string flipExposures;  // for HDR-FLIP, START:STOP or auto; empty: as in `flip`
  FlipOptions flip;
  std::vector<const CLI::Option*> ofFlip;  // options that only FLIP uses
  MapKind map = MapKind::Difference;
  std::optional<double> diffRange;  // value at the end of the colour scale; none: the map's own
  bool json = false;
};

const Choices<MapKind> kMaps{{"difference", MapKind::Difference},
                             {"relmse", MapKind::RelMse},
                             {"smape", MapKind::Smape},
                             {"flip", MapKind::Flip},
                             {"hdr-flip", MapKind::HdrFlip}};

// The layers to compare, and the images that they point into.
struct Sides {
  Image imageA, imageB, imageSecond, imageMean;
  Layer a, b, second;
  Layer reference;  // `b`, or the mean of `b` and `second`
  Mask mask;
  bool halves = false;
};

Image readImage(const fs::path& file) {
  if (wholeFileKind(file) == FileKind::Vpl)
    throw InputError(file, "is a .vpl file, not an image; name an .exr of vpl-render");
  return readExr(file);
}

// Throws InputError if the second half equals another image: equal halves hide the reference's
// noise, and a half that equals A would make A's noise count as the reference's.
void requireOther(const fs::path& second, const Layer& s, const fs::path& file,
                  const Layer& other) {
  const auto same = [](const std::vector<float>* x, const std::vector<float>* y) {
    return *x == *y;
  };
  if (std::ranges::equal(s.data, other.data, same)) {
    throw InputError(
        second,
        "holds the same pixels as " + file.string() +
            ", so that its noise tells nothing; render the reference again with another --seed");
  }
}

// The record of the stage that made the image; none if it has no history.
std::optional<StageRecord> lastRecord(const fs::path& file, const Image& image) {
  const std::vector<StageRecord> chain = parseProvenance(file, provenanceOf(image));
  return chain.empty() ? std::nullopt : std::optional(chain.back());
}

// Warns of images of different scenes or views, whose comparison is mostly a mistake.
void warnOfOtherScenes(const CompareRequest& command, const Sides& s) {
  const auto a = lastRecord(command.imageA, s.imageA), b = lastRecord(command.imageB, s.imageB);
  if (!a || !b) return;
  const auto sceneOf = [](const StageRecord& record) {
    const auto found = record.inputs.find("scene");
    return found == record.inputs.end() ? std::string() : found->second;
  };
  const std::string sceneA = sceneOf(*a), sceneB = sceneOf(*b);
  if (sceneA.empty() || sceneB.empty()) return;
  const std::string pair = command.imageA.string() + " and " + command.imageB.string();
  if (sceneA != sceneB) {
    printWarnings("vpl-inspect",
                  {pair + " show different scenes (content " + sceneA + " and " + sceneB + ")"});
  } else if (a->views != b->views) {
    printWarnings("vpl-inspect", {pair + " show different views of one scene"});
  }
}

void blacken(Image& image, size_t pixel) {
  for (ImageChannel& channel : image.channels)
    if (pixel < channel.data.size()) channel.data[pixel] = 0.0f;
}

// Crops count where all images have pixels. Elsewhere all are made black, as FLIP looks at what
// surrounds a pixel.
void leaveOutWhatCropsLack(const CompareRequest& command, Sides& s) {
  const PixelBox all{0, 0, s.imageB.width, s.imageB.height};
  PixelBox box = all;
  for (const Image* image : {&s.imageA, &s.imageB, s.halves ? &s.imageSecond : &s.imageB}) {
    const PixelBox window = dataWindowOf(*image);
    box = {std::max(box.x0, window.x0), std::max(box.y0, window.y0), std::min(box.x1, window.x1),
           std::min(box.y1, window.y1)};
  }
  if (box == all || s.imageA.width != s.imageB.width || s.imageA.height != s.imageB.height) return;
  std::vector<double>& weights = s.mask.weights;
  weights.resize(s.imageB.pixelCount(), 1.0);
  for (size_t i = 0; i < weights.size(); ++i) {
    const auto x = static_cast<int>(i % static_cast<size_t>(all.x1)),
               y = static_cast<int>(i / static_cast<size_t>(all.x1));
    if (x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1) continue;
    weights[i] = 0.0;
    for (Image* image : {&s.imageA, &s.imageB, &s.imageSecond, &s.imageMean}) blacken(*image, i);
  }
  if (s.mask.sum(weights.size()) == 0.0)
    throw InputError(command.imageA, "and " + command.imageB.string() +
                                         " have no pixel in common that counts; crop both alike");
}

void readSides(const CompareRequest& command, Sides& s) {
  s.imageA = readImage(command.imageA);
  s.imageB = readImage(command.imageB);
  s.a =
      findLayer(command.imageA, s.imageA, command.layerA.empty() ? command.layer : command.layerA);
  s.b =
      findLayer(command.imageB, s.imageB, command.layerB.empty() ? command.layer : command.layerB);
  s.reference = s.b;
  s.halves = !command.secondB.empty();
  if (s.halves) {
    s.imageSecond = readImage(command.secondB);
    s.second = findLayer(command.secondB, s.imageSecond, s.b.name);
    requireSameShape(command.secondB, s.second, command.imageB.string(), s.b);
    requireFinite(command.secondB, s.second);
    requireOther(command.secondB, s.second, command.imageB, s.b);
    requireOther(command.secondB, s.second, command.imageA, s.a);
    s.imageMean = meanOf(s.b, s.second);
    s.reference = findLayer(command.imageB, s.imageMean, s.b.name);
  }
  if (!command.mask.empty()) s.mask = readMask(command.mask, command.imageB, s.b);
  leaveOutWhatCropsLack(command, s);
}

ErrorMap errorMapOf(const CompareRequest& command, const Sides& s, double epsilon,
                    const std::optional<FlipMaps>& flip) {
  switch (command.map) {
    case MapKind::RelMse:
      return relMseMap(s.a, s.reference, epsilon);
    case MapKind::Flip:
      return flipMap(*flip);
    case MapKind::HdrFlip:
      return hdrFlipMap(*flip);
    default:
      return smapeMap(s.a, s.reference);
  }
}

Picture pictureOf(const CompareRequest& command, const Sides& s, double epsilon,
                  const std::optional<FlipMaps>& flip) {
  if (command.map == MapKind::Difference) {
    constexpr double kRange = 0.5;  // relative difference with the strongest colours
    return differencePicture(s.a, s.reference, command.diffRange.value_or(kRange), s.mask);
  }
  ErrorMap map = errorMapOf(command, s, epsilon, flip);
  map.largest = command.diffRange.value_or(map.largest);
  return errorPicture(map, s.b.width, s.b.height, s.mask);
}

void addReferenceOptions(CLI::App& sub, CompareRequest& c) {
  addFile(sub, "--second-half", c.secondB,
          "the reference with another seed, to remove the noise of B from RMSE and relMSE");
  addFile(sub, "--mask", c.mask,
          "PNG of the images' size with the weights of pixels: white 1, black 0");
  const auto addLayer = [&](const char* name, std::string& layer, const char* help) {
    sub.add_option(name, layer, help)->type_name("NAME");
  };
  addLayer("--layer", c.layer, "layer instead of R, G, B: direct, indirect, albedo, N, Z, ...");
  addLayer("--layer-a", c.layerA, "layer of A; overrides --layer");
  addLayer("--layer-b", c.layerB, "layer of B; overrides --layer");
}

void addLimitOptions(CLI::App& sub, CompareRequest& c) {
  constexpr double kMax = 1e300;
  addReal(sub, realOption("epsilon", "", 0, kMax, "", "epsilon of relMSE, in units of mean(B)^2"),
          c.limits.epsilon);
  addReal(sub, realOption("max-relmse", "", 0, kMax, "", "largest relMSE allowed"),
          c.limits.maxRelMse);
  addReal(sub, realOption("max-rmse", "", 0, kMax, "", "largest RMSE allowed"), c.limits.maxRmse);
  addReal(sub, realOption("max-rmse-over-mean", "", 0, kMax, "", "largest RMSE / mean(B) allowed"),
          c.limits.maxRmseOverMean);
}

void addFlipOptions(CLI::App& sub, CompareRequest& c) {
  char range[64] = "";
  std::snprintf(range, sizeof range, "%g:%g", (*c.flip.rangeEv)[0], (*c.flip.rangeEv)[1]);
  const auto given = [&c](const CLI::Option* option) { c.ofFlip.push_back(option); };
  given(sub.add_option("--exposure", c.exposure,
                       "exposure of FLIP, in stops; auto: maps the log-average of B to middle grey")
            ->type_name("EV|auto")
            ->default_str("auto"));
  given(sub.add_option("--flip-exposures", c.flipExposures,
                       "first and last exposure of HDR-FLIP, in stops; auto: from B, as in the "
                       "paper")
            ->type_name("START:STOP|auto")
            ->default_str(range));
  given(addReal(sub,
                realOption("ppd", "", 1, 1000, "", "pixels per degree of visual angle, for FLIP"),
                c.flip.ppd));
}

void addPictureOptions(CLI::App& sub, CompareRequest& c) {
  CLI::Option* diff = addFile(sub, "--diff", c.diff, "false-colour picture (.png) with a legend");
  addChoice(sub, "--map", c.map, kMaps,
            "measure to show; difference: (a-b) / (b + 0.1 mean(b)), blue darker, red brighter")
      ->needs(diff);
  addReal(sub,
          realOption("diff-range", "", 1e-6, 1e6, "",
                     "value at the end of the colour scale; for difference, 1 is 100 %"),
          c.diffRange)
      ->default_str("0.5 for difference, else 1")
      ->needs(diff);
}

// Throws UsageError for options of FLIP, which needs layers of R, G and B.
void requireNoFlip(const CompareRequest& command, const Sides& s) {
  const auto given = std::ranges::find_if(
      command.ofFlip, [](const CLI::Option* option) { return option->count() > 0; });
  const bool map = command.map == MapKind::Flip || command.map == MapKind::HdrFlip;
  if (given == command.ofFlip.end() && !map) return;
  throw UsageError((map ? "--map " + nameOf(command.map, kMaps) : (*given)->get_name()) +
                   " needs R, G, B, but layer '" + (s.b.isColour() ? s.a : s.b).name +
                   "' is none; " + (map ? "choose another map" : "leave it out"));
}

CLI::App* addCompareOptions(CLI::App& cli, CompareRequest& c) {
  CLI::App* sub = cli.add_subcommand(
      "compare",
      "Measure image A against the reference B over all pixels of R, G, B or one layer.\n"
      "relMSE is the mean of (a-b)^2 / (b^2 + e), e = epsilon * mean(b)^2.\n"
      "SMAPE is the mean of |a-b| / (|a| + |b|).\n"
      "FLIP and HDR-FLIP are Andersson et al. 2020 and 2021, of layers of R, G, B.\n"
      "Exits with 5 when a limit is exceeded.");
  addFile(*sub, "A", c.imageA, "image (.exr)")->required();
  addFile(*sub, "B", c.imageB, "reference (.exr)")->required();
  addReferenceOptions(*sub, c);
  addLimitOptions(*sub, c);
  addFlipOptions(*sub, c);
  addPictureOptions(*sub, c);
  sub->add_flag("--json", c.json, "print the measures as JSON");
  addExamples(*sub,
              {{"errors of an image", "vpl-inspect compare image.exr reference.exr"},
               {"a test of indirect light, by exit code",
                "vpl-inspect compare image.exr reference.exr --layer indirect --max-relmse 0.01"},
               {"a picture of the differences as people see them",
                "vpl-inspect compare image.exr reference.exr --diff flip.png --map flip"}});
  return sub;
}

int runCompare(const CompareRequest& command, const ToolOptions& tool) {
  Summary summary("vpl-inspect");
  FlipOptions flipOptions = command.flip;
  if (!command.exposure.empty()) flipOptions.exposureEv = parseExposure(command.exposure);
  if (!command.flipExposures.empty())
    flipOptions.rangeEv = parseExposureRange(command.flipExposures);
  RunFiles used;
  used.reads("A", command.imageA).reads("B", command.imageB);
  used.reads("--second-half", command.secondB).reads("--mask", command.mask);
  used.writes("--diff", command.diff, {OutputKind::Png}).writes(tool).ready();

  Sides s;
  readSides(command, s);
  warnOfOtherScenes(command, s);
  Comparison c = compareLayers(command.imageA, s.a, command.imageB, s.b, command.limits.epsilon,
                               s.halves ? &s.second : nullptr, s.mask);
  std::optional<FlipMaps> flip;
  if (s.b.isColour() && s.a.isColour()) {
    flip = flipMaps(rgbOf(s.reference), rgbOf(s.a), flipOptions);
    addFlip(*flip, s.mask, c);
  } else {
    requireNoFlip(command, s);
  }
  OutputSet files;
  if (!command.diff.empty()) {
    const Picture picture = pictureOf(command, s, c.epsilon, flip);
    writePng(files.add(command.diff), picture.width, picture.height, picture.rgb8);
  }
  const Json figures = comparisonJson(c, command.limits);
  summary.add("compare", figures);
  summary.save(tool, files);
  print(command.json ? jsonText(figures, 2) + "\n" : comparisonText(c, command.limits));
  return comparisonExitCode(c, command.limits);
}

}  // namespace

Command compareCommand(CLI::App& cli) {
  const auto request = std::make_shared<CompareRequest>();
  CLI::App* sub = addCompareOptions(cli, *request);
  return {sub, [request](const ToolOptions& options) { return runCompare(*request, options); }};
}

}  // namespace bnvpl
