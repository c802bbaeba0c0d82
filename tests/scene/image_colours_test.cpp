// Colours of images whose primaries or channels are not those of Rec. 709.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

using Channels = std::map<std::string, float>;

// ACES 2065-1, AP0 (SMPTE ST 2065-1).
const Imf::Chromaticities kAces{
    {0.7347f, 0.2653f}, {0.0f, 1.0f}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}};

class ImageColours : public SceneFiles {
 protected:
  // Writes an image of one colour, one pixel unless the header says otherwise.
  void writePixel(const std::string& name, const Channels& values, Imf::Header header = {1, 1},
                  int sampling = 1) const {
    const int side = header.displayWindow().max.x + 1;
    std::map<std::string, std::vector<float>> pixels;
    Imf::FrameBuffer frame;
    for (const auto& [channel, value] : values) {
      const int step = channel == "RY" || channel == "BY" ? sampling : 1;
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT, step, step));
      std::vector<float>& data = pixels[channel];
      data.assign(static_cast<size_t>(side * side), value);
      frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(data.data()),
                                       sizeof(float), sizeof(float) * side, step, step));
    }
    Imf::OutputFile out(at(name).c_str(), header);
    out.setFrameBuffer(frame);
    out.writePixels(side);
  }
  EnvironmentImage environment(const std::string& name) const {
    size_t negative = 0;
    return loadEnvironment(at(name), negative);
  }
  Vec3 colourOf(const std::string& name) const { return environment(name).radiance.at(0); }
};

void expectColour(Vec3 a, Vec3 b) {
  EXPECT_LT(length(a - b), 1e-3f) << a.x << " " << a.y << " " << a.z;
}

Imf::Header headerOf(const Imf::Chromaticities& c) {
  Imf::Header header(1, 1);
  Imf::addChromaticities(header, c);
  return header;
}

TEST_F(ImageColours, OtherPrimariesAreConverted) {
  // A dull orange, by the Bradford-adapted matrix from AP0 to sRGB.
  const Channels orange{{"R", 0.5f}, {"G", 0.4f}, {"B", 0.3f}};
  const Vec3 wanted{0.5f * 2.52169f - 0.4f * 1.13413f - 0.3f * 0.38756f,
                    -0.5f * 0.27648f + 0.4f * 1.37272f - 0.3f * 0.09624f,
                    -0.5f * 0.01538f - 0.4f * 0.15298f + 0.3f * 1.16835f};
  writePixel("aces.exr", orange, headerOf(kAces));
  expectColour(colourOf("aces.exr"), wanted);
  expectColour(loadTexture(at("aces.exr"), true, false).texel(0, 0), wanted);
  // Data have no colour.
  expectColour(loadTexture(at("aces.exr"), false, false).texel(0, 0), {0.5f, 0.4f, 0.3f});
  writePixel("white.exr", {{"R", 1.0f}, {"G", 1.0f}, {"B", 1.0f}}, headerOf(kAces));
  expectColour(colourOf("white.exr"), Vec3(1));
}

TEST_F(ImageColours, ThoseOfRec709StayAsTheyAre) {
  const Channels any{{"R", 0.1f}, {"G", 0.2f}, {"B", 0.7f}};
  writePixel("own.exr", any, headerOf({}));
  EXPECT_EQ(colourOf("own.exr"), Vec3(0.1f, 0.2f, 0.7f));
  Imf::Chromaticities rounded;
  rounded.white = {0.313f, 0.329f};
  writePixel("rounded.exr", any, headerOf(rounded));
  EXPECT_EQ(colourOf("rounded.exr"), Vec3(0.1f, 0.2f, 0.7f));
  writePixel("none.exr", any, headerOf({{0, 0}, {0, 0}, {0, 0}, {0, 0}}));
  const EnvironmentImage none = environment("none.exr");
  EXPECT_EQ(none.radiance[0], Vec3(0.1f, 0.2f, 0.7f));
  EXPECT_EQ(countContaining(none.notes, "are no primaries"), 1u);
}

