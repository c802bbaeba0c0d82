#include "scene/textures/pfm.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace bnvpl {

namespace {

constexpr size_t kMaxPfmPixels = size_t{1} << 28;  // as of other images

// Removes a word of the header and the single blank behind it.
std::string_view takeWord(std::string_view& bytes) {
  const size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  const size_t end = std::min(bytes.find_first_of(" \t\r\n", begin), bytes.size());
  const std::string_view word = bytes.substr(begin, end - begin);
  bytes.remove_prefix(std::min(end + 1, bytes.size()));
  return word;
}

template <typename Number>
Number takeNumber(const fs::path& file, std::string_view& bytes, const char* what) {
  const std::string_view word = takeWord(bytes);
  Number number{};
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || stop != word.data() + word.size())
    throw InputError(file, std::string("is no PFM image: its header has no ") + what);
  return number;
}

}  // namespace

bool isPfm(std::string_view bytes) {
  return bytes.size() > 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
         (bytes[2] == '\n' || bytes[2] == '\r' || bytes[2] == ' ');
}

EnvironmentImage readPfm(const fs::path& file, std::string_view bytes) {
  const size_t channels = takeWord(bytes) == "PF" ? 3 : 1;
  EnvironmentImage image;
  image.width = takeNumber<uint32_t>(file, bytes, "width");
  image.height = takeNumber<uint32_t>(file, bytes, "height");
  const float scale = takeNumber<float>(file, bytes, "byte order");
  const bool crlf = bytes.starts_with('\n') && bytes.data()[-1] == '\r';
  if (!(std::fabs(scale) > 0.0f) || !std::isfinite(scale))
    throw InputError(file, "is no PFM image: the scale in its header tells no byte order");
  const size_t pixels = size_t{image.width} * image.height;
  // Some programs end the lines of the header with CR LF.
  if (crlf && bytes.size() == pixels * channels * sizeof(float) + 1) bytes.remove_prefix(1);
  if (pixels == 0 || pixels > kMaxPfmPixels || bytes.size() < pixels * channels * sizeof(float))
    throw InputError(file, "is no whole PFM image: pixels are missing; make it again");
  image.radiance.resize(pixels);
  const bool swap = (scale < 0.0f) != (std::endian::native == std::endian::little);
  for (size_t i = 0; i < pixels; ++i) {
    Vec3& pixel = image.radiance[(image.height - 1 - i / image.width) * image.width +
                                 i % image.width];  // rows are stored bottom-up
    for (size_t c = 0; c < 3; ++c) {
      std::array<char, sizeof(float)> raw;
      std::memcpy(raw.data(), bytes.data() + (i * channels + c % channels) * raw.size(),
                  raw.size());
      if (swap) std::reverse(raw.begin(), raw.end());
      pixel[c] = std::bit_cast<float>(raw) * std::fabs(scale);
    }
  }
  return image;
}

}  // namespace bnvpl
