#include <cmath>
#include <limits>
#include <utility>

#include "tests/formats/exr_files.h"

namespace bnvpl {
namespace {

using Exr = TestFolder;

TEST_F(Exr, FloatRoundTripIsExactWithLayersAndAttributes) {
  const Image image = layeredImage();
  EXPECT_EQ(writeExr(at("a.exr"), image, ExrPixelType::Float), HalfLosses{});
  const Image read = readExr(at("a.exr"));
  EXPECT_EQ(read.width, image.width);
  EXPECT_EQ(read.height, image.height);
  EXPECT_EQ(read.attributes, image.attributes);
  ASSERT_EQ(read.channels.size(), image.channels.size());
  for (const ImageChannel& channel : image.channels) {
    ASSERT_NE(read.find(channel.name), nullptr) << channel.name;
    EXPECT_EQ(*read.find(channel.name), channel.data) << channel.name;
  }
  EXPECT_EQ(read.find("indirect.R"), nullptr);
}

TEST_F(Exr, HalfRoundTripIsWithinHalfPrecision) {
  const Image image = layeredImage();
  EXPECT_EQ(writeExr(at("a.exr"), image, ExrPixelType::Half), HalfLosses{});
  EXPECT_LT(fs::file_size(at("a.exr")), image.pixelCount() * image.channels.size() * 2);
  const Image read = readExr(at("a.exr"));
  EXPECT_EQ(read.attributes, image.attributes);
  ASSERT_EQ(read.channels.size(), image.channels.size());
  for (const ImageChannel& channel : image.channels) {
    const std::vector<float>& data = *read.find(channel.name);
    for (size_t i = 0; i < data.size(); ++i) {
      const float error = channel.name == "Z" ? 0.0f : channel.data[i] * 0x1p-11f;
      ASSERT_NEAR(data[i], channel.data[i], error) << channel.name;
    }
  }
}

TEST_F(Exr, WhatHalfCannotHoldIsCounted) {
  Image image;
  image.width = 8;
  image.height = 1;
  image.add("R") = {65504.0f, 65505.0f, 1e9f, -1e38f, 1.0f, 0x1p-24f, 0x1p-26f, -1e-40f};
  EXPECT_EQ(writeExr(at("half.exr"), image, ExrPixelType::Half), (HalfLosses{3, 2}));
  const Image half = readExr(at("half.exr"));
  const std::vector<float>& data = *half.find("R");
  EXPECT_EQ(data[0], 65504.0f);
  EXPECT_EQ(data[1], 65504.0f);
  EXPECT_EQ(data[2], 65504.0f);
  EXPECT_EQ(data[3], -65504.0f);
  EXPECT_EQ(data[4], 1.0f);
  EXPECT_EQ(data[5], 0x1p-24f);
  EXPECT_EQ(data[6], 0.0f);
  EXPECT_EQ(writeExr(at("float.exr"), image, ExrPixelType::Float), HalfLosses{});
  EXPECT_EQ((*readExr(at("float.exr")).find("R"))[2], 1e9f);
}

// Depth is infinite where a ray hits nothing, in half files too. Any other non-finite value is a
// bug of the caller.
TEST_F(Exr, NonFiniteValuesAreRefusedButForInfiniteDepth) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  Image image = layeredImage();
  writeExr(at("a.exr"), image, ExrPixelType::Half);
  const std::string before = readAll(at("a.exr"));
  for (ImageChannel& channel : image.channels) {
    for (const float bad : {nan, inf, -inf}) {
      const float good = std::exchange(channel.data[37 * 20 + 3], bad);
      const bool depth = channel.name == "Z" && bad > 0.0f;
      for (const ExrPixelType type : {ExrPixelType::Half, ExrPixelType::Float}) {
        if (depth) {
          EXPECT_EQ(writeExr(at("z.exr"), image, type), HalfLosses{});
          EXPECT_EQ((*readExr(at("z.exr")).find("Z"))[37 * 20 + 3], inf);
          continue;
        }
        try {
          writeExr(at("a.exr"), image, type);
          ADD_FAILURE() << channel.name << " " << bad;
        } catch (const std::logic_error& e) {
          EXPECT_NE(std::string(e.what()).find(at("a.exr").string() + ": channel " + channel.name +
                                               ", column 3, row 20: not a finite number"),
                    std::string::npos)
              << e.what();
        }
      }
      channel.data[37 * 20 + 3] = good;
    }
  }
  EXPECT_TRUE(readAll(at("a.exr")) == before);
}

TEST_F(Exr, DepthKeepsItsDigitsInHalfFiles) {
  Image image;
  image.width = image.height = 1;
  image.add("Z") = {123456.789f};
  EXPECT_EQ(writeExr(at("a.exr"), image, ExrPixelType::Half), HalfLosses{});
  EXPECT_EQ((*readExr(at("a.exr")).find("Z"))[0], 123456.789f);
}

TEST_F(Exr, EqualImagesGiveEqualBytes) {
  writeExr(at("a.exr"), layeredImage(), ExrPixelType::Half);
  writeExr(at("b.exr"), layeredImage(), ExrPixelType::Half);
  EXPECT_TRUE(readAll(at("a.exr")) == readAll(at("b.exr")));
}

TEST_F(Exr, WindowsAreWrittenFromZero) {
  writeExr(at("a.exr"), layeredImage(), ExrPixelType::Float);
  const std::string bytes = readAll(at("a.exr"));
  const std::string window("\0\0\0\0\0\0\0\0\x24\0\0\0\x14\0\0\0", 16);  // (0,0) to (36,20)
  EXPECT_EQ(bytes.substr(attributeOffset(bytes, "displayWindow", "box2i"), 16), window);
  EXPECT_EQ(bytes.substr(attributeOffset(bytes, "dataWindow", "box2i"), 16), window);
}

TEST_F(Exr, DataWindowInsideTheDisplayWindowIsPlaced) {
  const Image image = layeredImage();
  writeExr(at("a.exr"), image, ExrPixelType::Float);
  std::string bytes = readAll(at("a.exr"));
  // The display window has 2 columns and 3 lines more before the data, and 4 and 5 fewer after.
  const int window[4] = {-2, -3, 32, 15};
  poke(bytes, attributeOffset(bytes, "displayWindow", "box2i"), window);
  writeAll(at("b.exr"), bytes);
  const Image read = readExr(at("b.exr"));
  ASSERT_EQ(read.width, 35);
  ASSERT_EQ(read.height, 19);
  for (int y = 0; y < 19; ++y) {
    for (int x = 0; x < 35; ++x) {
      const bool inside = x >= 2 && y >= 3;
      const size_t from = static_cast<size_t>((y - 3) * 37 + x - 2);
      ASSERT_EQ((*read.find("G"))[static_cast<size_t>(y * 35 + x)],
                inside ? (*image.find("G"))[from] : 0.0f)
          << x << ' ' << y;
    }
  }
}

TEST_F(Exr, EveryTruncationIsRefused) {
  Image image;
  image.width = image.height = 20;
  for (const char* name : {"R", "G"}) {
    std::vector<float>& data = image.add(name);
    for (size_t i = 0; i < data.size(); ++i) data[i] = std::sin(static_cast<float>(i));
  }
  writeExr(at("a.exr"), image, ExrPixelType::Half);
  const std::string bytes = readAll(at("a.exr"));
  for (size_t size = 0; size < bytes.size(); ++size) {
    writeAll(at("b.exr"), bytes.substr(0, size));
    ASSERT_THROW(readExr(at("b.exr")), InputError) << size;
  }
  EXPECT_THROW(readExr(at("missing.exr")), InputError);
  EXPECT_THROW(readExr(at(".")), InputError);
}

TEST_F(Exr, NoSingleByteOfDamageCrashesTheReader) {
  writeExr(at("a.exr"), layeredImage(), ExrPixelType::Half);
  const std::string bytes = readAll(at("a.exr"));
  for (size_t i = 0; i < std::min<size_t>(bytes.size(), 1200); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0xff);
    writeAll(at("b.exr"), damaged);
    try {
      readExr(at("b.exr"));  // some bytes only change a name or a colour
    } catch (const InputError&) {
    }
  }
}

