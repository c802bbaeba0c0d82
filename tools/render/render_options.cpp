#include "tools/render/render_options.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/number_text.h"
#include "tools/render/compensate/compensate.h"
#include "tools/render/counter_layers.h"
#include "tools/render/gather/gather.h"
#include "tools/render/integrator/tile_options.h"
#include "tools/render/integrator/vpl_kind.h"
#include "tools/render/stage_options.h"

namespace bnvpl {

namespace {

std::span<const Option> stageOptions() {
  static const std::string layersHelp =
      "extra channels of the image, or all" + layerList() + counterList();
  static const std::array options = optionTable(
      kSppOption, kTimeOption, kTargetErrorOption, kPassesOption, kPassSppOption, kAdaptiveOption,
      kOnlyOption, kSeedOption, kFilterOption, kFilterRadiusOption,
      inTopic(Topic::Files, unrecorded(textOption(kLayersKey.name, "", "NAME,...", layersHelp))),
      kSizeOption, kTransparentOption, kCropOption, kForDenoiserOption, kPixelsOption,
      kExposureOption);
  return options;
}

ShownLight shownOf(const Values& options) {
  const std::string& name = options[kOnlyOption];
  return name == "direct"     ? ShownLight::Direct
         : name == "indirect" ? ShownLight::Indirect
                              : ShownLight::All;
}

PixelFilter filterOf(const Values& options) {
  const auto name = std::ranges::find(kFilterNames, options[kFilterOption]);
  const auto kind = static_cast<FilterKind>(name - kFilterNames.begin());
  if (options.has(kFilterRadiusOption)) return {kind, options.real32(kFilterRadiusOption)};
  return {kind, usualRadius(kind)};
}

bool byPasses(const Values& options) {
  return options.has(kTimeOption) || options.has(kTargetErrorOption) || options.has(kPassesOption);
}

// The options that --for-denoiser stands for, spelled out.
Given withDenoiserOptions(const Given& given) {
  const Values options = resolve(renderSpec(), given);
  if (!options[kForDenoiserOption]) return given;
  if (const GatherMethod* gather = gatherOf(options); gather && gather->correlatesPixels()) {
    throw UsageError("--for-denoiser: --gather " + options[kGatherSlot] +
                     " gives neighbouring pixels the same noise; choose another gather");
  }
  const CompensateMethod* compensate = compensationOf(options);
  if (compensate && compensate->correlatesPixels) {
    throw UsageError("--for-denoiser: --compensate " + options[kCompensateSlot] +
                     " shares light between neighbouring pixels; choose another compensation");
  }
  Given all = given;
  if (options.has(kReuseKey)) {
    if (textGiven(given, kReuseKey.name) && options[kReuseKey] != 1) {
      throw UsageError("--for-denoiser: --reuse " + std::to_string(options[kReuseKey]) +
                       " gives neighbouring pixels the same noise; leave one of them out");
    }
    all.emplace_back(kReuseKey.name, "1");
  }
  const std::string& layers = options[kLayersKey];
  all.emplace_back(kLayersKey.name,
                   layers + (layers.empty() ? "" : ",") + "denoise_albedo,denoise_normal");
  return all;
}

// The options with `--control none` where the gather finds sums of pixels, which have no single
// samples to correct. Throws UsageError where another one is given.
Given withPixelSumOptions(const Given& given) {
  const Values options = resolve(renderSpec(), given);
  if (!gathersPixelSums(options) || !options.has(kControlKey)) return given;
  if (const std::string* control = textGiven(given, kControlKey.name);
      control && *control != "none")
    throw UsageError("--control " + *control + " needs the light of each sample, and --gather " +
                     options[kGatherSlot] + " finds the sum of a pixel's; leave one of them out");
  Given all = given;
  all.emplace_back(kControlKey.name, "none");
  return all;
}

// The names of the integrators that gather VPLs, joined by '|'.
std::string gatheringIntegrators() {
  std::string names;
  for (const IntegratorMethod* m : integratorMethods()) {
    if (m->gathersVpls) names += (names.empty() ? "" : "|") + std::string(m->name);
  }
  return names;
}

}  // namespace

const StageSpec& renderSpec() {
  // Near-field rays also have a part in direct light where each sample is lit itself.
  static const std::string integrators = gatheringIntegrators();
  static const Condition vpls{"integrator", integrators};
  static const AllOf indirect{vpls, kIndirectIsShown},
      sampleLit{vpls, valueIs(kDirectSamplesOption, "1")};
  static const StageSpec spec{
      "vpl-render",
      stageOptions(),
      {{"integrator", "vpl", "what finds the light", entriesOf(integratorMethods())},
       {"gather", "tilecuts", "how VPLs are gathered", entriesOf(gatherMethods()), {indirect}},
       {"compensate",
        "near-field",
        "what adds the light that clamping removes and that no VPL carries",
        entriesOf(compensateMethods()),
        {indirect, sampleLit},
        Topic::Expert}},
      {{"an image of the scene, and a picture to look at",
        "vpl-render scenes/cornell/scene.toml lit.vpl -o image.exr --png image.png"},
       {"a small preview within ten seconds",
        "vpl-render scene.toml lit.vpl -o preview.exr --size 320x240 --time 10s"},
       {"a reference by path tracing, without VPLs",
        "vpl-render scene.toml -o reference.exr --integrator path --spp 1024"}}};
  return spec;
}

Values resolveRender(const Given& given) {
  Values options = resolve(renderSpec(), withPixelSumOptions(withDenoiserOptions(given)));
  const bool limited = textGiven(given, kSppOption.name) != nullptr;
  if (byPasses(options) && !limited) options.set(kSppOption, static_cast<uint64_t>(kUnlimitedSpp));
  budgetOf(options);  // its errors belong to the command line
  requireKindCompensated(options);
  return options;
}

Given withFilterOf(const Film& film, Given given) {
  const auto isGiven = [&](const Option& option) {
    return textGiven(given, option.name) != nullptr;
  };
  if (film.filter == FilterSpec{} || isGiven(kFilterOption)) return given;
  given.emplace_back(kFilterOption.name, nameOf(film.filter.kind));
  if (!isGiven(kFilterRadiusOption) && film.filter.radius != usualRadius(film.filter.kind))
    given.emplace_back(kFilterRadiusOption.name, shortestText(film.filter.radius));
  return given;
}

uint64_t passSppOf(const Values& options) {
  return options.has(kPassSppOption) ? options[kPassSppOption] : uint64_t{kPassSpp};
}

std::optional<PassBudget> budgetOf(const Values& options) {
  if (!byPasses(options)) return {};
  const bool time = options.has(kTimeOption);
  PassBudget budget;
  if (time) budget.timeS = options[kTimeOption];
  if (options.has(kTargetErrorOption)) budget.error = options[kTargetErrorOption];
  budget.spp = options[kSppOption];
  if (budget.spp == static_cast<uint64_t>(kUnlimitedSpp)) budget.spp = UINT64_MAX;
  const uint64_t passSpp = passSppOf(options);
  if (budget.spp < kMinPasses * passSpp) {
    throw UsageError("--spp: with --time, --target-error or --passes it is at least " +
                     std::to_string(kMinPasses * passSpp) + ", for " + std::to_string(kMinPasses) +
                     " passes of " + std::to_string(passSpp));
  }
  const bool byTrial = time && !options.has(kPassSppOption);
  budget.passSpp = byTrial ? 0 : static_cast<uint32_t>(passSpp);
  if (options.has(kPassesOption)) budget.passes = options[kPassesOption];
  budget.adaptive = options[kAdaptiveOption];
  return budget;
}

Values preparingOptions(Values options) {
  if (budgetOf(options)) options.set(kSppOption, static_cast<uint64_t>(kUnlimitedSpp));
  return options;
}

const IntegratorMethod& integratorOf(const Values& options) {
  return methodNamed(integratorMethods(), options[kIntegratorSlot]);
}

std::vector<const Layer*> layersOf(const Values& options) {
  requireOwnCounters(options[kLayersKey], counterLayersOf(options));
  return parseLayers(options[kLayersKey],
                     integratorOf(options).gathersVpls && shownOf(options) != ShownLight::Direct,
                     budgetOf(options).has_value(), options[kOnlyOption], counterLayersOf(options));
}

std::vector<std::string> lightGroupsOf(const Values& options, const Scene& scene) {
  const bool wanted = std::ranges::any_of(layersOf(options), &Layer::ofGroups);
  if (!wanted) return {};
  if (const GatherMethod* gather = gatherOf(options); gather && !gather->lightGroups) {
    throw UsageError("--layers light_groups: --gather " + std::string(gather->name) +
                     " does not tell light groups apart; use --gather tilecuts");
  }
  if (scene.lightGroupCount() > 0) return scene.lightGroups;
  throw InputError(scene.name() +
                   ": --layers light_groups: no light has a group; add group = \"NAME\" to a "
                   "[[light]] of a scene.toml");
}

PixelBox parseCrop(const std::string& text) {
  PixelBox box;
  char rest = 0;
  const bool digits = text.find_first_not_of("0123456789,") == std::string::npos;
  if (!digits || text.size() > 24 ||
      std::sscanf(text.c_str(), "%9d,%9d,%9d,%9d%c", &box.x0, &box.y0, &box.x1, &box.y1, &rest) !=
          4 ||
      box.x0 >= box.x1 || box.y0 >= box.y1) {
    throw UsageError("--crop '" + text +
                     "' is not X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, such as 0,0,320,240");
  }
  return box;
}

std::optional<PixelBox> cropOf(const Values& options, const Film& film) {
  if (!options.has(kCropOption)) return {};
  const std::string& text = options[kCropOption];
  const PixelBox box = parseCrop(text);
  if (box.x1 > static_cast<int>(film.width) || box.y1 > static_cast<int>(film.height)) {
    throw UsageError("--crop '" + text + "' is larger than the film, whose size is " +
                     std::to_string(film.width) + "x" + std::to_string(film.height) +
                     "; name pixels of the film");
  }
  return box;
}

FilmOptions filmOptionsOf(const Values& options) {
  return {.spp = static_cast<uint32_t>(options[kSppOption]),
          .seed = options[kSeedOption],
          .shown = shownOf(options),
          .layers = layersOf(options),
          .redistributeFireflies = redistributesFireflies(options),
          .filter = filterOf(options),
          .gatherFilter = gatherFilterOf(options)};
}

bool sendsPhotons(const Values& options) {
  return integratorOf(options).splatsPhotons && shownOf(options) != ShownLight::Direct;
}

}  // namespace bnvpl
