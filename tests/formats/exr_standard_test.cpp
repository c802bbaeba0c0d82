// The standard attributes of an OpenEXR header: windows, primaries, camera and compression.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <cmath>

#include "tests/formats/exr_files.h"

namespace bnvpl {
namespace {

using ExrStandard = TestFolder;

Image imageWithCamera() {
  Image image = layeredImage();
  ImageCamera& camera = image.camera.emplace();
  for (size_t i = 0; i < 16; ++i) {
    camera.worldToCamera[i] = static_cast<float>(i) + 0.1f;
    camera.worldToNdc[i] = 1.0f / (static_cast<float>(i) + 3.0f);
  }
  camera.screenWindowWidth = 0.7f;
  camera.screenWindowCenter = {0.25f, -0.5f};
  return image;
}

TEST_F(ExrStandard, CameraAndPrimariesAreInTheHeader) {
  const Image image = imageWithCamera();
  writeExr(at("a.exr"), image, ExrPixelType::Half);
  EXPECT_EQ(readExr(at("a.exr")).camera, image.camera);
  EXPECT_EQ(hashImage(readExr(at("a.exr")), ExrPixelType::Half),
            hashImage(image, ExrPixelType::Half));
  EXPECT_NE(hashImage(layeredImage(), ExrPixelType::Half), hashImage(image, ExrPixelType::Half));
  const std::string bytes = readAll(at("a.exr"));
  const auto floats = [&](const std::string& name, const std::string& type, size_t count) {
    std::vector<float> values(count);
    std::memcpy(values.data(), bytes.data() + attributeOffset(bytes, name, type),
                count * sizeof(float));
    return values;
  };
  const auto& matrix = image.camera->worldToCamera;
  EXPECT_EQ(floats("worldToCamera", "m44f", 16), std::vector<float>(matrix.begin(), matrix.end()));
  EXPECT_EQ(floats("screenWindowWidth", "float", 1), std::vector<float>{0.7f});
  EXPECT_EQ(floats("screenWindowCenter", "v2f", 2), (std::vector<float>{0.25f, -0.5f}));
  EXPECT_EQ(floats("pixelAspectRatio", "float", 1), std::vector<float>{1.0f});
  EXPECT_EQ(floats("chromaticities", "chromaticities", 8),
            (std::vector<float>{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f}));
  // A matrix that is not finite is no camera.
  std::string damaged = bytes;
  poke(damaged, attributeOffset(bytes, "worldToNDC", "m44f"), std::nanf(""));
  writeAll(at("b.exr"), damaged);
  EXPECT_FALSE(readExr(at("b.exr")).camera);
}

TEST_F(ExrStandard, OnlyTheDataWindowIsWritten) {
  Image image = layeredImage();
  writeExr(at("whole.exr"), image, ExrPixelType::Float);
  image.dataWindow = PixelBox{5, 7, 30, 11};
  for (ImageChannel& channel : image.channels) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const bool inside = x >= 5 && x < 30 && y >= 7 && y < 11;
        if (!inside) channel.data[static_cast<size_t>(y * image.width + x)] = 0.0f;
      }
    }
  }
  writeExr(at("crop.exr"), image, ExrPixelType::Float);
  EXPECT_LT(fs::file_size(at("crop.exr")), fs::file_size(at("whole.exr")) / 3);
  const std::string bytes = readAll(at("crop.exr"));
  const int32_t window[4] = {5, 7, 29, 10};
  EXPECT_EQ(bytes.compare(attributeOffset(bytes, "dataWindow", "box2i"), 16,
                          std::string(reinterpret_cast<const char*>(window), 16)),
            0);
  const Image read = readExr(at("crop.exr"));
  EXPECT_EQ(read.dataWindow, image.dataWindow);
  EXPECT_EQ(*read.find("G"), *image.find("G"));
  EXPECT_EQ(hashImage(read, ExrPixelType::Float), hashImage(image, ExrPixelType::Float));
  for (const PixelBox bad : {PixelBox{-1, 0, 5, 5}, PixelBox{0, 0, 38, 5}, PixelBox{4, 4, 4, 9}}) {
    image.dataWindow = bad;
    EXPECT_THROW(writeExr(at("x.exr"), image, ExrPixelType::Float), OutputError);
  }
}

TEST_F(ExrStandard, AnImageOfOneColourIsReadWhateverItsCompression) {
  constexpr int kSide = 1024;
  std::vector<float> black(size_t{kSide} * kSide);
  for (const auto compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
        Imf::PXR24_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION,
        Imf::DWAB_COMPRESSION}) {
    Imf::Header header(kSide, kSide);
    header.compression() = compression;
    Imf::FrameBuffer pixels;
    for (const char* name : {"B", "G", "R"}) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT));
      pixels.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(black.data()),
                                     sizeof(float), kSide * sizeof(float)));
    }
    {
      Imf::OutputFile out(at("flat.exr").c_str(), header);
      out.setFrameBuffer(pixels);
      out.writePixels(kSide);
    }
    EXPECT_EQ(*readExr(at("flat.exr")).find("G"), black) << int{compression};
  }
}

}  // namespace
}  // namespace bnvpl
