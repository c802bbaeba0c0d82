// The parameters of a directive: "float fov" [ 45 ] "rgb L" [ 1 2 3 ].
#pragma once

#include <array>
#include <initializer_list>
#include <memory>
#include <optional>
#include <vector>

#include "scene/affine.h"
#include "scene/read/pbrt/syntax/lexer.h"

namespace bnvpl::pbrt {

enum class ParamType {
  Integer,
  Float,
  Bool,
  String,
  Texture,
  Point2,
  Point3,
  Rgb,
  Blackbody,
  Spectrum,
  Unknown
};
enum class ColorSpace { Srgb, DciP3, Rec2020, Aces };

struct Param {
  ParamType type = ParamType::Unknown;
  std::string name;
  std::vector<double> numbers;       // finite, of magnitude up to kMax
  std::vector<std::string> strings;  // strings, names of textures and spectra, or true and false
  ColorSpace colorSpace = ColorSpace::Srgb;  // color space of an rgb
  Place place;
  mutable bool used = false;
};

// Largest magnitude of a number, so that floats hold results computed from it.
inline constexpr double kMax = 1e30;

// Values are looked up by name. A value of another type than requested, or out of range, throws
// InputError with its place. Parameters that were never looked up can be listed.
class Params {
 public:
  void add(Param param);  // replaces an earlier one of its name
  // Sets the parameters of Attribute, which apply if these have none of their name. Shapes that are
  // read in parallel share them, so they are not marked as used.
  void setFallback(std::shared_ptr<const Params> fallback) { fallback_ = std::move(fallback); }

  const Param* find(const std::string& name) const;  // marks it as used
  bool has(const std::string& name) const { return find(name) != nullptr; }
  // Finds a parameter, which must have one of the types; nullptr if none has that name.
  const Param* find(const std::string& name, std::initializer_list<ParamType> types,
                    const char* expected) const;

  double number(const std::string& name, double otherwise, double lower = -kMax,
                double upper = kMax) const;
  int64_t integer(const std::string& name, int64_t otherwise, int64_t lower, int64_t upper) const;
  bool boolean(const std::string& name, bool otherwise) const;
  std::string text(const std::string& name, const std::string& otherwise = "") const;
  FilePoint point(const std::string& name, const FilePoint& otherwise) const;
  // All numbers of a parameter, a multiple of `each`; empty without the parameter.
  const std::vector<double>& floats(const std::string& name, size_t each = 1) const;
  std::vector<uint32_t> indices(const std::string& name, size_t each, size_t below) const;
  const Place* placeOf(const std::string& name) const;

  void ignore(std::initializer_list<const char*> names) const;
  std::vector<const Param*> unused() const;
  std::vector<const Param*> all() const;  // without the fallback

 private:
  const Param* lookUp(const std::string& name) const;
  std::vector<Param> params_;
  std::shared_ptr<const Params> fallback_;
};

}  // namespace bnvpl::pbrt
