// What a stage leaves behind besides its product: summary, JSON, depfile, layers and pixel types.
#include <sstream>
#include <tuple>

#include "formats/image/exr_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/files/json_text.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using Output = PipelineTest;

// Every stage's command, in order.
std::vector<std::pair<std::string, std::string>> allStages(const std::string& scene,
                                                           const std::string& folder) {
  return {
      {"vpl-place", scene + " -o '" + folder + "/c.vpl' -n 300"},
      {"vpl-eliminate", "'" + folder + "/c.vpl' -o '" + folder + "/v.vpl' -n 60"},
      {"vpl-estimate", scene + " '" + folder + "/v.vpl' -o '" + folder + "/l.vpl' --photons 20k"},
      {"vpl-render", scene + " '" + folder + "/l.vpl' -o '" + folder + "/i.exr' --spp 1"}};
}

TEST_F(Output, QuietPrintsNothingAndOtherwiseASummary) {
  for (const auto& [name, arguments] : allStages(scene_, at("").string())) {
    const Outcome quiet = tool(name, arguments + " --quiet");
    EXPECT_EQ(quiet.code, kExitOk) << quiet.err;
    EXPECT_EQ(quiet.out + quiet.err, "") << name;
    const Outcome loud = tool(name, arguments);
    EXPECT_EQ(loud.err, "") << name;
    EXPECT_TRUE(contains(loud.out, name + ": ")) << loud.out;
    EXPECT_TRUE(contains(loud.out, "peak memory")) << loud.out;
  }
}

TEST_F(Output, WarningsGoToStderrOnce) {
  const Outcome r =
      tool("vpl-place", "'" BNVPL_SOURCE "/scenes/test/quirks.toml' -n 20 -o " + path("c.vpl"));
  EXPECT_EQ(r.code, kExitOk);
  std::istringstream lines(r.err);
  int textures = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_EQ(line.rfind("vpl-place: warning: ", 0), 0u) << line;
    textures += contains(line, "missing.png") ? 1 : 0;
  }
  EXPECT_EQ(textures, 1) << r.err;
}

