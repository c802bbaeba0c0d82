// The part of SceneBuilder that adds materials, textures and images.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/builder/scene_builder.h"
#include "scene/visit_material.h"

namespace bnvpl {

namespace {

// Maximum number of lookups of an expression. Shared operands can make it exponential in the number
// of expressions.
constexpr uint32_t kMaxLookups = 1000;

constexpr const char* kGrey = "it is grey";

bool hasTexture(const std::vector<Material>& materials, const Material& m) {
  bool any = false;
  const auto use = [&](uint32_t number) { any |= number != kNone; };
  forEachImage(m, use);
  forEachExpression(m, use);
  if (const auto* mix = std::get_if<MixModel>(&m.model)) {
    for (const uint32_t part : {mix->first, mix->second})
      any = any || (part != kNone && hasTexture(materials, materials[part]));
  }
  return any;
}

bool hasRelief(const Material& m) { return !m.relief.flat() || !m.coatRelief.flat(); }

}  // namespace

uint32_t SceneBuilder::addTexture(const TextureUse& use, const TextureNotice& notice) {
  if (!use.bytes) {
    addFile(use.file);
    if (!isRegularFile(use.file)) {
      if (missing_.insert(use.file).second) {
        warn(notice.where + use.file.string() + ": " + whyUnreadable(use.file, "texture") + "; " +
             notice.otherwise);
      }
      return kNone;
    }
  }
  const uint32_t number = textures_.add(use);
  if (number >= notices_.size()) notices_.resize(number + 1, notice);
  return number;
}

uint32_t SceneBuilder::addReplacement(Material material) {
  assert(!material.name.empty());
  const std::string name = material.name;
  if (replacements_.contains(name))
    return addMaterial(std::move(material));  // that of an outer file
  return replacements_[name] = addMaterial(std::move(material));
}

uint32_t SceneBuilder::addFallbackImage(const TextureUse& use, TextureExpression image,
                                        bool prefersAlpha, const std::string& where) {
  image.image = addTexture(use, {kGrey, where});
  if (image.image == kNone) return addExpression(constantExpression(Vec3{0.5f}));
  const uint32_t expression = addExpression(image);
  fallbackImages_.push_back({expression, prefersAlpha});
  return expression;
}

const Material* SceneBuilder::useReplacement(const std::string& name) {
  const auto it = replacements_.find(name);
  if (it == replacements_.end()) return nullptr;
  replaced_.insert(name);
  return &scene_.materials[it->second];
}

uint32_t SceneBuilder::addMaterial(Material material) {
  return useReplacement(material.name) ? replacements_.at(material.name)
                                       : addOwnMaterial(std::move(material));
}

uint32_t SceneBuilder::addOwnMaterial(Material material) {
  if (const auto it = emissions_.find(material.name); it != emissions_.end()) {
    lit_.insert(material.name);
    const Emission& emission = it->second;
    material.lightGroup = emission.group;
    if (emission.radiance) {
      material.emission = *emission.radiance;
      material.emissionTexture = kNone;
      material.twoSidedEmission = emission.twoSided;
    }
  }
  uint32_t parts = 1;
  uint32_t lobes = std::visit([](const auto& model) { return model.kLobes; }, material.model);
  if (const auto* mix = std::get_if<MixModel>(&material.model)) {
    for (const uint32_t part : {mix->first, mix->second}) {
      assert(part == kNone || part < scene_.materials.size());
      if (part == kNone) continue;
      parts += mixParts_[part];
      lobes += lobes_[part];
      if (hasRelief(scene_.materials[part]) && !hasRelief(material)) {
        warn(name() + ": mix '" + material.name + "' has no relief, as '" +
             scene_.materials[part].name + "' in it has; give the mix a relief of its own");
      }
    }
    if (parts > kMaxLookups) {
      warn(name() + ": material '" + material.name + "' mixes too many materials; it is grey");
      material.model = DiffuseModel{};
      parts = lobes = 1;
    } else if (lobes > kMaxLobes) {
      warn(name() + ": material '" + material.name + "' mixes up to " + std::to_string(lobes) +
           " lobes; where more than " + std::to_string(kMaxLobes) +
           " have weight, the last are black; mix fewer materials");
    }
  }
  if (including()) {  // heights grow with what they are of
    const auto size = static_cast<float>(std::cbrt(std::fabs(place_.determinant())));
    for (Relief* relief : {&material.relief, &material.coatRelief})
      if (relief->bumpMap != kNone && !relief->heightInTexels) relief->strength *= size;
  }
  mixParts_.push_back(parts);
  lobes_.push_back(lobes);
  scene_.materials.push_back(std::move(material));
  return static_cast<uint32_t>(scene_.materials.size() - 1);
}

uint32_t SceneBuilder::addExpression(const TextureExpression& expression) {
  uint32_t lookups = 1;
  for (const uint32_t operand : {expression.first, expression.second, expression.amount}) {
    assert(operand == kNone || operand < scene_.expressions.size());
    if (operand != kNone) lookups += lookups_[operand];
  }
  if (lookups > kMaxLookups) {
    warn(name() + ": a texture is made of more than " + std::to_string(kMaxLookups) +
         " textures; the plain material colour is used");
    return kNone;
  }
  scene_.expressions.push_back(expression);
  lookups_.push_back(lookups);
  return static_cast<uint32_t>(scene_.expressions.size() - 1);
}

std::optional<Vec3> SceneBuilder::constantValue(uint32_t expression) const {
  if (expression == kNone) return Vec3(1);
  const TextureExpression& e = scene_.expressions[expression];
  if (e.kind == TextureExpression::Kind::Checkerboard) return {};
  if (e.kind == TextureExpression::Kind::Image && e.image != kNone) return {};
  for (const uint32_t operand : {e.first, e.second, e.amount}) {
    if (operand != kNone && !constantValue(operand)) return {};
  }
  return TextureEvaluator(scene_.expressions, {}).at(expression, 0.0f, 0.0f);
}

bool SceneBuilder::lacksImage(uint32_t expression) const {
  if (expression == kNone) return false;
  const TextureExpression& e = scene_.expressions[expression];
  if (e.kind == TextureExpression::Kind::Image && e.image == kNone) return true;
  return lacksImage(e.first) || lacksImage(e.second) || lacksImage(e.amount);
}

uint32_t SceneBuilder::greyMaterial() {
  if (grey_ == kNone) {
    Material grey;
    grey.phong().diffuse = Vec3{0.5f};
    grey_ = addMaterial(std::move(grey));
  }
  return grey_;
}

EnvironmentImage SceneBuilder::readEnvironment(const fs::path& image) {
  const ReadGuard guard(image);
  size_t negative = 0;
  EnvironmentImage radiance = loadEnvironment(image, negative);
  guard.check();
  for (const std::string& note : radiance.notes) warn(image.string() + ": " + note);
  warnOfPixels(image.string(), negative, radiance.radiance.size(), radiance.damage);
  return radiance;
}

void SceneBuilder::warnOfPixels(const std::string& image, size_t negative, size_t pixels,
                                const std::string& damage) {
  if (!damage.empty())
    warn(image + ": is damaged: " + damage + "; some pixels may be wrong; supply the whole image");
  if (negative == 0) return;
  warn(image + ": " + std::to_string(negative) + " of " + std::to_string(pixels) +
       " pixels have negative values, which count as 0");
}

uint32_t SceneBuilder::addEnvironment(const fs::path& image, EnvironmentImage radiance) {
  scene_.environments.push_back(std::move(radiance));
  addFile(image);
  return static_cast<uint32_t>(scene_.environments.size() - 1);
}

// Replaces the pool's numbers in all maps by indices into Scene::textures.
void SceneBuilder::resolveTextures() {
  TexturePool::Result read = textures_.take();
  std::vector<bool> grey(read.indexOf.size(), false);
  for (const FallbackImage& g : fallbackImages_)
    grey[scene_.expressions[g.expression].image] = true;
  size_t next = 0;
  for (size_t i = 0; i < read.indexOf.size(); ++i) {
    if (read.indexOf[i] == TexturePool::kUnreadable)
      warn(notices_[i].where + read.problems.at(next++) + "; " +
           (grey[i] ? kGrey : notices_[i].otherwise));
  }
  scene_.textures = std::move(read.textures);
  for (const Texture& t : scene_.textures) {
    for (const std::string& note : t.notes) warn(t.name + ": " + note);
    warnOfPixels(t.name, t.negative, t.floats.size() / 4, t.damage);
  }
  static_assert(TexturePool::kUnreadable == kNone);
  const auto resolve = [&](uint32_t& map) {
    if (map != kNone) map = read.indexOf.at(map);
  };
  for (Material& m : scene_.materials) forEachImage(m, resolve);
  std::vector<bool> lost;  // expressions with an image that is missing or could not be read
  const auto isLost = [&](uint32_t operand) { return operand != kNone && lost[operand]; };
  for (TextureExpression& e : scene_.expressions) {
    resolve(e.image);
    lost.push_back((e.kind == TextureExpression::Kind::Image && e.image == kNone) ||
                   isLost(e.first) || isLost(e.second) || isLost(e.amount));
  }
  for (Material& m : scene_.materials) {
    if (m.emissionTexture == kNone || !lost[m.emissionTexture]) continue;
    // The plain colour would make a lamp of all that the image leaves dark.
    m.emission = {};
    m.emissionTexture = kNone;
    warn("material '" + m.name + "' does not shine, as the image of its emission cannot be read");
  }
  std::map<uint32_t, bool> hasAlpha;  // by image, as many textures may share one
  for (const FallbackImage& g : fallbackImages_) {
    TextureExpression& e = scene_.expressions[g.expression];
    if (e.image == kNone) {
      e = constantExpression(Vec3{0.5f});
    } else if (g.prefersAlpha) {
      const auto [known, isNew] = hasAlpha.emplace(e.image, false);
      if (isNew) known->second = scene_.textures[e.image].hasAlpha();
      if (known->second) e.channel = Channel::Alpha;
    }
  }
}

// Folds constant textures into the parameters, so that they also apply to faces without texture
// coordinates.
void SceneBuilder::foldConstants() {
  std::vector<std::optional<Vec3>> constants;
  for (uint32_t e = 0; e < scene_.expressions.size(); ++e) constants.push_back(constantValue(e));
  const auto take = [&](uint32_t& texture, const auto& fold) {
    if (texture == kNone || !constants[texture]) return;
    fold(*constants[texture]);
    texture = kNone;
  };
  const auto field = [&]<typename Field>(const char*, Field& f) {
    if constexpr (Like<Field, Colour>)
      take(f.texture, [&](Vec3 v) { f.value = f.value * v; });
    else if constexpr (Like<Field, Scalar>)
      take(f.texture, [&](Vec3 v) { f.value *= v.x; });
  };
  for (Material& m : scene_.materials) {
    std::visit([&](auto& model) { forEachField(model, field); }, m.model);
    take(m.emissionTexture, [&](Vec3 v) { m.emission = m.emission * v; });
    take(m.opacityTexture, [&](Vec3 v) { m.opacity *= v.x; });
    for (Relief* relief : {&m.relief, &m.coatRelief}) {
      take(relief->bumpMap, [](Vec3) {});
      if (lacksImage(relief->normalMap)) relief->normalMap = kNone;
    }
  }
}

void SceneBuilder::warnOfMissingUvs() {
  size_t next = 0;
  for (const Part& part : parts_) {
    std::vector<bool> warned(scene_.materials.size(), false);
    for (; next < part.endTriangle; ++next) {
      const Triangle& t = scene_.triangles[next];
      const Material& m = materialOf(t);
      if (warned[materialNumber(t)] || !hasTexture(scene_.materials, m)) continue;
      if (std::find(t.uv.begin(), t.uv.end(), kNone) == t.uv.end()) continue;
      warned[materialNumber(t)] = true;
      warn(part.file.string() + ": " +
           (m.name.empty() ? "its material" : "material '" + m.name + "'") +
           " has a texture but faces without texture coordinates; "
           "the plain material colour is used there");
    }
  }
}

}  // namespace bnvpl
