// Every model describes all of its parameters, and has a nearest material of MTL.
#include "transport/bsdf/model_report.h"

#include <set>

#include "scene/visit_material.h"
#include "tests/transport/plain_scene.h"

namespace bnvpl {
namespace {

// Calls fn with a model of each kind, whose parameters have the textures 0, 1, ..., and how many.
template <size_t N = 0, typename Fn>
void forEachModel(bool switches, const Fn& fn) {
  std::variant_alternative_t<N, MaterialModel> model;
  uint32_t textures = 0;
  forEachField(model, [&]<typename Field>(const char*, Field& field) {
    if constexpr (Like<Field, Colour>) field = {Vec3(0.5f), textures++};
    if constexpr (Like<Field, Scalar>) field = {0.5f, textures++};
    if constexpr (Like<Field, bool>) field = switches;
    if constexpr (Like<Field, uint32_t>) field = 0;
  });
  fn(MaterialModel(model), textures);
  if constexpr (N + 1 < std::variant_size_v<MaterialModel>) forEachModel<N + 1>(switches, fn);
}

TEST(ModelReport, NamesEveryParameterOfEveryModel) {
  Scene scene = sceneOf(lambert(Vec3(0.5f)));
  std::map<size_t, std::set<uint32_t>> shown;
  std::map<std::string, size_t> names;
  for (const bool switches : {false, true}) {
    forEachModel(switches, [&](const MaterialModel& model, uint32_t) {
      const ModelReport report = describeModel(scene, model);
      EXPECT_FALSE(report.parameters.empty()) << report.model;
      EXPECT_EQ(names.emplace(report.model, model.index()).first->second, model.index());
      for (const auto& [name, parameter] : report.parameters) {
        EXPECT_FALSE(name.empty()) << report.model;
        if (const auto* c = std::get_if<Colour>(&parameter))
          shown[model.index()].insert(c->texture);
        if (const auto* s = std::get_if<Scalar>(&parameter))
          shown[model.index()].insert(s->texture);
      }
    });
  }
  forEachModel(false, [&](const MaterialModel& model, uint32_t textures) {
    for (uint32_t t = 0; t < textures; ++t)
      EXPECT_TRUE(shown[model.index()].contains(t)) << model.index() << " parameter " << t;
  });
}

TEST(ModelReport, MtlHasAReflectanceForEveryModel) {
  Scene scene = sceneOf(lambert(Vec3(0.5f)));
  scene.expressions.resize(16);
  forEachModel(false, [&](const MaterialModel& model, uint32_t) {
    const MtlModel mtl = modelToMtl(scene, model);
    EXPECT_EQ(mtl.exact, std::holds_alternative<PhongModel>(model));
    if (mtl.exact) return;
    const PhongModel& p = mtl.phong;
    const float most = maxComponent(p.glass ? p.transmission : p.diffuse + p.glossy + p.mirror);
    EXPECT_GT(most, 0.0f) << model.index();
    EXPECT_LE(most, 1.0f) << model.index();
  });
}

// Phong's exponent is 2 / alpha^2 - 2, whichever of the mappings leads from roughness to alpha.
TEST(ModelReport, MtlHasTheExponentOfTheMetalsAlpha) {
  const Scene scene = sceneOf(lambert(Vec3(0.5f)));
  using Alpha = Roughness::Alpha;
  for (const auto& [mapping, roughness] :
       {std::pair{Alpha::Same, 0.25f}, {Alpha::Square, 0.5f}, {Alpha::Root, 0.0625f}}) {
    ConductorModel metal;
    metal.roughness = Roughness(roughness, mapping);
    EXPECT_NEAR(modelToMtl(scene, metal).phong.exponent, 30.0f, 1e-4f) << roughness;
    CoatedConductorModel coated;
    coated.roughness = Roughness(roughness, mapping);
    EXPECT_NEAR(modelToMtl(scene, coated).phong.exponent, 30.0f, 1e-4f) << roughness;
  }
}

}  // namespace
}  // namespace bnvpl