// Warnings may explain the error. Warnings of an earlier tool are repeated only with an error.
TEST_F(Output, WarningsComeBeforeTheErrorThatFollows) {
  makeStages(scene_);
  const std::string view =
      "[film]\nwidth = 4\nheight = 4\n[camera]\nposition = [0, 1, 3]\nlook_at = [0, 0, 0]\n"
      "vertical_fov_deg = 40\n[[mesh]]\nfile = \"a.obj\"\n";
  write("a.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("dark.toml", view);
  write("broken.toml", view + "[[mesh]]\nfile = \"gone.obj\"\n");
  const auto expect = [&](const std::string& name, const std::string& arguments,
                          const std::string& error) {
    const Outcome r = tool(name, arguments);
    EXPECT_EQ(r.code, kExitInput) << r.err;
    std::istringstream lines(r.err);
    std::string line, before, warnings;
    for (; std::getline(lines, line); before = line)
      warnings += before.empty() ? "" : before + "\n";
    EXPECT_TRUE(contains(warnings, name + ": warning: ") &&
                contains(warnings, "gone.mtl: no such material library"))
        << name << ": " << r.err;
    EXPECT_TRUE(before.starts_with(name + ": ") && contains(before, error)) << r.err;
    EXPECT_FALSE(contains(warnings, error)) << r.err;
  };
  const std::string noLight = "has no light", noObj = "no such OBJ file", other = "made from ";
  for (const auto& [scene, light, stale] :
       {std::tuple{path("dark.toml"), noLight, other}, {path("broken.toml"), noObj, noObj}}) {
    expect("vpl-place", scene + " --method light -n 9 -o " + path("o.vpl"), light);
    expect("vpl-estimate", scene + " " + path("vpls.vpl") + " -o " + path("o.vpl"), light);
    expect("vpl-render", scene + " " + path("lit.vpl") + " -o " + path("o.exr"), stale);
    expect("vpl-inspect", "plot " + path("lit.vpl") + " --scene " + scene + " -o " + path("o.png"),
           stale);
    expect("vpl-inspect", "check " + path("lit.vpl") + " --scene " + scene, stale);
  }
  expect("vpl-render", path("broken.toml") + " --integrator path --spp 1 -o " + path("o.exr"),
         noObj);
  expect("vpl-inspect", "scene " + path("broken.toml"), noObj);
}

TEST_F(Output, StatsAreJson) {
  for (const auto& [name, arguments] : allStages(scene_, at("").string())) {
    succeed(name, arguments + " --quiet --stats " + path("s.json"));
    const Json json = Json::parse(readAll(at("s.json")));
    EXPECT_EQ(json.at("tool"), name);
    EXPECT_TRUE(std::string(json.at("version")).starts_with(BNVPL_VERSION "+"));
    EXPECT_EQ(json.at("embree"), BNVPL_EMBREE);
    EXPECT_GT(json.at("time_s").get<double>(), 0.0);
    EXPECT_GT(json.at("peak_memory_MiB").get<double>(), 1.0);
    if (name == "vpl-place") {
      EXPECT_EQ(json.at("placed"), 300);
      EXPECT_GE(json.at("paths").get<int>(), 1);
    }
    if (name == "vpl-eliminate") {
      EXPECT_EQ(json.at("candidates"), 300);
      EXPECT_EQ(json.at("kept"), 60);
    }
    if (name == "vpl-estimate") {
      const Json& energy = json.at("energy_W");
      EXPECT_NEAR(energy.at("emitted").get<double>(),
                  energy.at("escaped").get<double>() + energy.at("absorbed").get<double>(),
                  1e-3 * energy.at("emitted").get<double>());
    }
    if (name == "vpl-render") {
      EXPECT_EQ(json.at("samples"), 64 * 48);
    }
  }
}

TEST_F(Output, DepfileNamesWhatWasRead) {
  const std::string scene = copyVeachDoor();
  for (const auto& [name, arguments] : allStages(scene, at("").string())) {
    succeed(name, arguments + " --depfile " + path("d"));
    const std::string text = readAll(at("d"));
    const std::string target = arguments.substr(arguments.find("-o '") + 4);
    EXPECT_EQ(text.rfind(target.substr(0, target.find('\'')) + ":", 0), 0u) << text;
    EXPECT_EQ(text.back(), '\n');
    if (name == "vpl-eliminate") {
      EXPECT_TRUE(contains(text, "c.vpl"));
      continue;
    }
    for (const char* file : {"veach-door/scene.toml", "veach-door/room.obj", "veach-door/room.mtl",
                             "veach-door/landscape.png", "teapot/teapot.obj", "teapot/glossy.mtl",
                             "teapot/mirror.mtl"}) {
      EXPECT_TRUE(contains(text, file)) << file << " not in " << text;
    }
    EXPECT_EQ(contains(text, "v.vpl \\\n") || contains(text, "v.vpl\n"), name == "vpl-estimate")
        << text;
    EXPECT_EQ(contains(text, "l.vpl\n"), name == "vpl-render") << text;
  }
}

TEST_F(Output, DepfileEscapesSpaces) {
  fs::copy(BNVPL_SOURCE "/scenes/test", at("a folder"), fs::copy_options::recursive);
  succeed("vpl-place", path("a folder/one-bounce.toml") + " -n 10 -o " + path("c.vpl") +
                           " --depfile " + path("d"));
  EXPECT_TRUE(contains(readAll(at("d")), "a\\ folder/one-bounce.obj"));
}

TEST_F(Output, HalfAndFloatImages) {
  const std::string command = scene_ + " --integrator path --spp 1 -o ";
  succeed("vpl-render", command + path("f.exr"));
  succeed("vpl-render", command + path("h.exr") + " --pixels half");
  const Image whole = readExr(at("f.exr")), half = readExr(at("h.exr"));
  EXPECT_EQ(whole.width, 64);
  EXPECT_EQ(whole.height, 48);
  EXPECT_LT(fs::file_size(at("h.exr")), fs::file_size(at("f.exr")));
  bool rounded = false;
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>&a = *whole.find(channel), &b = *half.find(channel);
    float brightest = 0.0f;
    for (size_t i = 0; i < a.size(); ++i) {
      ASSERT_NEAR(a[i], b[i], 1e-3f * a[i] + 1e-6f);
      rounded |= a[i] != b[i];
      brightest = std::max(brightest, a[i]);
    }
    EXPECT_GT(brightest, 0.0f);
  }
  EXPECT_TRUE(rounded);
}

