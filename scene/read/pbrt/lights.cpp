#include "scene/read/pbrt/lights.h"

#include <cmath>
#include <numbers>

#include "core/files.h"
#include "scene/read/pbrt/octahedral.h"
#include "scene/read/pbrt/syntax/transform.h"

namespace bnvpl::pbrt {

namespace {

class Builder {
 public:
  Builder(const LightReader& r, const Light& light, SceneBuilder& builder)
      : r_(r), light_(light), p_(light.params), builder_(builder) {}

  void build() {
    if (light_.type == "point") {
      point();
    } else if (light_.type == "spot") {
      spot();
    } else if (light_.type == "distant") {
      distant();
    } else if (light_.type == "infinite") {
      infinite();
    } else if (light_.type == "goniometric") {
      goniometric();
    } else {
      r_.notes.add(light_.place, "light '" + light_.type + "' is not read; it is left out");
      for (const Param* p : p_.all()) p_.ignore({p->name.c_str()});
      return;
    }
    p_.ignore({"portal", "scale", "power", "illuminance"});
  }

 private:
  LightSpec named() const {
    LightSpec spec;
    spec.name = nameOf(light_, r_.folder);
    return spec;
  }
  double scale() const { return p_.number("scale", 1.0, 0.0); }
  // Factor that gives the light the `power` or `illuminance` of the file; 1 if the file has none.
  double aimedAt(const char* name, double has) const {
    const double wanted = p_.number(name, -1.0);
    return wanted > 0.0 && has > 0.0 ? wanted / has : 1.0;
  }
  Vec3 emission(const char* name, double factor) const {
    const Vec3 e = r_.sensor(r_.colors.light(p_, name, light_.colorSpace)) * float(factor);
    if (!isFinite(e)) failAt(light_.place, "the light is brighter than numbers reach");
    return e;
  }
  fs::path image() const {
    const std::string name = p_.text("filename");
    if (name.empty()) return {};
    const fs::path file = (r_.folder / name).lexically_normal();
    if (!isRegularFile(file))
      failAt(*p_.placeOf("filename"), "there is no image " + file.string() + "; check its name");
    return file;
  }
  EnvironmentImage squareImage(const fs::path& file) const {
    EnvironmentImage e = builder_.readEnvironment(file);
    if (e.width != e.height) {
      failAt(*p_.placeOf("filename"),
             file.string() + " is " + std::to_string(e.width) + " x " + std::to_string(e.height) +
                 " and no equal-area image, which is square; convert it by imgtool makeequiarea");
    }
    return e;
  }
  Vec3 unit(const FilePoint& v) const {
    const double length = std::hypot(v[0], v[1], v[2]);
    if (!(length > 0.0) || !std::isfinite(length))
      failAt(light_.place, "the light has no direction");
    return {float(v[0] / length), float(v[1] / length), float(v[2] / length)};
  }
  FilePoint from() const { return light_.worldFromLight.point(p_.point("from", {0, 0, 0})); }
  // World direction from `from` to `to`.
  Vec3 towards(const FilePoint& otherwise) const {
    const FilePoint a = p_.point("from", {0, 0, 0}), b = p_.point("to", otherwise);
    return unit(direction(light_.worldFromLight, {b[0] - a[0], b[1] - a[1], b[2] - a[2]}));
  }

  void point() {
    LightSpec spec = named();
    spec.emission = emission("I", scale() * aimedAt("power", 4.0 * std::numbers::pi));
    builder_.addLight(spec, from());
  }

  void spot() {
    const double cone = p_.number("coneangle", 30.0, 0.01, 180.0);
    const double delta = p_.number("conedeltaangle", 5.0, 0.0, 180.0);
    LightSpec spec = named();
    spec.type = LightType::Spot;
    spec.direction = towards({0, 0, 1});
    spec.coneRad = float(cone * std::numbers::pi / 180.0);
    spec.falloffRad = std::min(float(delta * std::numbers::pi / 180.0), spec.coneRad);
    const double outer = std::cos(cone * std::numbers::pi / 180.0),
                 inner = std::cos((cone - std::min(delta, cone)) * std::numbers::pi / 180.0);
    const double has = 2.0 * std::numbers::pi * ((1.0 - inner) + 0.5 * (inner - outer));
    spec.emission = emission("I", scale() * aimedAt("power", has));
    builder_.addLight(spec, from());
  }

  void distant() {
    LightSpec spec = named();
    spec.type = LightType::Directional;
    spec.direction = towards({0, 0, 1});
    spec.emission = emission("L", scale() * aimedAt("illuminance", 1.0));
    builder_.addLight(spec);
  }