TEST_F(ImageColours, OfARadianceHdr) {
  const auto hdr = [&](const std::string& name, const std::string& primaries) {
    write(name, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nPRIMARIES=" + primaries +
                    "\n\n-Y 1 +X 1\n" + "\x80\x40\x20\x81");
    return environment(name);
  };
  const Vec3 plain{1.0f, 0.5f, 0.25f};
  EXPECT_EQ(hdr("own.hdr", "0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290").radiance[0], plain);
  const EnvironmentImage aces = hdr("a.hdr", ".7347 .2653 0 1 .0001 -.077 .32168 .33767");
  expectColour(aces.radiance[0], {2.52169f - 0.5f * 1.13413f - 0.25f * 0.38756f,
                                  -0.27648f + 0.5f * 1.37272f - 0.25f * 0.09624f,
                                  -0.01538f - 0.5f * 0.15298f + 0.25f * 1.16835f});
  EXPECT_TRUE(aces.notes.empty());
  const EnvironmentImage zeros = hdr("0.hdr", "0 0 0 0 0 0 0 0");
  EXPECT_EQ(zeros.radiance[0], plain);
  EXPECT_EQ(countContaining(zeros.notes, "PRIMARIES"), 1u);
}

TEST_F(ImageColours, XyzIsConverted) {
  writePixel("red.exr", {{"X", 0.4124f}, {"Y", 0.2126f}, {"Z", 0.0193f}});
  expectColour(colourOf("red.exr"), {1, 0, 0});
}

TEST_F(ImageColours, LuminanceAndChromaAreConverted) {
  const Vec3 rgb{0.8f, 0.4f, 0.1f};
  const float y = 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z;
  const Channels values{{"Y", y}, {"RY", (rgb.x - y) / y}, {"BY", (rgb.z - y) / y}};
  writePixel("chroma.exr", values);
  expectColour(colourOf("chroma.exr"), rgb);
  writePixel("y.exr", {{"Y", 0.5f}, {"A", 1.0f}});
  EXPECT_EQ(colourOf("y.exr"), Vec3(0.5f));

  writePixel("small.exr", values, {2, 2}, 2);
  try {
    environment("small.exr");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("subsampled; save the image with"), std::string::npos)
        << e.what();
  }
  writePixel("half.exr", {{"Y", 0.5f}, {"RY", 0.5f}});
  EXPECT_THROW(environment("half.exr"), InputError);
}

TEST_F(ImageColours, OfSeveralPartsTheFirstIsRead) {
  std::vector<Imf::Header> headers(2, Imf::Header(1, 1));
  for (size_t i = 0; i < 2; ++i) {
    headers[i].setName(i == 0 ? "first" : "second");
    headers[i].setType(Imf::SCANLINEIMAGE);
    for (const char* c : {"R", "G", "B"}) headers[i].channels().insert(c, Imf::Channel(Imf::FLOAT));
  }
  {
    Imf::MultiPartOutputFile file(at("parts.exr").c_str(), headers.data(), 2);
    for (int i = 0; i < 2; ++i) {
      float value = static_cast<float>(i + 1);
      Imf::FrameBuffer frame;
      for (const char* c : {"R", "G", "B"})
        frame.insert(c, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&value), sizeof(float), sizeof(float)));
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(frame);
      part.writePixels(1);
    }
  }
  const EnvironmentImage e = environment("parts.exr");
  EXPECT_EQ(e.radiance[0], Vec3(1));
  EXPECT_EQ(countContaining(e.notes, "has 2 parts; the first is read"), 1u);
  write("square.obj", kSquareObj);
  write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  const Scene s = load(kFilmAndCamera +
                       "[[mesh]]\nfile = \"square.obj\"\n"
                       "[[light]]\ntype = \"environment\"\nimage = \"parts.exr\"\n");
  EXPECT_EQ(countContaining(s.warnings, "parts.exr: has 2 parts"), 1u) << joined(s.warnings);
}

}  // namespace
}  // namespace bnvpl