TEST_F(Output, ASizeOtherThanTheScenesFilm) {
  const auto pathTraced = [&](const std::string& more) {
    return scene_ + " -o " + path("i.exr") + " --integrator path --spp 1 " + more;
  };
  succeed("vpl-render", pathTraced("--quiet --size 12x7"));
  const Image image = readExr(at("i.exr"));
  EXPECT_EQ(image.width, 12);
  EXPECT_EQ(image.height, 7);
  for (const char* bad : {"12", "12x", "0x7", "12x7x3", "-3x4", "99999x1"}) {
    fail("vpl-render", pathTraced("--size=" + std::string(bad)), kExitUsage, {"--size", bad});
  }
}

TEST_F(Output, LayersAndAttributes) {
  makeStages(scene_);
  const std::string command = scene_ + " " + path("lit.vpl") + " --spp 1 -o " + path("i.exr");
  succeed("vpl-render", command);
  EXPECT_EQ(readExr(at("i.exr")).channels.size(), 3u);
  succeed("vpl-render", command + " --layers all --png " + path("i.png"));
  const Image image = readExr(at("i.exr"));
  for (const char* name : {"R", "direct.R", "indirect.G", "albedo.B", "N.X", "N.Z", "Z", "cutsize",
                           "shadowrays", "clamped.R"}) {
    EXPECT_NE(image.find(name), nullptr) << name;
  }
  EXPECT_EQ(readAll(at("i.png")).substr(1, 3), "PNG");
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    const float sum = (*image.find("direct.R"))[i] + (*image.find("indirect.R"))[i];
    ASSERT_NEAR((*image.find("R"))[i], sum, 1e-4f * sum + 1e-6f);
  }
  EXPECT_EQ(image.attributes.at("bnvpl.samplesPerPixel"), "1");
  const Json chain = Json::parse(image.attributes.at("bnvpl.provenance"));
  ASSERT_EQ(chain.size(), 4u);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(chain[i].at("tool"), kStages[i]);
  EXPECT_EQ(chain[2].at("options").at("photons"), 2000);
}

TEST_F(Output, OnlyDirectAndOnlyIndirectAddUp) {
  makeStages(scene_);
  const std::string command = scene_ + " " + path("lit.vpl") + " --spp 1 -o ";
  succeed("vpl-render", command + path("all.exr"));
  succeed("vpl-render", command + path("direct.exr") + " --only direct");
  succeed("vpl-render", command + path("indirect.exr") + " --only indirect");
  const Image all = readExr(at("all.exr")), direct = readExr(at("direct.exr")),
              indirect = readExr(at("indirect.exr"));
  double sums[3] = {0, 0, 0};
  for (size_t i = 0; i < all.pixelCount(); ++i) {
    sums[0] += double{(*all.find("G"))[i]};
    sums[1] += double{(*direct.find("G"))[i]};
    sums[2] += double{(*indirect.find("G"))[i]};
  }
  EXPECT_GT(sums[1], 0.0);
  EXPECT_GT(sums[2], 0.0);
  EXPECT_NEAR(sums[0], sums[1] + sums[2], 0.02 * sums[0]);
}

// With --only direct, the camera rays of the direct light fill the other layers.
TEST_F(Output, OnlyDirectShowsTheOtherLayers) {
  makeStages(scene_);
  const std::string command = scene_ + " " + path("lit.vpl") + " --spp 4 --layers albedo,N,Z -o ";
  succeed("vpl-render", command + path("all.exr"));
  succeed("vpl-render", command + path("direct.exr") + " --only direct");
  const Image all = readExr(at("all.exr")), direct = readExr(at("direct.exr"));
  for (const char* channel : {"albedo.R", "N.X", "N.Y", "Z"}) {
    double difference = 0.0, size = 0.0;
    for (size_t i = 0; i < all.pixelCount(); ++i) {
      const double a = double{(*all.find(channel))[i]}, b = double{(*direct.find(channel))[i]};
      if (std::isinf(a) || std::isinf(b)) continue;  // pixels that see nothing
      difference += std::abs(a - b), size += std::abs(a);
    }
    EXPECT_GT(size, 0.0) << channel;
    EXPECT_LT(difference, 0.1 * size) << channel;
  }
}

}  // namespace
}  // namespace bnvpl
