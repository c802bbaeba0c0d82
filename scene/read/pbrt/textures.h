// Converts the textures of a pbrt file to expressions over images.
#pragma once

#include <set>

#include "scene/builder/scene_builder.h"
#include "scene/read/pbrt/colors/colors.h"

namespace bnvpl::pbrt {

class Textures {
 public:
  Textures(const Description& description, const fs::path& folder, const Colors& colors,
           Notes& notes, SceneBuilder& builder)
      : description_(description),
        folder_(folder),
        colors_(colors),
        notes_(notes),
        builder_(builder) {}

  // A material parameter, constant or texture. An unreadable texture is noted; the default replaces
  // it.
  Colour colour(const Params& params, const std::string& name, Vec3 otherwise);
  // A colour of any magnitude, such as a refractive index.
  Colour unboundedColour(const Params& params, const std::string& name, Vec3 otherwise);
  Scalar scalar(const Params& params, const std::string& name, float otherwise, float most = 1.0f);
  // The expression of a float texture that a parameter names; kNone without one.
  uint32_t floatTexture(const Params& params, const std::string& name);
  // A float texture as a mask, which takes the alpha channel of an image that has one. Nothing if
  // the texture is not simply an image.
  struct Mask {
    uint32_t image;  // into Scene::textures
    float cutoff;    // value of the mask from which the surface is there
  };
  std::optional<Mask> mask(const Params& params, const std::string& name);
  // An image over unmodified texture coordinates; kNone if the file does not exist, for which the
  // warning says `otherwise`.
  uint32_t image(const fs::path& file, bool srgb, Wrap wrap = Wrap::Repeat,
                 const char* otherwise = SceneBuilder::kPlainColour);

  void noteUnused() const;

 private:
  uint32_t named(const Param& p, bool isSpectrum);  // an expression, or kNone
  const TextureEntity* find(const Param& p, bool isSpectrum);
  uint32_t make(const TextureEntity& t);
  uint32_t operand(const TextureEntity& t, const std::string& name, float otherwise);
  uint32_t imagemap(const TextureEntity& t);
  std::optional<TextureUse> imageUse(const TextureEntity& t);
  UvTransform mapping(const TextureEntity& t);
  uint32_t constant(Vec3 value) { return builder_.addExpression(constantExpression(value)); }
  uint32_t constantOf(const Param& p, bool isSpectrum);

  const Description& description_;
  const fs::path& folder_;
  const Colors& colors_;
  Notes& notes_;
  SceneBuilder& builder_;
  std::map<const TextureEntity*, uint32_t> made_;
  std::set<const TextureEntity*> masks_;  // read as plain masks, which need no expression
  std::set<const TextureEntity*> making_;
};

}  // namespace bnvpl::pbrt
