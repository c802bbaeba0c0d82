#include "tools/inspect/contributions/contributions_json.h"

#include <array>
#include <charconv>
#include <cmath>

#include "core/hash.h"

namespace bnvpl {
namespace {

// Four significant digits, as much as half precision holds; more would double the file.
double rounded(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, 3)
          .ptr;
  std::from_chars(text.data(), end, value);
  return value;
}

Json rowsJson(const std::vector<RowInView>& rows, const std::vector<double>& radiance) {
  Json x = Json::array(), y = Json::array(), inSight = Json::array(), light = Json::array();
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto& [film, sight, onFilm] = rows[i];
    x.push_back(onFilm ? Json(rounded(double{film.x})) : Json());
    y.push_back(onFilm ? Json(rounded(double{film.y})) : Json());
    inSight.push_back(sight == RowSight::InSight || sight == RowSight::BackInSight);
    light.push_back(rounded(radiance[i]));
  }
  return {{"x", x}, {"y", y}, {"in_sight", inSight}, {"radiance", light}};
}

Json pixelsJson(const std::vector<PixelContributions>& pixels) {
  Json radiance = Json::array(), rows = Json::array(), shares = Json::array();
  for (const PixelContributions& pixel : pixels) {
    radiance.push_back(rounded(double{pixel.radiance}));
    rows.push_back(pixel.rows);
    Json& own = shares.emplace_back(Json::array());
    for (const float share : pixel.shares) own.push_back(rounded(double{share}));
  }
  return {{"radiance", radiance}, {"rows", rows}, {"shares", shares}};
}

}  // namespace

Json contributionsJson(const Contributions& found, const VplTable& lit,
                       const std::vector<RowInView>& rows, float clamp) {
  return {{"format", "bnvpl.contributions"},
          {"version", 1},
          {"scene", hashText(lit.sceneHash)},
          {"clamp_r_max", clamp},
          {"width", found.film.width},
          {"height", found.film.height},
          {"rows", rowsJson(rows, found.radiance)},
          {"pixels", pixelsJson(found.pixels)}};
}

}  // namespace bnvpl
