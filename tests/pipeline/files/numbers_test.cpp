// Extreme films, counts and intensities through the executables; the stages are in tests/numbers.
#include <cmath>

#include "formats/image/exr_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/files/json_text.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using Numbers = PipelineTest;

void expectFinite(const fs::path& exr) {
  const Image image = readExr(exr);
  for (const ImageChannel& channel : image.channels) {
    for (const float v : channel.data) {
      ASSERT_TRUE(std::isfinite(v) || isDepth(channel.name)) << exr << " " << channel.name;
    }
  }
}

TEST_F(Numbers, FilmsOfOnePixelAndOfOneRow) {
  makeStages(scene_);
  for (const std::string size : {"1x1", "16384x1", "1x16384"}) {
    for (const std::string seed : {"1", "2"}) {
      succeed("vpl-render", scene_ + " " + path("lit.vpl") + " -o " + path(seed + ".exr") +
                                " --spp 1 --near-field-rays 2 --layers all --png " + path("i.png") +
                                " --size " + size + " --seed " + seed);
    }
    expectFinite(at("1.exr"));
    succeed("vpl-inspect", "check " + path("1.exr"));
    succeed("vpl-inspect", "info " + path("1.exr"));
    for (const std::string other : {"1", "2"}) {
      const Outcome compared =
          tool("vpl-inspect", "compare " + path("1.exr") + " " + path(other + ".exr") + " --diff " +
                                  path("d.png"));
      EXPECT_EQ(compared.code, kExitOk) << size << compared.err;
      EXPECT_FALSE(contains(compared.out, " nan") || contains(compared.out, " inf"))
          << compared.out;
    }
  }
}

// One candidate and one VPL pass through every tool.
TEST_F(Numbers, OneVpl) {
  succeed("vpl-place", scene_ + " -n 1 -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 1 -o " + path("v.vpl"));
  succeed("vpl-estimate", scene_ + " " + path("v.vpl") + " --photons 1k -o " + path("l.vpl"));
  for (const std::string gather : {"tilecuts", "lightcuts", "all"}) {
    succeed("vpl-render",
            scene_ + " " + path("l.vpl") + " --spp 1 --gather " + gather + " -o " + path("i.exr"));
    expectFinite(at("i.exr"));
  }
  succeed("vpl-inspect", "check " + path("c.vpl") + " " + path("v.vpl") + " " + path("l.vpl"));
  for (const char* file : {"c.vpl", "v.vpl", "l.vpl"}) {
    const Outcome info = tool("vpl-inspect", "info " + path(file));
    EXPECT_EQ(info.code, kExitOk) << info.err;
    EXPECT_FALSE(contains(info.out, "nan") || contains(info.out, "inf ")) << info.out;
    succeed("vpl-inspect", "export " + path(file) + " -o " + path("x.ply"));
  }
  succeed("vpl-inspect", "plot " + path("l.vpl") + " --scene " + scene_ + " -o " + path("p.png"));
}

TEST_F(Numbers, CountsBeyond32Bits) {
  makeStages(scene_);
  const std::string out = " -o " + path("x");
  fail("vpl-place", scene_ + out + " -n 5G", kExitUsage, {"2^31"});
  fail("vpl-eliminate", path("candidates.vpl") + out + " -n 5G", kExitInput, {"5000000000 of 300"});
  fail("vpl-estimate", scene_ + " " + path("vpls.vpl") + out + " --photons 100G", kExitUsage,
       {"2^36"});
  // The run is still busy after a second and reports nothing except the interruption.
  Outcome busy;
  for (const char* seconds : {"1", "4", "16"}) {  // a busy machine may take long to begin
    busy = shell(std::string("timeout ") + seconds + " '" BNVPL_BIN "/vpl-estimate' " + scene_ +
                 " " + path("vpls.vpl") + out + " --photons 5G");
    if (contains(busy.err, "interrupted")) break;
  }
  EXPECT_EQ(busy.code, 124) << busy.err;
  EXPECT_TRUE(contains(busy.err, "interrupted")) << busy.err;
  fail("vpl-render", scene_ + " " + path("lit.vpl") + out + " --spp 5G", kExitUsage, {"2^32"});
}

// The sky is nearly as bright as floats allow; no VPLs are used.
TEST_F(Numbers, PathsBearLightOfAnyStrength) {
  write("small.obj",
        "mtllib s.mtl\nusemtl grey\nv -0.01 0 -0.01\nv -0.01 0 0.01\nv 0.01 0 0.01\nf 1 2 3\n");
  write("s.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  write("small.toml",
        "[film]\nwidth = 16\nheight = 16\n[camera]\nposition = [0, 1, 0]\nlook_at = [0, 2, -1]\n"
        "vertical_fov_deg = 40\n[[mesh]]\nfile = \"small.obj\"\n"
        "[[light]]\ntype = \"environment\"\nradiance = [1e30, 1e30, 1e30]\nscale = 1e8\n");
  succeed("vpl-render", path("small.toml") + " --integrator path --spp 2 -o " + path("i.exr"));
  expectFinite(at("i.exr"));
}

