// Writes PNG by libpng. An error of libpng jumps (longjmp) out of it to the setjmp() of the member
// that called it, which holds no object with a destructor.
#include "formats/image/png_io.h"

#include <png.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

namespace bnvpl {
namespace {

constexpr int kMaxPngSide = 1 << 16;
constexpr size_t kMaxPngMessage = 120;

class PngWriter {
 public:
  explicit PngWriter(const AtomicFile& file) : file_(file) {
    png_ = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, this, onError, onWarning, this,
                                     allocate, release);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (info_) return;
    png_destroy_write_struct(&png_, nullptr);
    throw std::bad_alloc();
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  std::string write(int width, int height, std::span<const uint8_t> values, int channels,
                    const std::string& provenance) {
    std::vector<const uint8_t*> rows(static_cast<size_t>(height));
    for (size_t y = 0; y < rows.size(); ++y)
      rows[y] = values.data() + y * static_cast<size_t>(width) * static_cast<size_t>(channels);
    std::string text = provenance;
    const bool written = writeAll(static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
                                  channels == 4, text.empty() ? nullptr : text.data(), rows.data());
    if (noMemory_) throw std::bad_alloc();
    if (!written) throw OutputError(file_.target(), std::string("PNG: ") + message_.data());
    return std::move(bytes_);
  }

 private:
  bool writeAll(png_uint_32 width, png_uint_32 height, bool alpha, char* provenance,
                const uint8_t** rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_write_fn(png_, this, append, nullptr);
    png_set_IHDR(png_, info_, width, height, 8, alpha ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_RELATIVE);
    char software[] = "Software", maker[] = "bnvpl " BNVPL_VERSION;
    std::array<png_text, 2> texts{};
    texts[0].compression = PNG_TEXT_COMPRESSION_NONE;
    texts[0].key = software;
    texts[0].text = maker;
    texts[1].compression = PNG_ITXT_COMPRESSION_zTXt;
    texts[1].key = const_cast<char*>(kPngProvenance);  // libpng copies it
    texts[1].text = provenance;
    png_set_text(png_, info_, texts.data(), provenance ? 2 : 1);
    png_write_info(png_, info_);
    png_write_image(png_, const_cast<png_bytepp>(rows));  // libpng only reads them
    png_write_end(png_, nullptr);
    return true;
  }

  static PngWriter& of(void* writer) { return *static_cast<PngWriter*>(writer); }
  static void onError(png_structp png, png_const_charp text) {
    std::snprintf(of(png_get_error_ptr(png)).message_.data(), kMaxPngMessage, "%s", text);
    png_longjmp(png, 1);
  }
  static void onWarning(png_structp, png_const_charp) {}
  // An exception must not pass through libpng.
  static void append(png_structp png, png_bytep bytes, size_t count) {
    PngWriter& writer = of(png_get_io_ptr(png));
    try {
      writer.bytes_.append(reinterpret_cast<const char*>(bytes), count);
    } catch (const std::bad_alloc&) {
      writer.noMemory_ = true;
    }
  }

  static png_voidp allocate(png_structp png, png_alloc_size_t bytes) {
    const png_voidp memory = std::malloc(bytes);
    if (!memory) of(png_get_mem_ptr(png)).noMemory_ = true;
    return memory;
  }
  static void release(png_structp, png_voidp memory) { std::free(memory); }

  const AtomicFile& file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::string bytes_;
  std::array<char, kMaxPngMessage> message_{};
  bool noMemory_ = false;
};

}  // namespace

void writePng(AtomicFile& file, int width, int height, std::span<const uint8_t> rgb8, int channels,
              const std::string& provenance) {
  if (width < 1 || height < 1 || width > kMaxPngSide || height > kMaxPngSide ||
      rgb8.size() != static_cast<size_t>(channels) * static_cast<size_t>(width) *
                         static_cast<size_t>(height)) {
    throw OutputError(file.target(), "a PNG of " + std::to_string(width) + " x " +
                                         std::to_string(height) + " pixels from " +
                                         std::to_string(rgb8.size()) + " bytes cannot be written");
  }
  file.write(PngWriter(file).write(width, height, rgb8, channels, provenance));
}

void writePng(const fs::path& file, int width, int height, std::span<const uint8_t> rgb8) {
  AtomicFile out(file);
  writePng(out, width, height, rgb8);
  out.commit();
}

}  // namespace bnvpl
