// Reads JPEG by libjpeg-turbo. An error of the library jumps (longjmp) out of it to the setjmp() of
// the member that called it; those members hold no object with a destructor.
#include <jerror.h>
#include <jpeglib.h>

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <new>

#include "formats/image/pixel_readers.h"

namespace bnvpl {
namespace {

constexpr int kMaxScans = 100;  // encoders make about 10; each decodes all blocks

// Ink over ink, from Adobe's inverted CMYK: x y / 255, rounded.
uint8_t times(unsigned x, unsigned y) {
  const unsigned product = x * y + 128;
  return static_cast<uint8_t>((product + (product >> 8)) >> 8);
}

class JpegReader {
 public:
  explicit JpegReader(std::string_view bytes) : bytes_(bytes) {
    jpeg_.err = jpeg_std_error(&errors_);
    jpeg_.client_data = this;
    errors_.error_exit = onError;
    errors_.emit_message = onMessage;
    progress_.progress_monitor = onProgress;
  }
  ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  Pixels read() {
    if (!readHeader()) fail();
    requirePlausible(jpeg_.image_width, jpeg_.image_height, bytes_.size());
    Pixels out{jpeg_.image_width, jpeg_.image_height, 4, {}, {}};
    out.values.resize(size_t{4} * out.width * out.height);
    if (!readRows(out.values.data())) fail();
    if (jpeg_.out_color_space == JCS_CMYK) {
      for (size_t i = 0; i < out.values.size(); i += 4) {
        uint8_t* p = &out.values[i];
        for (size_t c = 0; c < 3; ++c) p[c] = times(p[c], p[3]);
        p[3] = 255;
      }
    }
    out.damage = warning_.data();
    return out;
  }

 private:
  bool readHeader() {
    if (setjmp(back_)) return false;
    jpeg_create_decompress(&jpeg_);
    jpeg_.progress = &progress_;
    jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
    jpeg_read_header(&jpeg_, TRUE);
    return true;
  }
  bool readRows(uint8_t* values) {
    if (setjmp(back_)) return false;
    const bool cmyk = jpeg_.num_components == 4;
    jpeg_.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_start_decompress(&jpeg_);
    while (jpeg_.output_scanline < jpeg_.output_height) {
      JSAMPROW row = values + size_t{4} * jpeg_.output_width * jpeg_.output_scanline;
      jpeg_read_scanlines(&jpeg_, &row, 1);
    }
    jpeg_finish_decompress(&jpeg_);
    return true;
  }

  [[noreturn]] void fail() {
    if (!tooManyScans_ && errors_.msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (tooManyScans_)
      throw PixelError("a JPEG of more than " + std::to_string(kMaxScans) + " scans");
    std::array<char, JMSG_LENGTH_MAX> text{};
    errors_.format_message(reinterpret_cast<j_common_ptr>(&jpeg_), text.data());
    throw PixelError(text.data());
  }

  static JpegReader& of(j_common_ptr jpeg) { return *static_cast<JpegReader*>(jpeg->client_data); }
  [[noreturn]] static void onError(j_common_ptr jpeg) { std::longjmp(of(jpeg).back_, 1); }
  // Keeps the first warning; negative levels are warnings, others are traces.
  static void onMessage(j_common_ptr jpeg, int level) {
    if (level >= 0 || of(jpeg).warning_[0] != '\0') return;
    jpeg->err->format_message(jpeg, of(jpeg).warning_.data());
  }
  static void onProgress(j_common_ptr jpeg) {
    if (of(jpeg).jpeg_.input_scan_number <= kMaxScans) return;
    of(jpeg).tooManyScans_ = true;
    onError(jpeg);
  }

  std::string_view bytes_;
  jpeg_decompress_struct jpeg_{};
  jpeg_error_mgr errors_{};
  jpeg_progress_mgr progress_{};
  std::array<char, JMSG_LENGTH_MAX> warning_{};
  bool tooManyScans_ = false;
  std::jmp_buf back_;
};

}  // namespace

bool isJpeg(std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }

Pixels readJpeg(std::string_view bytes) { return JpegReader(bytes).read(); }

}  // namespace bnvpl