TEST_F(Exr, AbsurdSizesAreRefusedBeforeTheyAreAllocated) {
  writeExr(at("a.exr"), layeredImage(), ExrPixelType::Half);
  const std::string bytes = readAll(at("a.exr"));
  for (const int side : {60000, 1 << 20, 2147483647}) {
    for (const char* name : {"displayWindow", "dataWindow"}) {
      std::string damaged = bytes;
      const int window[4] = {0, 0, side - 1, side - 1};
      poke(damaged, attributeOffset(damaged, name, "box2i"), window);
      writeAll(at("b.exr"), damaged);
      EXPECT_THROW(readExr(at("b.exr")), InputError) << name << side;
    }
  }
}

TEST_F(Exr, AttributesThatClaimTooMuchAreRefusedBeforeTheyAreAllocated) {
  Image image = layeredImage();
  image.attributes["note"] = "hello";
  writeExr(at("a.exr"), image, ExrPixelType::Half);
  const std::string bytes = readAll(at("a.exr"));
  struct Case {
    const char *name, *type;
    uint32_t claim;
  };
  for (const Case& c : {Case{"note", "string", 2'000'000'000}, Case{"dataWindow", "box2i", 15},
                        Case{"channels", "chlist", 18}, Case{"channels", "chlist", 1000}}) {
    std::string damaged = bytes;
    poke(damaged, attributeOffset(damaged, c.name, c.type) - 4, c.claim);
    writeAll(at("b.exr"), damaged);
    try {
      readExr(at("b.exr"));
      ADD_FAILURE() << c.name;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("claims"), std::string::npos) << e.what();
    }
  }
}

