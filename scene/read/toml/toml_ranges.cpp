#include "scene/read/toml/toml_ranges.h"

#include <algorithm>
#include <string_view>

#include "core/number_text.h"
#include "scene/visit_material.h"

namespace bnvpl {

namespace {

struct Range {
  float least = 0.0f, most = 1.0f;
};

// The range of a model's parameter; nothing if all numbers have a meaning.
template <typename Model>
std::optional<Range> rangeOf(std::string_view key, float value) {
  if (key == "anisotropy_turns") return std::nullopt;
  if (key == "specular_colour") return Range{0.0f, static_cast<float>(TomlSection::kMaxMagnitude)};
  if (key == "eta" || key == "k" || key.ends_with("thickness")) return Range{0.0f, 100.0f};
  if (key == "coat_ior") return Range{1.0f, 100.0f};
  if (key != "ior") return Range{};
  if constexpr (std::same_as<Model, DielectricModel>) return Range{0.01f, 100.0f};
  // An index of 0 means total reflection there, and so do negative ones.
  if (std::same_as<Model, MetallicRoughnessModel> && value <= 0.0f) return Range{0.0f, 100.0f};
  return Range{1.0f, 100.0f};
}

void warnIfOutside(const TomlSection& s, const char* key, float value, Range range,
                   SceneBuilder& builder) {
  if (value >= range.least && value <= range.most) return;
  builder.warn(s.where(key) + "'" + key + "' is " + shortestText(value) + ", outside " +
               shortestText(range.least) + " to " + shortestText(range.most) + "; " +
               shortestText(std::clamp(value, range.least, range.most)) + " is used");
}

// The channel of a colour that lies farthest outside; it is the one that the warning names.
float farthest(Vec3 c, Range range) {
  const float least = std::min({c.x, c.y, c.z}), most = maxComponent(c);
  return most > range.most ? most : least;
}

}  // namespace

void warnOfClamped(const TomlSection& s, const Material& m, SceneBuilder& builder) {
  std::visit(
      [&]<typename Model>(const Model& model) {
        forEachField(model, [&]<typename Field>(const char* key, const Field& f) {
          if constexpr (kTextured<Field>) {
            if (!s.has(key) || f.texture != kNone) return;
            float value;
            if constexpr (std::same_as<Field, Colour>)
              value = farthest(f.value, rangeOf<Model>(key, 0.0f).value_or(Range{}));
            else
              value = f.value;
            if (const auto range = rangeOf<Model>(key, value))
              warnIfOutside(s, key, value, *range, builder);
          }
        });
      },
      m.model);
  if (const auto* sheet = std::get_if<DiffuseTransmissionModel>(&m.model)) {
    const Colour &r = sheet->reflectance, &t = sheet->transmittance;
    const char* key = s.has("reflectance") ? "reflectance" : "transmittance";
    const bool plain = r.texture == kNone && t.texture == kNone;
    constexpr float kRounding = 1e-6f;
    if (plain && s.has(key) && maxComponent(r.value + t.value) > 1.0f + kRounding) {
      builder.warn(s.where(key) +
                   "'reflectance' and 'transmittance' together exceed 1; both are scaled down");
    }
  }
  if (s.has("opacity") && m.opacityTexture == kNone)
    warnIfOutside(s, "opacity", m.opacity, {}, builder);
  if (m.opacityCutoff > 1.0f) {
    builder.warn(s.where("opacity_cutoff") + "'opacity_cutoff' is " +
                 shortestText(m.opacityCutoff) +
                 ", outside 0 to 1; no opacity reaches it, and the surface is not there");
  } else if (m.opacityCutoff < 0.0f) {
    builder.warn(s.where("opacity_cutoff") + "'opacity_cutoff' is " +
                 shortestText(m.opacityCutoff) + ", outside 0 to 1; 0 is used");
  }
}

}  // namespace bnvpl
