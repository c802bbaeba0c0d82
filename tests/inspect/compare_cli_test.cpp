// `vpl-inspect compare` on the command line: masks, FLIP and pictures.
#include "formats/image/png_io.h"
#include "tests/inspect/foreign_exr.h"
#include "tests/inspect/run_inspect.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class CompareCli : public InspectTest {
 protected:
  CompareCli() {
    Image a = flatImage(4, 3, 3, 3, 3);
    for (const char* name : {"N.X", "N.Y", "N.Z"}) a.add(name).assign(12, 0.5f);
    writeExr(at("a.exr"), a, ExrPixelType::Float);
    Image b = flatImage(4, 3, 2, 2, 2);
    for (const char* name : {"N.X", "N.Y", "N.Z"}) b.add(name).assign(12, 0.5f);
    b.channels[0].data[0] = 3.0f;
    writeExr(at("b.exr"), b, ExrPixelType::Float);
  }
  std::string path(const std::string& name) const { return "'" + at(name).string() + "'"; }
  std::string both() const { return "compare " + path("a.exr") + " " + path("b.exr") + " "; }
  Json json(const std::string& options) const {
    const Outcome result = runInspect(both() + "--json " + options);
    EXPECT_EQ(result.code, kExitOk) << result.output;
    return Json::parse(result.output, nullptr, false);
  }
};

TEST_F(CompareCli, FlipIsAlwaysThereForLight) {
  const Json flip = json("--exposure -3 --flip-exposures -2:2.5 --ppd 30");
  EXPECT_GT(flip["flip"].get<double>(), 0.05);
  EXPECT_GT(flip["hdr_flip"].get<double>(), 0.05);
  EXPECT_EQ(flip["flip_settings"]["exposure_ev"], -3.0);
  EXPECT_EQ(flip["flip_settings"]["hdr_start_ev"], -2.0);
  EXPECT_EQ(flip["flip_settings"]["hdr_stop_ev"], 2.5);
  EXPECT_EQ(flip["flip_settings"]["hdr_exposures"], 5);
  EXPECT_EQ(flip["flip_settings"]["pixels_per_degree"], 30.0);
  EXPECT_EQ(json("--layer N")["flip"], nullptr);
  EXPECT_TRUE(contains(runInspect(both()).output, "HDR-FLIP"));
  EXPECT_TRUE(contains(runInspect(both()).output, "14 exposures from -4 to +10 EV"));
}

TEST_F(CompareCli, ExposuresMayComeFromTheReference) {
  const Json flip = json("--flip-exposures auto");
  EXPECT_LT(flip["flip_settings"]["hdr_start_ev"].get<double>(), 0.1);
  EXPECT_NE(flip["flip_settings"]["hdr_start_ev"], -4.0);
  EXPECT_EQ(flip["flip_settings"]["exposure_ev"], -3.5);  // log2(0.18 / 2), rounded to a quarter
}

// Options of FLIP alone have no effect where no FLIP is computed.
TEST_F(CompareCli, OptionsOfFlipNeedColours) {
  for (const char* option : {"--exposure 3", "--ppd 3", "--flip-exposures 0:1"}) {
    const Outcome result = runInspect(both() + "--layer N " + option);
    EXPECT_EQ(result.code, kExitUsage) << result.output;
    const std::string name = std::string(option).substr(0, std::string(option).find(' '));
    EXPECT_TRUE(contains(result.output, name + " needs R, G, B, but layer 'N'")) << result.output;
    EXPECT_EQ(runInspect(both() + option).code, kExitOk);
  }
}

TEST_F(CompareCli, EmptyValuesAreRefusedByName) {
  for (const char* option : {"--second-half", "--mask", "--diff", "--exposure", "--flip-exposures",
                             "--layer", "--layer-a", "--stats"}) {
    const Outcome result = runInspect(both() + option + " ''");
    EXPECT_EQ(result.code, kExitUsage) << option;
    EXPECT_TRUE(contains(result.output, std::string(option) + ": '' is empty")) << result.output;
  }
  const Outcome scene = runInspect("check " + path("a.exr") + " --scene ''");
  EXPECT_EQ(scene.code, kExitUsage);
  EXPECT_TRUE(contains(scene.output, "--scene: '' is empty")) << scene.output;
}

TEST_F(CompareCli, NumbersAreDecimal) {
  for (const char* option : {"--ppd", "--epsilon", "--max-rmse", "--exposure"}) {
    for (const char* number : {"0x10", "' 5'", "+5", "5x"}) {
      const Outcome result = runInspect(both() + option + " " + number);
      EXPECT_EQ(result.code, kExitUsage) << option << " " << number;
      EXPECT_TRUE(contains(result.output, option)) << result.output;
    }
  }
  const Outcome range = runInspect(both() + "--diff d.png --diff-range 0x10");
  EXPECT_TRUE(contains(range.output, "'0x10' is not a number from 0.000001 to 1000000"))
      << range.output;
  EXPECT_EQ(runInspect("plot a.vpl --scene s.toml -o p.png --dot 0x10").code, kExitUsage);
  const Outcome dot = runInspect("plot a.vpl --scene s.toml -o p.png --dot 200");
  EXPECT_TRUE(contains(dot.output, "--dot: '200' is out of range: from 1 to 100")) << dot.output;
}

