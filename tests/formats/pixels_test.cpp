// PNG, JPEG, TGA and BMP: sound, cut short, damaged, and with colours that their palettes lack.
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <zlib.h>

#include <cstdio>

#include "formats/image/pixels_io.h"
#include "formats/image/raster_check.h"

namespace bnvpl {
namespace {

std::string number(uint32_t value, int bytes, bool bigEndian) {
  std::string out;
  for (int i = 0; i < bytes; ++i)
    out += static_cast<char>(value >> 8 * (bigEndian ? bytes - 1 - i : i) & 0xff);
  return out;
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto* first = reinterpret_cast<const Bytef*>(body.data());
  const auto sum = static_cast<uint32_t>(crc32(0, first, static_cast<uInt>(body.size())));
  return number(static_cast<uint32_t>(data.size()), 4, true) + body + number(sum, 4, true);
}

// A zlib stream of one stored block, whose bytes are those of the rows.
std::string stored(const std::string& rows) {
  const auto length = static_cast<uint32_t>(rows.size());
  const auto sum = static_cast<uint32_t>(
      adler32(1, reinterpret_cast<const Bytef*>(rows.data()), static_cast<uInt>(rows.size())));
  return std::string("\x78\x01\x01", 3) + number(length, 2, false) +
         number(length ^ 0xffff, 2, false) + rows + number(sum, 4, true);
}

// `chunks` stand between the header and the rows; each row begins with its filter.
std::string png(uint32_t width, uint32_t height, char bits, char type, const std::string& chunks,
                const std::string& rows) {
  const std::string header =
      number(width, 4, true) + number(height, 4, true) + std::string{bits, type, 0, 0, 0};
  return std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", header) + chunks +
         chunk("IDAT", stored(rows)) + chunk("IEND", "");
}

using Values = std::vector<uint8_t>;
Values rgba(const std::string& bytes) { return decodePixels("image", bytes).values; }
std::string damageOf(const std::string& bytes) { return decodePixels("image", bytes).damage; }
std::string errorOf(const std::string& bytes) {
  try {
    decodePixels("image", bytes);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(PngPixels, EveryKindIsRead) {
  const std::string clear = chunk("tRNS", {0, 1});
  EXPECT_EQ(rgba(png(2, 1, 2, 0, "", {0, 0x10})), (Values{0, 0, 0, 255, 85, 85, 85, 255}));
  EXPECT_EQ(rgba(png(2, 1, 1, 0, clear, {0, 0x40})), (Values{0, 0, 0, 255, 255, 255, 255, 0}));
  EXPECT_EQ(rgba(png(1, 1, 16, 0, "", {0, 7, char(200)})), (Values{8, 8, 8, 255}));
  EXPECT_EQ(rgba(png(1, 1, 8, 2, "", {0, 1, 2, 3})), (Values{1, 2, 3, 255}));
  EXPECT_EQ(rgba(png(1, 1, 8, 4, "", {0, 9, 5})), (Values{9, 9, 9, 5}));
  EXPECT_EQ(rgba(png(1, 1, 16, 6, "", {0, 1, -1, 2, -1, 3, -1, 4, -1})), (Values{2, 3, 4, 5}));
  const std::string palette = chunk("PLTE", "abcdef"), alpha = chunk("tRNS", "\x09");
  EXPECT_EQ(rgba(png(2, 1, 1, 3, palette + alpha, {0, 0x40})),
            (Values{'a', 'b', 'c', 9, 'd', 'e', 'f', 255}));
  EXPECT_EQ(decodePng("p", png(2, 1, 1, 3, palette, {0, 0x40})).channels, 3u);
  EXPECT_EQ(decodePng("p", png(1, 1, 8, 4, "", {0, 9, 5})).values, (Values{9, 5}));
}

// Gamma and profiles of colours are not applied, and what is wrong with them damages no pixel.
TEST(PngPixels, ColourChunksAreNotRead) {
  const std::string others = chunk("gAMA", number(100000, 4, true)) + chunk("sRGB", "\x09") +
                             chunk("iCCP", "nonsense") + chunk("tEXt", "a\0b");
  const Pixels read = decodePixels("p", png(1, 1, 8, 0, others, {0, 77}));
  EXPECT_EQ(read.values, (Values{77, 77, 77, 255}));
  EXPECT_EQ(read.damage, "");
}

TEST(PngPixels, ColoursBeyondThePaletteAreBlackAndTold) {
  for (const char bits : {char(1), char(2), char(4), char(8)}) {
    const std::string bytes = png(1, 1, bits, 3, chunk("PLTE", "abc"), {0, char(0xff)});
    EXPECT_EQ(rgba(bytes), (Values{0, 0, 0, 255})) << int(bits);
    EXPECT_NE(damageOf(bytes).find("of a palette of 1"), std::string::npos) << damageOf(bytes);
  }
  EXPECT_EQ(damageOf(png(1, 1, 8, 3, chunk("PLTE", "abc"), {0, 0})), "");
}

TEST(PngPixels, EveryBitFlipAndEveryCutIsRefusedOrTold) {
  const std::string sound = png(4, 4, 8, 3, chunk("PLTE", "abcdefghi") + chunk("tRNS", "\x05"),
                                {0, 0, 1, 2, 0, 0, 2, 1, 0, 2, 0, 1, 1, 1, 1, 0, 2, 2, 2, 2});
  const Values pixels = rgba(sound);
  for (size_t bit = 0; bit < 8 * sound.size(); ++bit) {
    std::string damaged = sound;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
    try {
      EXPECT_NE(damageOf(damaged), "") << "bit " << bit;
    } catch (const InputError&) {
    }
  }
  for (size_t length = 0; length < sound.size(); ++length)
    EXPECT_THROW(rgba(sound.substr(0, length)), InputError) << length;
  EXPECT_EQ(rgba(sound), pixels);
}

// A picture of `side` x `side` pixels of one grey.
std::string jpeg(unsigned side, bool progressive = false) {
  jpeg_compress_struct out{};
  jpeg_error_mgr errors{};
  out.err = jpeg_std_error(&errors);
  jpeg_create_compress(&out);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&out, &bytes, &size);
  out.image_width = out.image_height = side;
  out.input_components = 3;
  out.in_color_space = JCS_RGB;
  jpeg_set_defaults(&out);
  if (progressive) jpeg_simple_progression(&out);
  jpeg_start_compress(&out, TRUE);
  std::vector<JSAMPLE> row(size_t{3} * side);
  for (unsigned y = 0; y < side; ++y) {
    for (unsigned x = 0; x < side; ++x)  // blocks of their own greys, so that all have bytes
      std::fill_n(&row[size_t{3} * x], 3, static_cast<JSAMPLE>((x / 8 * 37 + y / 8 * 59) % 256));
    JSAMPROW first = row.data();
    jpeg_write_scanlines(&out, &first, 1);
  }
  jpeg_finish_compress(&out);
  const std::string whole(reinterpret_cast<const char*>(bytes), size);
  jpeg_destroy_compress(&out);
  std::free(bytes);
  return whole;
}

TEST(JpegPixels, SoundOnesAreRead) {
  for (const bool progressive : {false, true}) {
    const Pixels read = decodePixels("p", jpeg(64, progressive));
    EXPECT_EQ(read.damage, "");
    EXPECT_EQ(read.width, 64u);
    const uint8_t* middle = &read.values[4 * (64 * 28 + 20)];  // block 2, 3
    EXPECT_NEAR(middle[0], 2 * 37 + 3 * 59, 3);
    EXPECT_EQ(middle[3], 255);
  }
}

TEST(JpegPixels, LostBytesAreTold) {
  const std::string sound = jpeg(256);
  const size_t scan = sound.find("\xff\xda"), length = sound.size() - scan;
  EXPECT_NE(damageOf(sound.substr(0, scan + length / 2)), "");
  EXPECT_NE(damageOf(sound.substr(0, sound.size() - 2)), "");
  std::string hole = sound;
  hole.erase(scan + length / 2, length / 4);
  EXPECT_NE(damageOf(hole), "");
  EXPECT_THROW(rgba(sound.substr(0, 20)), InputError);
}

TEST(JpegPixels, OfVeryManyScansAreRefused) {
  const std::string sound = jpeg(64, true);
  const size_t last = sound.rfind("\xff\xda");
  std::string many = sound.substr(0, sound.size() - 2);
  for (int i = 0; i < 100; ++i) many += sound.substr(last, sound.size() - 2 - last);
  EXPECT_NE(errorOf(many + "\xff\xd9").find("more than 100 scans"), std::string::npos);
}

// A BMP of `header` bytes: 12 is that of OS/2, without a place for masks.
std::string bmp(uint32_t header, int width, int height, uint32_t bits, const std::string& palette,
                const std::string& rows) {
  const int size = header == 12 ? 2 : 4;
  std::string info = number(header, 4, false) + number(static_cast<uint32_t>(width), size, false) +
                     number(static_cast<uint32_t>(height), size, false) + number(1, 2, false) +
                     number(bits, 2, false);
  info.resize(header);
  const auto pixels = static_cast<uint32_t>(14 + header + palette.size());
  return "BM" + number(0, 4, false) + number(0, 4, false) + number(pixels, 4, false) + info +
         palette + rows;
}

TEST(BmpPixels, RowsMayBeginAtTheTop) {
  const std::string rows = "abc.def.";  // two pixels, each a row of a multiple of 4 bytes
  const Values up = rgba(bmp(40, 1, 2, 24, "", rows)), down = rgba(bmp(40, 1, -2, 24, "", rows));
  EXPECT_EQ(up, (Values{'f', 'e', 'd', 255, 'c', 'b', 'a', 255}));
  EXPECT_EQ(down, (Values{'c', 'b', 'a', 255, 'f', 'e', 'd', 255}));
  EXPECT_NE(errorOf(bmp(40, 1, INT32_MIN, 24, "", rows)), "");
}

TEST(BmpPixels, ColoursBeyondThePaletteAreBlack) {
  for (const uint32_t bits : {1u, 4u, 8u}) {
    const std::string rows{char(0xff), 0, 0, 0};
    EXPECT_EQ(rgba(bmp(40, 1, 1, bits, "abc.", rows)), (Values{0, 0, 0, 255})) << bits;
  }
  // All colours of a whole palette are kept, in an OS/2 file too.
  std::string three, four;
  for (int i = 0; i < 256; ++i) {
    three += std::string{char(i), 1, 2};
    four += std::string{char(i), 1, 2, 0};
  }
  const std::string last{char(0xff), char(0xfe), 0, 0};
  const Values expected{2, 1, 255, 255, 2, 1, 254, 255};
  EXPECT_EQ(rgba(bmp(12, 2, 1, 8, three, last)), expected);
  EXPECT_EQ(rgba(bmp(40, 2, 1, 8, four, last)), expected);
}

std::string tga(char type, const std::string& palette, char bits, const std::string& data) {
  std::string header(18, '\0');
  header[2] = type;
  header[12] = header[14] = 4;
  header[16] = bits;
  if (!palette.empty()) {
    header[1] = 1;
    header[5] = static_cast<char>(palette.size() / 3);
    header[7] = 24;
  }
  return header + palette + data;
}

TEST(RasterPixels, MissingOnesAreToldAndBlack) {
  const std::string run{char(0x80 | 15)};  // 16 pixels alike
  const std::vector<std::string> whole{
      tga(2, "", 24, std::string(48, 'x')),
      tga(3, "", 8, std::string(16, 'x')),
      tga(1, "abcdef", 8, std::string(16, '\1')),
      tga(10, "", 24, run + "abc"),
      tga(10, "", 24, "\x0f" + std::string(48, 'x')),
      tga(9, "abcdef", 8, run + "\1"),
      bmp(40, 4, 4, 24, "", std::string(48, 'x')),
      bmp(40, 4, -4, 24, "", std::string(48, 'x')),
      bmp(40, 4, 4, 8, std::string(1024, 'x'), std::string(16, '\2')),
      bmp(12, 4, 4, 4, std::string(48, 'x'), std::string(14, '\2')),
  };
  for (const std::string& bytes : whole) {
    EXPECT_EQ(damageOf(bytes), "") << &bytes - whole.data();
    EXPECT_EQ(damageOf(bytes + "more"), "") << &bytes - whole.data();
    EXPECT_NE(damageOf(bytes.substr(0, bytes.size() - 1)), "") << &bytes - whole.data();
  }
  const Values cut = rgba(whole[0].substr(0, 18 + 24));
  EXPECT_EQ(cut.size(), 64u);
  EXPECT_EQ((Values{cut.begin(), cut.begin() + 4}), (Values{0, 0, 0, 255}));
}

}  // namespace
}  // namespace bnvpl
