#include "scene/textures/exr_colours.h"

#include "formats/image/exr_io.h"

namespace bnvpl {

namespace {

struct Channels {
  const std::vector<float>*first, *second, *third;
  bool all() const { return first && second && third; }
  Xyz at(size_t i) const { return {(*first)[i], (*second)[i], (*third)[i]}; }
};

Channels find(const Image& image, const char* first, const char* second, const char* third) {
  return {image.find(first), image.find(second), image.find(third)};
}

Primaries primariesOf(const std::array<float, 8>& xy) {
  return {{xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}};
}

// Calls colour(i) for each pixel.
template <typename Colour>
void fill(EnvironmentImage& e, const Colour& colour) {
  e.radiance.resize(size_t{e.width} * e.height);
  for (size_t i = 0; i < e.radiance.size(); ++i) e.radiance[i] = colour(i);
}

// Luminance and chroma, RY = (R - Y) / Y and BY = (B - Y) / Y (OpenEXR, ImfRgbaYca.h).
void fillFromChroma(const Channels& c, EnvironmentImage& e) {
  const auto weights = xyzFromRgb(e.primaries.value_or(kRec709))[1];
  fill(e, [&](size_t i) {
    const auto [ry, y, by] = c.at(i);
    const double r = (ry + 1.0) * y, b = (by + 1.0) * y;
    return vec3Of({r, (y - weights[0] * r - weights[2] * b) / weights[1], b});
  });
}

}  // namespace

EnvironmentImage readExrColours(const fs::path& file, std::vector<float>* alpha) {
  const Image image = readExr(file);
  EnvironmentImage e;
  e.width = static_cast<uint32_t>(image.width);
  e.height = static_cast<uint32_t>(image.height);
  if (image.chromaticities) {
    const Primaries given = primariesOf(*image.chromaticities);
    if (!isRec709(given) && !rec709From(given))
      e.notes.push_back("its chromaticities are no primaries; those of Rec. 709 are used");
    else
      e.primaries = given;
  }
  const Channels rgb = find(image, "R", "G", "B"), xyz = find(image, "X", "Y", "Z"),
                 chroma = find(image, "RY", "Y", "BY");
  const std::vector<float>* grey = image.find("Y");
  const bool noRgb = !rgb.first && !rgb.second && !rgb.third;
  if (rgb.all()) {
    fill(e, [&](size_t i) { return vec3Of(rgb.at(i)); });
  } else if (noRgb && chroma.all()) {
    fillFromChroma(chroma, e);
  } else if (noRgb && xyz.all()) {
    const Matrix3 toRgb = inverseOf(xyzFromRgb(kRec709));
    fill(e, [&](size_t i) { return vec3Of(times(toRgb, xyz.at(i))); });
    e.primaries.reset();
  } else if (noRgb && grey && !chroma.first && !chroma.third) {
    fill(e, [&](size_t i) { return Vec3((*grey)[i]); });
    e.primaries.reset();
  } else {
    throw InputError(file, "has no R, G and B channels; supply a colour image");
  }
  if (const std::vector<float>* a = image.find("A"); a && alpha) *alpha = *a;
  if (image.parts > 1) {
    e.notes.push_back("has " + std::to_string(image.parts) +
                      " parts; the first is read; save another as a file of its own");
  }
  return e;
}

}  // namespace bnvpl
