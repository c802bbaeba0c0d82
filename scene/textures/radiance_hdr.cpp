#include "scene/textures/radiance_hdr.h"

#include <charconv>
#include <cmath>
#include <sstream>

namespace bnvpl {
namespace {

constexpr uint32_t kMaxSide = 32767;               // limit of run-length encoded rows
constexpr uint32_t kMinRunSide = 8;                // narrower rows are always flat
constexpr size_t kMaxHdrPixels = size_t{1} << 28;  // as of other images

using Rgbe = std::array<uint8_t, 4>;

class Reader {
 public:
  Reader(const fs::path& file, std::string_view bytes) : file_(file), left_(bytes) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_, "no whole Radiance image: " + problem + "; make it again");
  }
  std::string_view line() {
    const size_t end = left_.find('\n');
    if (end == std::string_view::npos) fail("the header does not end");
    const std::string_view line = left_.substr(0, end);
    left_.remove_prefix(end + 1);
    return line;
  }
  uint8_t byte() {
    if (left_.empty()) fail("rows are missing");
    const auto value = static_cast<uint8_t>(left_.front());
    left_.remove_prefix(1);
    return value;
  }
  Rgbe pixel() { return {byte(), byte(), byte(), byte()}; }
  // Whether the next row is run-length encoded and has `width` pixels.
  bool runsAhead(uint32_t width) const {
    const auto at = [&](size_t i) { return static_cast<uint8_t>(left_[i]); };
    return left_.size() >= 4 && at(0) == 2 && at(1) == 2 && (at(2) << 8 | at(3)) == int(width);
  }

 private:
  const fs::path& file_;
  std::string_view left_;
};

Vec3 radianceOf(Rgbe p) {
  if (p[3] == 0) return {};
  const float scale = std::ldexp(1.0f, p[3] - (128 + 8));
  return scale * Vec3{float(p[0]), float(p[1]), float(p[2])};
}

// Parses a PRIMARIES line: x and y of red, green, blue and white. Some programs write zeros.
void readPrimaries(std::string_view line, EnvironmentImage& image) {
  std::istringstream numbers{std::string(line.substr(line.find('=') + 1))};
  Primaries p;
  for (auto* xy : {&p.red, &p.green, &p.blue, &p.white}) numbers >> (*xy)[0] >> (*xy)[1];
  if (numbers && (isRec709(p) || rec709From(p)))
    image.primaries = p;
  else
    image.notes.push_back("its header's PRIMARIES are none; those of Rec. 709 are used");
}

// Parses the header. Returns the factor that its EXPOSURE and COLORCORR lines have multiplied the
// pixels by; each line adds to those before (Radiance's documentation of its file formats).
Vec3 readHeader(Reader& in, EnvironmentImage& image) {
  bool rgbe = false;
  Vec3 factor{1.0f};
  for (std::string_view line = in.line(); !line.empty(); line = in.line()) {
    rgbe = rgbe || line == "FORMAT=32-bit_rle_rgbe";
    if (line.starts_with("PRIMARIES=")) readPrimaries(line, image);
    const bool exposure = line.starts_with("EXPOSURE="),
               perChannel = line.starts_with("COLORCORR=");
    if (!exposure && !perChannel) continue;
    std::istringstream numbers{std::string(line.substr(line.find('=') + 1))};
    Vec3 one;
    numbers >> one[0];
    if (perChannel) numbers >> one[1] >> one[2];
    if (exposure) one = Vec3{one[0]};
    for (size_t c = 0; c < 3; ++c) {
      factor[c] *= one[c];
      if (!numbers || !(factor[c] > 0.0f) || !std::isfinite(1.0f / factor[c]))
        in.fail("its header says '" + std::string(line.substr(0, 64)) + "'");
    }
  }
  if (!rgbe) in.fail("its format is not 32-bit_rle_rgbe");
  return factor;
}

void readRuns(Reader& in, std::vector<Rgbe>& row) {
  in.pixel();  // marks a run-length encoded row
  for (size_t channel = 0; channel < 4; ++channel) {
    for (size_t x = 0; x < row.size();) {
      const size_t code = in.byte(), count = code > 128 ? code - 128 : code;
      if (count == 0 || count > row.size() - x) in.fail("a run does not fit its row");
      const uint8_t value = code > 128 ? in.byte() : uint8_t{0};
      for (size_t i = 0; i < count; ++i) row[x++][channel] = code > 128 ? value : in.byte();
    }
  }
}

// Parses the number behind `key`, such as "+X ".
uint32_t side(Reader& in, std::string_view& text, std::string_view key) {
  uint32_t value = 0;
  if (!text.starts_with(key)) in.fail("its size is not -Y height +X width");
  text.remove_prefix(key.size());
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || value < 1 || value > kMaxSide) in.fail("its size is out of range");
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return value;
}

}  // namespace

bool isRadianceHdr(std::string_view bytes) {
  return bytes.starts_with("#?RADIANCE\n") || bytes.starts_with("#?RGBE\n");
}

EnvironmentImage readRadianceHdr(const fs::path& file, std::string_view bytes) {
  Reader in(file, bytes);
  EnvironmentImage image;
  const Vec3 factor = readHeader(in, image),
             scale{1.0f / factor.x, 1.0f / factor.y, 1.0f / factor.z};
  std::string_view size = in.line();
  image.height = side(in, size, "-Y ");
  image.width = side(in, size, " +X ");
  if (size_t{image.width} * image.height > kMaxHdrPixels) in.fail("its size is out of range");

  std::vector<Rgbe> row(image.width);
  for (uint32_t y = 0; y < image.height; ++y) {  // memory grows only with the file's content
    if (image.width >= kMinRunSide && in.runsAhead(image.width)) {
      readRuns(in, row);
    } else {
      for (Rgbe& pixel : row) pixel = in.pixel();
    }
    for (const Rgbe pixel : row) image.radiance.push_back(radianceOf(pixel) * scale);
  }
  return image;
}

}  // namespace bnvpl