// OpenEXR continues reading such attributes at another place than their size states. It would then
// take the letters "stri" for a size and allocate 1.7 GB.
TEST_F(Exr, AttributesThatHideTheNextAreRefused) {
  const auto attribute = [](const std::string& name, const std::string& type,
                            const std::string& value) {
    const auto size = static_cast<uint32_t>(value.size());
    std::string bytes = name + '\0' + type + '\0' + std::string(4, '\0') + value;
    poke(bytes, name.size() + type.size() + 2, size);
    return bytes;
  };
  const std::string end = attribute("comments", "string", std::string(40, ' '));
  const std::string hidden = std::string("x\0y\0stri", 8);
  writeExr(at("a.exr"), layeredImage(), ExrPixelType::Half);
  const std::string bytes = readAll(at("a.exr"));
  const size_t opening = 8;
  const std::vector<std::pair<const char*, std::string>> cases{
      {"no whole number of floats", attribute("f", "floatvector", std::string("1234x\0", 6)) + end},
      {"the longest name", std::string(255, 'n') + '\0' + hidden.substr(2)},
      {"the longest type", std::string("n\0", 2) + std::string(255, 't') + '\0' + "stri"},
      {"a channel list without an end", attribute("channels", "chlist", "") +
                                            std::string(255, 'c') + std::string(18, '\0') +
                                            hidden}};
  const std::string far = attribute("long", "string", std::string(300'000, ' '));
  for (const std::string& before : {std::string(), far}) {
    for (const auto& [name, inserted] : cases) {
      std::string damaged = bytes;
      damaged.insert(opening, before + inserted);
      writeAll(at("b.exr"), damaged);
      try {
        readExr(at("b.exr"));
        ADD_FAILURE() << name;
      } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("claims"), std::string::npos)
            << name << ": " << e.what();
      }
    }
  }
  std::string manifest = bytes;
  manifest.insert(opening, attribute("m", "idmanifest", std::string(8, '\0')) + end);
  writeAll(at("b.exr"), manifest);
  try {
    readExr(at("b.exr"));
    ADD_FAILURE() << "ID manifest";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("ID manifest"), std::string::npos) << e.what();
  }
  Image honest = layeredImage();
  honest.attributes[std::string(255, 'n')] = "the longest name";
  writeExr(at("a.exr"), honest, ExrPixelType::Half);
  EXPECT_EQ(readExr(at("a.exr")).attributes, honest.attributes);
}

TEST_F(Exr, MalformedImagesAndTargetsAreRefused) {
  Image image = layeredImage();
  EXPECT_THROW(writeExr(at("missing") / "a.exr", image, ExrPixelType::Half), OutputError);
  image.add("R");
  EXPECT_THROW(writeExr(at("a.exr"), image, ExrPixelType::Half), OutputError);
  image.channels.back() = {"short", std::vector<float>(3)};
  EXPECT_THROW(writeExr(at("a.exr"), image, ExrPixelType::Half), OutputError);
  EXPECT_THROW(writeExr(at("a.exr"), Image{}, ExrPixelType::Half), OutputError);
  image.channels.pop_back();
  image.attributes["dataWindow"] = "not a window";
  EXPECT_THROW(writeExr(at("a.exr"), image, ExrPixelType::Half), OutputError);
  EXPECT_EQ(fileCount(), 0u);
}

}  // namespace
}  // namespace bnvpl