TEST_F(CompareCli, OptionsThatMakeNoSenseExitWith2) {
  for (const char* options :
       {"--flip-exposures 4", "--flip-exposures 4:2", "--flip-exposures a:b",
        "--flip-exposures 0:99", "--flip-exposures nan:2", "--exposure bright", "--exposure 1x",
        "--ppd 0", "--map flip", "--diff-range 1", "--map heat --diff x.png"}) {
    const Outcome result = runInspect(both() + options);
    EXPECT_EQ(result.code, kExitUsage) << options << ": " << result.output;
  }
  const Outcome normals = runInspect(both() + "--layer N --map flip --diff " + path("d.png"));
  EXPECT_EQ(normals.code, kExitUsage);
  EXPECT_TRUE(contains(normals.output, "layer 'N'")) << normals.output;
  EXPECT_FALSE(fs::exists(at("d.png")));
}

// Layers of positions and normals have such means.
TEST_F(CompareCli, AnErrorOverANegativeMeanIsPositive) {
  Image minus = readExr(at("b.exr"));
  for (const float value : {-1.0f, -2.0f}) {
    for (ImageChannel& channel : minus.channels) std::ranges::fill(channel.data, value);
    writeExr(at(value > -2.0f ? "one.exr" : "two.exr"), minus, ExrPixelType::Float);
  }
  const std::string pair = "compare " + path("one.exr") + " " + path("two.exr");
  const Json found = Json::parse(runInspect(pair + " --json").output);
  EXPECT_NEAR(found["rmse_over_mean"].get<double>(), 0.5, 1e-6);
  EXPECT_EQ(runInspect(pair + " --max-rmse-over-mean 0.4").code, kExitDifferent);
  EXPECT_EQ(runInspect(pair + " --max-rmse-over-mean 0.6").code, kExitOk);
}

TEST_F(CompareCli, AMaskChoosesThePixels) {
  std::vector<uint8_t> rgb8(4 * 3 * 3, 0);
  rgb8[0] = rgb8[1] = rgb8[2] = 255;
  writePng(at("first.png"), 4, 3, rgb8);
  EXPECT_EQ(json("--mask " + path("first.png"))["channels"][0]["rmse"], 0.0);
  EXPECT_EQ(json("--mask " + path("first.png"))["mask_pixels"], 1.0);
  EXPECT_EQ(json("")["mask_pixels"], nullptr);
  writePng(at("small.png"), 3, 4, rgb8);
  const Outcome wrong = runInspect(both() + "--mask " + path("small.png"));
  EXPECT_EQ(wrong.code, kExitInput);
  EXPECT_TRUE(contains(wrong.output, "small.png: 3 x 4") &&
              contains(wrong.output, "b.exr has 4 x 3"))
      << wrong.output;
}

// A crop has the measures of a mask of its window, against the whole image and another crop.
TEST_F(CompareCli, CropsCountWhereTheyHavePixels) {
  Image crop = readExr(at("a.exr"));
  crop.dataWindow = PixelBox{0, 0, 2, 2};
  for (ImageChannel& channel : crop.channels)
    for (size_t i = 0; i < 12; ++i)
      if (i % 4 >= 2 || i / 4 >= 2) channel.data[i] = 0.0f;
  writeExr(at("crop.exr"), crop, ExrPixelType::Float);
  std::vector<uint8_t> rgb8(4 * 3 * 3, 0);
  for (const size_t i : {0u, 1u, 4u, 5u}) rgb8[3 * i] = rgb8[3 * i + 1] = rgb8[3 * i + 2] = 255;
  writePng(at("window.png"), 4, 3, rgb8);
  const Json masked = json("--mask " + path("window.png"));
  for (const std::string& pair : {path("crop.exr") + " " + path("b.exr")}) {
    const Outcome r = runInspect("compare " + pair + " --json");
    ASSERT_EQ(r.code, kExitOk) << r.output;
    const Json cropped = Json::parse(r.output);
    EXPECT_EQ(cropped["channels"], masked["channels"]);
    EXPECT_EQ(cropped["mask_pixels"], 4.0);
  }
  // FLIP sees the same surroundings in both: as if the reference were a crop, too.
  Image reference = readExr(at("b.exr"));
  reference.dataWindow = crop.dataWindow;
  writeExr(at("crop-b.exr"), reference, ExrPixelType::Float);
  const auto measured = [&](const char* b) {
    return Json::parse(
        runInspect("compare " + path("crop.exr") + " " + path(b) + " --json").output);
  };
  const Json ofWhole = measured("b.exr"), ofCrop = measured("crop-b.exr");
  for (const char* measure : {"flip", "hdr_flip", "rmse"})
    EXPECT_EQ(ofWhole[measure], ofCrop[measure]) << measure;
  crop.dataWindow = PixelBox{2, 0, 4, 2};
  writeExr(at("other.exr"), crop, ExrPixelType::Float);
  const Outcome apart = runInspect("compare " + path("crop.exr") + " " + path("other.exr"));
  EXPECT_EQ(apart.code, kExitInput);
  EXPECT_TRUE(contains(apart.output, "crop both alike")) << apart.output;
}

