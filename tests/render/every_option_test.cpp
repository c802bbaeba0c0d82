// Every option of every method changes what the method computes.
#include "tests/render/lit_rooms.h"
#include "tests/support/gather_checks.h"
#include "tools/render/compensate/compensate.h"
#include "tools/render/integrator/integrator_method.h"

namespace bnvpl::test {
namespace {

// Values other than the defaults. Methods that have an option of the same name share its value.
const std::map<std::string_view, const char*> kOtherNumbers{
    // placement and elimination
    {"depth", "4"},
    {"light-depth", "1"},
    {"uniform-share", "1"},
    {"area", "0.5"},
    {"neighbours", "3"},
    {"alpha", "1"},
    {"seed", "2"},
    {"camera-points", "7"},
    {"min-probability", "0.05"},
    // flux
    {"photons", "2k"},
    {"irradiance-error", "0.9"},
    {"paths", "1"},
    {"points", "3"},
    {"radius", "3"},
    {"max-bounces", "1"},
    {"emit-points", "2"},
    // integrators
    {"clamp", "0.1"},
    {"direct-samples", "1"},
    {"near-field-rays", "2"},
    {"reuse", "1"},
    {"caustic-photons", "4"},
    {"light-rays", "1"},
    {"guide-share", "0"},
    {"guide-rays", "8"},
    // gathers
    {"split", "0.2"},
    {"error", "0.7"},
    {"pair-rays", "0"},
    {"class-rays", "0"},
    {"cell-levels", "1"},
    {"cell-runs", "1"},
    {"max-cut", "3"},
    {"slices", "2"},
    {"columns", "7"},
    {"neighbour-slices", "1"},
    {"entry-share", "0.5"},
    {"rows", "5"},
    {"threshold", "0.1"},
    {"cells", "2"},
    {"dim-rays", "3"},
    {"cut", "3"},
    {"tolerance", "0.9"},
    {"visibility-tests", "1"},
    // compensation
    {"local-block", "2"},
    {"local-shooters", "3"},
    {"local-rays", "3"},
    {"local-radius", "2"},
};

// Options beside which others have an effect in small images.
const Given kFewSlices{{"slices", "6"}, {"columns", "200"}};
const std::map<std::string_view, Given> kBeside{
    {"light-rays", {{"only", "direct"}, {"direct-samples", "1"}}},
    {"neighbour-slices", {{"slices", "6"}, {"columns", "40"}}},
    {"entry-share", kFewSlices},
    {"completion", kFewSlices},
    {"visibility-tests", {{"tolerance", "0.9"}}},
};

// Empty if a number is missing above.
std::vector<std::string> otherValues(const Option& option) {
  if (option.kind == Option::Kind::Switch) return {option.defaultText == "on" ? "off" : "on"};
  if (option.kind != Option::Kind::Choice) {
    const auto number = kOtherNumbers.find(option.name);
    if (number == kOtherNumbers.end()) return {};
    return {number->second};
  }
  std::vector<std::string> values;
  for (const std::string_view choice : choicesIn(option.choices))
    if (choice != option.defaultText) values.emplace_back(choice);
  return values;
}

// `resultOf` computes what the method makes with the options that it is given.
template <typename ResultOf>
void expectEveryOptionCounts(std::span<const Option> options, ResultOf resultOf) {
  for (const Option& option : options) {
    const auto known = kBeside.find(option.name);
    const Given beside = known == kBeside.end() ? Given{} : known->second;
    const auto usual = resultOf(beside);
    EXPECT_TRUE(std::ranges::any_of(
        otherValues(option),
        [&](const std::string& value) {
          return resultOf(with(beside, {{std::string(option.name), value}})) != usual;
        }))
        << "--" << option.name << " has no effect, or a value is missing above";
  }
}

const GatherCase& box() { return *gatherCases().front(); }

TEST(EveryOption, OfPlacement) {
  for (const PlaceMethod* method : placeMethods()) {
    SCOPED_TRACE(method->name);
    expectEveryOptionCounts(method->options, [&](const Given& options) {
      const Given own{{"method", std::string(method->name)}, {"count", "100"}};
      return placeVpls(box().world, with(own, options)).table.position;
    });
  }
}

TEST(EveryOption, OfElimination) {
  const auto placed = [](const char* method) {
    return placeVpls(box().world, {{"method", method}, {"count", "2k"}}).table;
  };
  const VplTable candidates = placed("camera"), photons = placed("light");
  for (const EliminateMethod* method : eliminateMethods()) {
    SCOPED_TRACE(method->name);
    expectEveryOptionCounts(method->options, [&](const Given& options) {
      const Given own{{"method", std::string(method->name)}, {"count", "200"}};
      const Values values = resolve(eliminateSpec(), with(own, options));
      const VplTable kept =
          method->needsScene ? eliminate(photons, values, &box().world.accel, &box().world.lights)
                             : eliminate(candidates, values);
      return std::pair(kept.position, kept.radius);
    });
  }
}

TEST(EveryOption, OfEstimation) {
  const World world(manyLights());
  const VplTable vpls = keptVpls(world, {{"count", "50"}}, {{"count", "1k"}});
  for (const EstimateMethod* method : estimateMethods()) {
    SCOPED_TRACE(method->name);
    expectEveryOptionCounts(method->options, [&](const Given& options) {
      const Given own{{"method", std::string(method->name)}};
      const bool paths = method->name == "paths";  // it takes no photons
      const Given work = paths ? Given{} : Given{{"photons", "30k"}};
      const VplTable lit = lightVpls(world, vpls, with(with(own, work), options)).table;
      return std::pair(lit.flux, lit.emitPosition);
    });
  }
}

using Channel = std::vector<float>;

Channel greenOf(const World& world, const VplTable& lit, const Given& slots, const Given& options) {
  return *renderVpls(world, lit, with(with({{"spp", "2"}}, slots), options)).image.find("G");
}

// A mirror sends caustics and fireflies.
TEST(EveryOption, OfIntegrators) {
  Scene scene = room(32, 24);
  for (Material& m : scene.materials)
    if (m.name == "Green") m.phong().mirror = Vec3(0.8f);
  const World world(std::move(scene));
  const VplTable lit = litVpls(world, {{"count", "300"}}, {{"photons", "20k"}}, {{"count", "3k"}});
  for (const IntegratorMethod* method : integratorMethods()) {
    SCOPED_TRACE(method->name);
    const Given slots{{"integrator", std::string(method->name)}};
    expectEveryOptionCounts(
        method->options, [&](const Given& options) { return greenOf(world, lit, slots, options); });
  }
}

TEST(EveryOption, OfGathers) {
  for (const GatherMethod* method : gatherMethods()) {
    SCOPED_TRACE(method->name);
    const Given slots = with(kPlainRender, {{"only", "indirect"},
                                            {"near-field-rays", "1"},
                                            {"control", "none"},
                                            {"gather", std::string(method->name)}});
    expectEveryOptionCounts(method->options, [&](const Given& options) {
      return greenOf(box().world, box().lit, slots, options);
    });
  }
}

TEST(EveryOption, OfCompensations) {
  for (const CompensateMethod* method : compensateMethods()) {
    SCOPED_TRACE(method->name);
    const Given slots{{"compensate", std::string(method->name)}};
    expectEveryOptionCounts(method->options, [&](const Given& options) {
      return greenOf(box().world, box().lit, slots, options);
    });
  }
}

}  // namespace
}  // namespace bnvpl::test