// All integrators that use VPLs square the intensities when they choose among VPLs.
TEST_F(Numbers, LightsThatAreTooStrongForVplsAreRefused) {
  write("two.obj",
        "mtllib s.mtl\nusemtl grey\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3 4\n"
        "v -1 1 -1\nv 1 1 -1\nf 1 4 6 5\n");
  write("s.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  write("two.toml",
        "[film]\nwidth = 16\nheight = 16\n[camera]\nposition = [0, 1, 3]\nlook_at = [0, 0, 0]\n"
        "vertical_fov_deg = 40\n[[mesh]]\nfile = \"two.obj\"\n"
        "[[light]]\ntype = \"environment\"\nradiance = [1e20, 1e20, 1e20]\n");
  makeStages(path("two.toml"));
  const std::string image = " --spp 1 -o " + path("i.exr");
  for (const std::string integrator : {"vpl", "guided"}) {
    fail("vpl-render",
         path("two.toml") + " " + path("lit.vpl") + " --integrator " + integrator + image,
         kExitInput,
         {"the environment sends out", "more than 1e17 W", "--integrator path or light"});
  }
  for (const std::string integrator : {"path", "light"})
    succeed("vpl-render", path("two.toml") + " --integrator " + integrator + image);
}

TEST_F(Numbers, EveryStageCountsNonFiniteSamples) {
  const std::string stats = " --stats " + path("s.json");
  const auto count = [&] { return Json::parse(readAll(at("s.json"))).at("non_finite_samples"); };
  succeed("vpl-place", scene_ + " -n 300 -o " + path("c.vpl") + stats);
  EXPECT_EQ(count(), 0);
  succeed("vpl-eliminate", path("c.vpl") + " -n 30 -o " + path("v.vpl"));
  succeed("vpl-estimate",
          scene_ + " " + path("v.vpl") + " --photons 1k -o " + path("l.vpl") + stats);
  EXPECT_EQ(count(), 0);
  succeed("vpl-render", scene_ + " " + path("l.vpl") + " --spp 1 -o " + path("i.exr") + stats);
  EXPECT_EQ(count(), 0);
}

// A half stores at most 65504: brighter values are clamped, counted and reported.
TEST_F(Numbers, LightBeyondHalf) {
  write("sky.obj", "mtllib s.mtl\nusemtl grey\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nf 1 2 3\n");
  write("s.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  write("sky.toml",
        "[film]\nwidth = 4\nheight = 4\n[camera]\nposition = [0, 3, 3]\nlook_at = [0, 3, 0]\n"
        "vertical_fov_deg = 20\n[[mesh]]\nfile = \"sky.obj\"\n[[light]]\ntype = \"environment\"\n"
        "radiance = [1e6, 1, 1]\n");
  const Outcome r =
      tool("vpl-render", path("sky.toml") + " --integrator path --spp 1 --pixels half" +
                             " --layers Z -o " + path("i.exr") + " --stats " + path("s.json"));
  EXPECT_EQ(r.code, kExitOk);
  EXPECT_TRUE(contains(r.err, "warning: 16 values exceed half precision")) << r.err;
  EXPECT_EQ(Json::parse(readAll(at("s.json"))).at("beyond_half"), 16);
  const Image image = readExr(at("i.exr"));
  EXPECT_EQ((*image.find("R"))[0], 65504.0f);
  EXPECT_EQ((*image.find("Z"))[0], INFINITY);
}

// A half stores nothing between 0 and 2^-24: what becomes 0 is counted and reported.
TEST_F(Numbers, LightBelowHalf) {
  write("sky.obj", "mtllib s.mtl\nusemtl grey\nv -1 0 -1\nv -1 0 1\nv 1 0 1\nf 1 2 3\n");
  write("s.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
  write("sky.toml",
        "[film]\nwidth = 4\nheight = 4\n[camera]\nposition = [0, 3, 3]\nlook_at = [0, 3, 0]\n"
        "vertical_fov_deg = 20\n[[mesh]]\nfile = \"sky.obj\"\n[[light]]\ntype = \"environment\"\n"
        "radiance = [1e-9, 0, 1]\n");
  const std::string render = path("sky.toml") + " --integrator path --spp 1 --stats " +
                             path("s.json") + " -o " + path("i.exr");
  const Outcome r = tool("vpl-render", render + " --pixels half");
  EXPECT_EQ(r.code, kExitOk);
  EXPECT_TRUE(contains(r.err, "warning: 16 values are too small for half precision")) << r.err;
  EXPECT_EQ(Json::parse(readAll(at("s.json"))).at("below_half"), 16);
  EXPECT_EQ((*readExr(at("i.exr")).find("R"))[0], 0.0f);
  EXPECT_EQ(tool("vpl-render", render).err, "");
}

}  // namespace
}  // namespace bnvpl