  void infinite() {
    LightSpec spec = named();
    spec.type = LightType::Environment;
    const fs::path file = image();
    if (p_.has("portal")) {
      r_.notes.add(*p_.placeOf("portal"),
                   "the light's portal is not used; light from elsewhere counts too");
    }
    if (file.empty()) {
      spec.emission = emission("L", scale() * aimedAt("illuminance", std::numbers::pi));
    } else {
      if (p_.has("L")) failAt(*p_.placeOf("L"), "the light has an 'L' and an image; use one");
      const std::optional<Affine> lightFromWorld = inverse(light_.worldFromLight);
      if (!lightFromWorld) failAt(light_.place, "the light's transform has no inverse");
      const EnvironmentImage square = squareImage(file);
      EnvironmentImage image = latLongOf(square, *lightFromWorld);
      const double factor = scale() * aimedAt("illuminance", illuminanceOf(square));
      for (Vec3& v : image.radiance) {
        v = r_.sensor(v) * float(factor);
        if (!isFinite(v)) failAt(light_.place, "the light is brighter than numbers reach");
      }
      spec.image = builder_.addEnvironment(file, std::move(image));
    }
    builder_.addLight(spec);
  }

  // Illuminance of a surface that faces the light's +z, as pbrt computes it: half of the true one.
  static double illuminanceOf(const EnvironmentImage& square) {
    double sum = 0.0;
    for (size_t i = 0; i < square.radiance.size(); ++i) {
      // In the upper half of the sphere, |x| + |y| = sqrt(1 - z).
      const double x = std::fabs(2.0 * (double(i % square.width) + 0.5) / square.width - 1.0);
      const double y = std::fabs(2.0 * (double(i / square.width) + 0.5) / square.height - 1.0);
      const double z = 1.0 - (x + y) * (x + y);
      if (z > 0.0) sum += z * double{luminance(square.radiance[i])};
    }
    return 2.0 * std::numbers::pi * sum / double(square.radiance.size());
  }

  void goniometric() {
    double share = 1.0;
    const fs::path file = image();
    if (!file.empty()) {
      const EnvironmentImage square = squareImage(file);
      double sum = 0.0;
      for (const Vec3& v : square.radiance) sum += double{mean(v)};
      share = sum / double(square.radiance.size());
      builder_.addFile(file);
      r_.notes.add(light_.place,
                   "the goniometric light shines evenly to all sides, with the same power");
    }
    LightSpec spec = named();
    spec.emission =
        emission("I", scale() * share * aimedAt("power", 4.0 * std::numbers::pi * share));
    builder_.addLight(spec, from());
  }

  const LightReader& r_;
  const Light& light_;
  const Params& p_;
  SceneBuilder& builder_;
};

}  // namespace

void buildLights(const LightReader& reader, SceneBuilder& builder) {
  for (const Light& light : reader.description.lights) Builder(reader, light, builder).build();
}

ShapeEmission emissionOf(const LightReader& reader, const Entity& light, double areaM2,
                         size_t pieces) {
  if (light.type != "diffuse") {
    reader.notes.add(light.place, "area light '" + light.type + "' is not read; it is left out");
    return {};
  }
  const Params& p = light.params;
  ShapeEmission e;
  e.twoSided = p.boolean("twosided", false);
  double factor = p.number("scale", 1.0, 0.0);
  double has = areaM2 * std::numbers::pi * (e.twoSided ? 2.0 : 1.0);
  const std::string image = p.text("filename");
  if (!image.empty()) {
    if (p.has("L")) failAt(*p.placeOf("L"), "the light has an 'L' and an image; use one");
    e.image = (reader.folder / image).lexically_normal();
    if (p.has("power") && isRegularFile(e.image)) {
      double sum = 0.0;
      size_t negative = 0;
      const EnvironmentImage pixels = loadEnvironment(e.image, negative);
      for (const Vec3& v : pixels.radiance) sum += double{luminance(v)};
      has *= sum / double(pixels.radiance.size());
    }
  }
  const double power = p.number("power", -1.0);
  if (power > 0.0 && has > 0.0) factor *= power * double(pieces) / has;
  const Vec3 white = e.image.empty() ? reader.colors.light(p, "L", light.colorSpace) : Vec3{1.0f};
  e.radiance = reader.sensor(white) * float(factor);
  if (!isFinite(e.radiance)) failAt(light.place, "the light is brighter than numbers reach");
  return e;
}

}  // namespace bnvpl::pbrt
