// Reads PNG by libpng. An error of libpng jumps (longjmp) out of it to the setjmp() of the member
// that called it; those members hold no object with a destructor.
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>

#include "formats/image/pixel_readers.h"

namespace bnvpl {
namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
constexpr size_t kMaxMessage = 120;

using Rgba = std::array<uint8_t, 4>;

class PngReader {
 public:
  explicit PngReader(std::string_view bytes) : left_(bytes) {
    png_ = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, this, onError, onWarning, this, allocate,
                                    release);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (info_) return;
    png_destroy_read_struct(&png_, nullptr, nullptr);
    throw std::bad_alloc();
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  Pixels read(bool rgba) {
    const size_t bytes = left_.size();
    if (!readHeader()) fail();
    const png_uint_32 width = png_get_image_width(png_, info_),
                      height = png_get_image_height(png_, info_);
    requirePlausible(width, height, bytes);
    const bool palette = png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE;
    const bool deep = png_get_bit_depth(png_, info_) == 16;
    if (!setFormat(palette, rgba)) fail();
    Pixels out{width, height, png_get_channels(png_, info_), {}, {}, deep};
    const size_t rowBytes = png_get_rowbytes(png_, info_);
    out.values.resize(height * rowBytes);
    std::vector<png_bytep> rows(height);
    for (size_t y = 0; y < height; ++y) rows[y] = out.values.data() + y * rowBytes;
    if (!readRows(rows.data())) fail();
    out.damage = message_.data();
    return palette ? coloured(out, rgba) : out;
  }

 private:
  bool readHeader() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, this, take);
    png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
    // Chunks that describe no pixels are not parsed; tRNS is none of them.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER,
                                reinterpret_cast<png_const_bytep>("sRGB"), 1);
    png_read_info(png_, info_);
    return true;
  }
  bool setFormat(bool palette, bool rgba) {
    if (setjmp(png_jmpbuf(png_))) return false;
    if (palette) {
      png_set_packing(png_);  // coloured() looks up the numbers
    } else {
      png_set_expand(png_);
      png_set_scale_16(png_);
      if (rgba) {
        png_set_gray_to_rgb(png_);
        png_set_add_alpha(png_, 0xff, PNG_FILLER_AFTER);
      }
    }
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  bool readRows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  // Replaces the numbers in a palette by its colours.
  Pixels coloured(const Pixels& numbers, bool rgba) const {
    png_colorp colours = nullptr;
    png_bytep alphas = nullptr;
    int count = 0, alphaCount = 0;
    png_get_PLTE(png_, info_, &colours, &count);
    const bool clear = png_get_tRNS(png_, info_, &alphas, &alphaCount, nullptr) != 0;
    std::array<Rgba, 256> table;
    table.fill({0, 0, 0, 255});
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
      const bool has = clear && i < static_cast<size_t>(alphaCount);
      table[i] = {colours[i].red, colours[i].green, colours[i].blue,
                  static_cast<uint8_t>(has ? alphas[i] : 255)};
    }
    Pixels out{numbers.width, numbers.height, rgba || clear ? 4u : 3u, {}, numbers.damage};
    out.values.reserve(numbers.values.size() * out.channels);
    uint8_t largest = 0;
    for (const uint8_t number : numbers.values) {
      largest = std::max(largest, number);
      const Rgba& colour = table[number];
      out.values.insert(out.values.end(), colour.begin(), colour.begin() + out.channels);
    }
    if (largest >= count && out.damage.empty())
      out.damage = "a pixel has colour " + std::to_string(largest) + " of a palette of " +
                   std::to_string(count);
    return out;
  }

  [[noreturn]] void fail() const {
    if (noMemory_) throw std::bad_alloc();
    throw PixelError(message_.data());
  }

  static PngReader& of(void* reader) { return *static_cast<PngReader*>(reader); }
  static void onError(png_structp png, png_const_charp text) {
    std::snprintf(of(png_get_error_ptr(png)).message_.data(), kMaxMessage, "%s", text);
    png_longjmp(png, 1);
  }
  static void onWarning(png_structp png, png_const_charp text) {
    PngReader& reader = of(png_get_error_ptr(png));
    if (reader.message_[0] == '\0') std::snprintf(reader.message_.data(), kMaxMessage, "%s", text);
  }
  static void take(png_structp png, png_bytep out, size_t count) {
    std::string_view& left = of(png_get_io_ptr(png)).left_;
    if (count > left.size()) png_error(png, "the file is cut short");
    std::memcpy(out, left.data(), count);
    left.remove_prefix(count);
  }
  static png_voidp allocate(png_structp png, png_alloc_size_t bytes) {
    const png_voidp memory = std::calloc(1, bytes);
    if (!memory) of(png_get_mem_ptr(png)).noMemory_ = true;
    return memory;
  }
  static void release(png_structp, png_voidp memory) { std::free(memory); }

  std::string_view left_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::array<char, kMaxMessage> message_{};  // the error, or the first warning
  bool noMemory_ = false;
};

}  // namespace

bool isPng(std::string_view bytes) { return bytes.starts_with(kSignature); }

Pixels readPng(std::string_view bytes, bool rgba) { return PngReader(bytes).read(rgba); }

}  // namespace bnvpl
