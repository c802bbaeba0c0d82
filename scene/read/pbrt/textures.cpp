#include "scene/read/pbrt/textures.h"

#include <algorithm>

#include "core/files.h"
#include "formats/image/tonemap.h"

namespace bnvpl::pbrt {

namespace {

constexpr size_t kMaxTextureDepth = 64;  // textures of textures

float one(const Param& p, float most, Notes& notes) {
  if (p.numbers.size() != 1) failAt(p.place, "'" + p.name + "' must be one number or a texture");
  noteClamped(p, double{most}, notes);
  return std::clamp(float(p.numbers[0]), 0.0f, most);
}

// Whether an image of this name holds floats, whose values are linear.
bool holdsFloats(const fs::path& file) {
  const std::string extension = lowerExtension(file);
  return extension == ".exr" || extension == ".hdr" || extension == ".pfm";
}

}  // namespace

const TextureEntity* Textures::find(const Param& p, bool isSpectrum) {
  if (p.strings.size() != 1) failAt(p.place, "'" + p.name + "' must name one texture");
  const auto known =
      description_.textures.find((isSpectrum ? "spectrum " : "float ") + p.strings[0]);
  if (known != description_.textures.end()) return &known->second;
  notes_.add(p.place, std::string("there is no ") + (isSpectrum ? "spectrum" : "float") +
                          " texture '" + p.strings[0] + "'; '" + p.name + "' keeps its default");
  return nullptr;
}

uint32_t Textures::named(const Param& p, bool isSpectrum) {
  const TextureEntity* t = find(p, isSpectrum);
  if (!t) return kNone;
  const auto known = made_.find(t);
  if (known != made_.end()) return known->second;
  if (!making_.insert(t).second) failAt(p.place, "texture '" + p.strings[0] + "' contains itself");
  if (making_.size() > kMaxTextureDepth)
    failAt(p.place, "textures lie more than 64 deep in each other");
  const uint32_t expression = make(*t);
  making_.erase(t);
  made_[t] = expression;
  return expression;
}

Colour Textures::colour(const Params& params, const std::string& name, Vec3 otherwise) {
  const Param* p = params.find(name);
  if (!p) return otherwise;
  if (p->type != ParamType::Texture) return colors_.reflectance(*p);
  const uint32_t texture = named(*p, true);
  return texture == kNone ? Colour(otherwise) : Colour(Vec3{1.0f}, texture);
}

Colour Textures::unboundedColour(const Params& params, const std::string& name, Vec3 otherwise) {
  const Param* p = params.find(name);
  if (!p) return otherwise;
  if (p->type != ParamType::Texture) return colors_.unbounded(*p);
  const uint32_t texture = named(*p, true);
  return texture == kNone ? Colour(otherwise) : Colour(Vec3{1.0f}, texture);
}

Scalar Textures::scalar(const Params& params, const std::string& name, float otherwise,
                        float most) {
  const Param* p = params.find(name);
  if (!p) return otherwise;
  if (p->type != ParamType::Texture) return one(*p, most, notes_);
  const uint32_t texture = named(*p, false);
  return texture == kNone ? Scalar(otherwise) : Scalar(1.0f, texture);
}

uint32_t Textures::floatTexture(const Params& params, const std::string& name) {
  const Param* p = params.find(name);
  return p && p->type == ParamType::Texture ? named(*p, false) : kNone;
}

std::optional<Textures::Mask> Textures::mask(const Params& params, const std::string& name) {
  const Param* p = params.find(name);
  const TextureEntity* t = p ? find(*p, false) : nullptr;
  if (!t || t->type != "imagemap" || t->params.boolean("invert", false)) return std::nullopt;
  if (t->params.text("wrap", "repeat") != "repeat" || t->params.number("scale", 1.0) != 1.0)
    return std::nullopt;
  std::optional<TextureUse> use = imageUse(*t);
  if (!use) return std::nullopt;
  const UvTransform uv = mapping(*t);
  use->mask = true;
  use->scale = {uv.a, uv.e};
  use->offset = {uv.c, uv.f};
  masks_.insert(t);
  // pbrt decodes alpha as it does colours, and the mask holds it as in the file.
  const bool encoded = use->srgb && !holdsFloats(use->file);
  return Mask{builder_.addTexture(*use, {SceneBuilder::kNoHoles, t->place.text() + ": "}),
              encoded ? encodeSrgb(0.5f) : 0.5f};
}

uint32_t Textures::image(const fs::path& file, bool srgb, Wrap wrap, const char* otherwise) {
  TextureUse use;
  use.file = file;
  use.srgb = srgb;
  const uint32_t texture = builder_.addTexture(use, {otherwise});
  if (texture == kNone) return kNone;
  TextureExpression e = imageExpression(texture);
  e.wrapU = e.wrapV = wrap;
  return builder_.addExpression(e);
}

uint32_t Textures::constantOf(const Param& p, bool isSpectrum) {
  return constant(isSpectrum ? colors_.unbounded(p) : Vec3{one(p, 1e30f, notes_)});
}

uint32_t Textures::operand(const TextureEntity& t, const std::string& name, float otherwise) {
  const Param* p = t.params.find(name);
  if (!p) return constant(Vec3{otherwise});
  if (p->type != ParamType::Texture) return constantOf(*p, t.isSpectrum && name != "amount");
  // `scale` and `amount` name float textures, though a constant `scale` may be a colour.
  const bool isFloat = name == "amount" || (name == "scale" && t.isSpectrum);
  const uint32_t texture = named(*p, t.isSpectrum && !isFloat);
  return texture == kNone ? constant(Vec3{otherwise}) : texture;
}

uint32_t Textures::make(const TextureEntity& t) {
  if (t.type == "imagemap") return imagemap(t);
  if (t.type == "constant") return operand(t, "value", 1.0f);
  if (t.type == "scale") {
    const uint32_t first = operand(t, "tex", 1.0f);
    return builder_.addExpression(productExpression(first, operand(t, "scale", 1.0f)));
  }
  if (t.type == "mix" || t.type == "directionmix") {
    if (t.type == "directionmix") {
      notes_.add(t.place, "texture 'directionmix' mixes evenly in all directions");
      t.params.ignore({"dir"});
    }
    const uint32_t first = operand(t, "tex1", 0.0f), second = operand(t, "tex2", 1.0f);
    return builder_.addExpression(mixExpression(first, second, operand(t, "amount", 0.5f)));
  }
  if (t.type == "checkerboard") {
    if (t.params.integer("dimension", 2, 2, 3) == 3)
      notes_.add(t.place, "texture 'checkerboard' of 3 dimensions is taken as one of 2");
    const uint32_t first = operand(t, "tex1", 1.0f), second = operand(t, "tex2", 0.0f);
    return builder_.addExpression(checkerboardExpression(first, second, mapping(t)));
  }
  notes_.add(t.place, "texture '" + t.type + "' is not read; it is grey");
  for (const Param* p : t.params.all()) t.params.ignore({p->name.c_str()});
  return constant(Vec3{0.5f});
}

std::optional<TextureUse> Textures::imageUse(const TextureEntity& t) {
  const std::string name = t.params.text("filename");
  if (name.empty()) failAt(t.place, "the imagemap needs a \"string filename\"");
  TextureUse use;
  use.file = (folder_ / name).lexically_normal();
  const std::string encoding = t.params.text("encoding", "sRGB");
  // pbrt reads the encoding of PNGs alone; other images of 8 bits are sRGB.
  const bool others = !holdsFloats(use.file) && lowerExtension(use.file) != ".png";
  use.srgb = encoding != "linear" || others;
  if (encoding.starts_with("gamma") || (encoding == "linear" && others)) {
    notes_.add(*t.params.placeOf("encoding"),
               "the encoding '" + encoding + "' is taken as sRGB" +
                   (encoding == "linear" ? ", as in pbrt, which heeds it for PNG only" : ""));
  }
  t.params.ignore({"filter", "maxanisotropy"});
  return use;
}

uint32_t Textures::imagemap(const TextureEntity& t) {
  const std::optional<TextureUse> use = imageUse(t);
  TextureExpression e = imageExpression(kNone, t.isSpectrum ? Channel::Rgb : Channel::Mean);
  const std::string wrap = t.params.text("wrap", "repeat");
  if (wrap == "clamp" || wrap == "black") {
    e.wrapU = e.wrapV = wrap == "clamp" ? Wrap::Clamp : Wrap::Black;
  } else if (wrap != "repeat") {
    notes_.add(*t.params.placeOf("wrap"), "the wrap mode '" + wrap + "' is taken as repeat");
  }
  e.value = Vec3{float(t.params.number("scale", 1.0))};
  e.invert = t.params.boolean("invert", false);
  e.uv = mapping(t);
  return builder_.addFallbackImage(*use, e, !t.isSpectrum, t.place.text() + ": ");
}

UvTransform Textures::mapping(const TextureEntity& t) {
  const std::string kind = t.params.text("mapping", "uv");
  UvTransform uv;
  if (kind != "uv") {
    notes_.add(*t.params.placeOf("mapping"),
               "the mapping '" + kind + "' is taken as uv: texture coordinates of the shape");
    t.params.ignore({"v1", "v2", "udelta", "vdelta", "uscale", "vscale"});
    return uv;
  }
  constexpr double kMaxUv = 1e6;
  uv.a = float(t.params.number("uscale", 1.0, -kMaxUv, kMaxUv));
  uv.e = float(t.params.number("vscale", 1.0, -kMaxUv, kMaxUv));
  uv.c = float(t.params.number("udelta", 0.0, -kMaxUv, kMaxUv));
  uv.f = float(t.params.number("vdelta", 0.0, -kMaxUv, kMaxUv));
  return uv;
}

void Textures::noteUnused() const {
  std::set<const TextureEntity*> read = masks_;
  for (const auto& [texture, expression] : made_) read.insert(texture);
  for (const TextureEntity* texture : read) {
    for (const Param* p : texture->params.unused()) {
      notes_.add(p->place, "Texture \"" + texture->type + "\": parameter '" + p->name +
                               "' is unknown and ignored");
    }
  }
}

}  // namespace bnvpl::pbrt
