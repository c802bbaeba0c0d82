// --crop: parts of the film that assemble into the whole image.
#include "formats/image/exr_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Crop : public PipelineTest {
 protected:
  // Four crops of the film of 64 x 48 pixels, whose borders are not those of tiles.
  void expectCropsOf(const std::string& command) const {
    succeed("vpl-render", command + " --quiet -o " + path("whole.exr"));
    const Image whole = readExr(at("whole.exr"));
    EXPECT_FALSE(whole.dataWindow);
    size_t pixels = 0;
    for (const PixelBox& box : {PixelBox{0, 0, 29, 21}, PixelBox{29, 0, 64, 21},
                                PixelBox{0, 21, 29, 48}, PixelBox{29, 21, 64, 48}}) {
      const std::string text = std::to_string(box.x0) + "," + std::to_string(box.y0) + "," +
                               std::to_string(box.x1) + "," + std::to_string(box.y1);
      succeed("vpl-render", command + " --quiet --crop " + text + " -o " + path("crop.exr"));
      const Image crop = readExr(at("crop.exr"));
      EXPECT_EQ(crop.dataWindow, box);
      EXPECT_EQ(crop.camera, whole.camera);
      ASSERT_EQ(crop.width, whole.width);
      ASSERT_EQ(crop.channels.size(), whole.channels.size());
      for (const ImageChannel& channel : whole.channels) {
        const std::vector<float>& part = *crop.find(channel.name);
        for (int y = box.y0; y < box.y1; ++y) {
          for (int x = box.x0; x < box.x1; ++x) {
            const auto i = static_cast<size_t>(y * whole.width + x);
            ASSERT_EQ(part[i], channel.data[i]) << command << channel.name << x << ' ' << y;
          }
        }
      }
      pixels += static_cast<size_t>((box.x1 - box.x0) * (box.y1 - box.y0));
    }
    EXPECT_EQ(pixels, whole.pixelCount());
  }
};

TEST_F(Crop, CropsAssembleIntoTheImage) {
  makeStages(scene_);
  const std::string vpls = scene_ + " " + path("lit.vpl") + " --fireflies keep --layers all";
  expectCropsOf(vpls + " --spp 4");
  expectCropsOf(vpls + " --spp 2 --integrator guided");
  expectCropsOf(vpls + " --spp 2 --gather interleaved --interleave 5");
  expectCropsOf(scene_ + " --integrator path --spp 3 --layers all --pixels half");
  expectCropsOf(scene_ + " --integrator light --spp 4");
}

TEST_F(Crop, CropsGoInShards) {
  const std::string render =
      scene_ + " --integrator path --spp 2 --layers all --crop 3,4,50,30 --quiet -o ";
  succeed("vpl-render", render + path("crop.exr"));
  succeed("vpl-render", render + path("1.shard") + " --shard 1/2");
  succeed("vpl-render", render + path("2.shard") + " --shard 2/2");
  succeed("vpl-merge",
          path("1.shard") + " " + path("2.shard") + " --quiet -o " + path("merged.exr"));
  EXPECT_EQ(readAll(at("merged.exr")), readAll(at("crop.exr")));
  EXPECT_TRUE(contains(tool("vpl-inspect", "check " + path("crop.exr")).out, "OK"));
}

TEST_F(Crop, ThatOfTheWholeFilmIsTheImage) {
  const std::string render = scene_ + " --integrator path --spp 1 --quiet -o ";
  succeed("vpl-render", render + path("whole.exr"));
  succeed("vpl-render", render + path("crop.exr") + " --crop 0,0,64,48");
  EXPECT_TRUE(contains(tool("vpl-inspect", "check " + path("crop.exr")).out, "OK"));
  const Image whole = readExr(at("whole.exr")), crop = readExr(at("crop.exr"));
  EXPECT_FALSE(crop.dataWindow);
  EXPECT_EQ(*crop.find("R"), *whole.find("R"));
}

TEST_F(Crop, ThePreviewHasThePixelsOfTheCrop) {
  succeed("vpl-render", scene_ + " --integrator path --spp 1 --crop 3,4,50,30 --quiet -o " +
                            path("x.exr") + " --png " + path("x.png"));
  EXPECT_EQ(readAll(at("x.png")).substr(16, 8), std::string("\0\0\0\x2f\0\0\0\x1a", 8));
}

TEST_F(Crop, WhatCannotWorkIsRefused) {
  const std::string render = scene_ + " --integrator path --spp 8 -o " + path("x.exr") + " --crop=";
  for (const char* bad :
       {"1,2,3", "1,2,3,4,5", "5,0,5,9", "0,9,9,4", "-1,0,4,4", "a,b,c,d", "0,0,4294967304,8"})
    fail("vpl-render", render + bad, kExitUsage, {"--crop", "such as 0,0,320,240"});
  fail("vpl-render", render + "0,0,65,48", kExitUsage, {"--crop", "64x48"});
  fail("vpl-render", render + "0,0,8,8 --passes 2", kExitUsage, {"--crop", "give --spp"});
  makeStages(scene_);
  fail("vpl-render", scene_ + " " + path("lit.vpl") + " -o " + path("x.exr") + " --crop 0,0,8,8",
       kExitUsage, {"--crop", "add --fireflies keep", "--shard"});
}

}  // namespace
}  // namespace bnvpl