TEST_F(CompareCli, EveryMapIsAnotherPicture) {
  std::vector<std::string> pictures;
  for (const char* map : {"difference", "relmse", "smape", "flip", "hdr-flip"}) {
    const Outcome result = runInspect(both() + "--diff " + path("d.png") + " --map " + map);
    EXPECT_EQ(result.code, kExitOk) << result.output;
    for (const std::string& other : pictures) EXPECT_NE(other, readAll(at("d.png"))) << map;
    pictures.push_back(readAll(at("d.png")));
  }
  runInspect(both() + "--diff " + path("d.png"));
  EXPECT_EQ(readAll(at("d.png")), pictures[0]);
  runInspect(both() + "--diff " + path("d.png") + " --map smape --diff-range 0.5");
  EXPECT_NE(readAll(at("d.png")), pictures[2]);
  EXPECT_EQ(runInspect(both() + "--diff " + path("absent/d.png")).code, kExitOutput);
}

TEST_F(CompareCli, BothHalvesMakeTheReferenceOfFlipAndMaps) {
  writeExr(at("s.exr"), flatImage(4, 3, 4, 4, 4), ExrPixelType::Float);  // mean with c: 3, as in a
  writeExr(at("c.exr"), flatImage(4, 3, 2, 2, 2), ExrPixelType::Float);
  const Outcome result = runInspect("compare " + path("a.exr") + " " + path("c.exr") +
                                    " --second-half " + path("s.exr") + " --json --exposure -3");
  const Json halves = Json::parse(result.output, nullptr, false);
  EXPECT_EQ(halves["flip"], 0.0) << result.output;
  EXPECT_EQ(halves["hdr_flip"], 0.0);
  EXPECT_EQ(halves["smape"], 0.0);
  EXPECT_GT(json("--exposure -3")["flip"].get<double>(), 0.0);
}

TEST_F(CompareCli, TheSecondHalfHasNoiseOfItsOwn) {
  for (const char* same : {"a.exr", "b.exr"}) {
    fs::copy_file(at(same), at("copy.exr"), fs::copy_options::overwrite_existing);
    for (const char* second : {same, "copy.exr"}) {
      const Outcome result = runInspect(both() + "--second-half " + path(second));
      EXPECT_EQ(result.code, kExitInput);
      EXPECT_TRUE(contains(result.output, "holds the same pixels as")) << result.output;
    }
  }
}

// The halves lie on both sides of the image: (2 - 1) (2 - 3) < 0.
TEST_F(CompareCli, AnErrorBelowTheNoiseIsReportedAsSuch) {
  for (const auto& [name, value] : {std::pair{"x.exr", 2.0f}, {"y.exr", 1.0f}, {"z.exr", 3.0f}})
    writeExr(at(name), flatImage(4, 3, value, value, value), ExrPixelType::Float);
  const std::string files = "compare " + path("x.exr") + " " + path("y.exr");
  const Outcome result = runInspect(files + " --second-half " + path("z.exr"));
  EXPECT_TRUE(contains(result.output, "RMSE           0   (below the reference's noise)"))
      << result.output;
  EXPECT_FALSE(contains(runInspect(files).output, "below the reference's noise"));
}

TEST_F(CompareCli, OtherScenesAndViewsAreNamed) {
  const auto show = [&](const char* name, const char* scene, const char* view, float value) {
    Image image = flatImage(4, 3, value, value, value);
    image.attributes["bnvpl.provenance"] =
        std::string(R"([{"tool":"vpl-render","inputs":{"scene":")") + scene +
        R"("},"view":{"size":"4x3","hash":")" + view + "\"}}]";
    writeExr(at(name), image, ExrPixelType::Float);
  };
  const auto compare = [&] {
    return runInspect("compare " + path("p.exr") + " " + path("q.exr")).output;
  };
  show("p.exr", "0123456789abcdef", "00000000000000aa", 1.0f);
  show("q.exr", "0123456789abcdef", "00000000000000aa", 2.0f);
  EXPECT_FALSE(contains(compare(), "warning")) << compare();
  show("q.exr", "0123456789abcdef", "00000000000000bb", 2.0f);
  EXPECT_TRUE(contains(compare(), "show different views of one scene")) << compare();
  show("q.exr", "fedcba9876543210", "00000000000000aa", 2.0f);
  EXPECT_TRUE(contains(compare(), "show different scenes")) << compare();
}

TEST_F(CompareCli, TheSecondHalfIsCheckedToo) {
  Image bad = flatImage(4, 3, 2, 2, 2);
  bad.channels[1].data[5] = INFINITY;
  writeForeignExr(at("bad.exr"), bad);
  const Outcome result = runInspect(both() + "--second-half " + path("bad.exr"));
  EXPECT_EQ(result.code, kExitInput);
  EXPECT_TRUE(contains(result.output, "bad.exr: channel G is not finite")) << result.output;
}

}  // namespace
}  // namespace bnvpl
