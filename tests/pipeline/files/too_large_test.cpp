// Requests that no memory could serve are refused at once, with an estimate.
#include <fstream>

#include "formats/vpl/vpl_layout.h"
#include "tests/pipeline/tool_runner.h"
#include "tests/support/sanitizers.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

constexpr const char* kFourGib = "ulimit -v 4194304;";

class TooLarge : public PipelineTest {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "sanitizers reserve terabytes of addresses";
  }
  // Header and directory of a file of a thousand million rows; the rest is a hole.
  void writeHuge(const std::string& name, VplStage stage) const {
    VplHeader header;
    header.stage = stage;
    header.count = 1000000000;
    header.provenanceBytes = 2;
    const VplLayout layout = makeLayout(stage, header.count, header.provenanceBytes);
    header.fileBytes = layout.fileBytes;
    header.columnCount = static_cast<uint32_t>(layout.directory.size());
    std::ofstream out(at(name), std::ios::binary);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    const Bytes directory = std::as_bytes(std::span(layout.directory));
    out.write(reinterpret_cast<const char*>(directory.data()),
              static_cast<std::streamsize>(directory.size()));
    out.close();
    fs::resize_file(at(name), layout.fileBytes);
  }
};

TEST_F(TooLarge, CountsAndFilms) {
  fail("vpl-place", scene_ + " -o " + path("x.vpl") + " -n 2G", kExitMemory,
       {"2000000000 VPLs needs about 74.5 GiB", "are available", "with -n"}, kFourGib);
  fail("vpl-render",
       scene_ + " --integrator path -o " + path("x.exr") + " --size 16384x16384 --spp 1",
       kExitMemory, {"16384x16384 pixels needs about 90 GiB", "--size"}, kFourGib);
  EXPECT_EQ(listing(), std::vector<std::string>{});
}

TEST_F(TooLarge, Contributions) {
  makeStages(scene_);
  fail("vpl-inspect",
       "contributions " + path("lit.vpl") + " --scene " + scene_ + " -o " + path("x.json") +
           " --size 16384x16384",
       kExitMemory, {"contributions to 16384x16384 pixels needs about", "--size"}, kFourGib);
}

TEST_F(TooLarge, LightGroupsCount) {
  write("groups.toml", "[[mesh]]\nfile = " + scene_ +
                           "\n[[light]]\ntype = \"point\"\nposition = [0.1, 0.3, 0.1]\n"
                           "power = [1, 1, 1]\ngroup = \"fill\"\n");
  const std::string render =
      path("groups.toml") + " --integrator path -o " + path("x.exr") + " --size 4096x4096";
  fail("vpl-render", render, kExitMemory, {"needs about 5.62 GiB"}, kFourGib);
  fail("vpl-render", render + " --layers light_groups", kExitMemory, {"needs about 9.41 GiB"},
       kFourGib);
}

TEST_F(TooLarge, Files) {
  writeHuge("c.vpl", VplStage::Candidates);
  writeHuge("v.vpl", VplStage::Eliminated);
  writeHuge("l.vpl", VplStage::Lit);
  fail("vpl-eliminate", path("c.vpl") + " -o " + path("x") + " -n 10", kExitMemory,
       {"c.vpl: work on its 1000000000 rows needs about 112 GiB", "vpl-place -n"}, kFourGib);
  fail("vpl-estimate", scene_ + " " + path("v.vpl") + " -o " + path("x"), kExitMemory,
       {"v.vpl", "vpl-eliminate -n"}, kFourGib);
  fail("vpl-render", scene_ + " " + path("l.vpl") + " -o " + path("x"), kExitMemory,
       {"l.vpl", "vpl-eliminate -n"}, kFourGib);
}

// An OBJ file is judged by its size before it is read, a mesh by its faces before it is built.
TEST_F(TooLarge, Scenes) {
  write("scene.toml",
        "[film]\nwidth = 4\nheight = 4\n[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\n"
        "vertical_fov_deg = 60\n[[mesh]]\nfile = \"m.obj\"\n");
  const std::string place = path("scene.toml") + " -n 10 -o " + path("x.vpl");
  write("m.obj", "v 0 0 0\n");
  fs::resize_file(at("m.obj"), uint64_t{8} << 30);
  fail("vpl-place", place, kExitMemory,
       {"m.obj: reading it needs about 8 GiB", "are available", "simplify the mesh"}, kFourGib);
  std::string face = "f";
  for (int corner = 0; corner < 1024; ++corner) face += " 1";
  std::string text = "v 0 0 0\n";
  for (int k = 0; k < 4000; ++k) text += face + "\n";
  write("m.obj", text);
  fail("vpl-place", place, kExitMemory,
       {"m.obj: a mesh of 4088000 triangles needs about 0.305 GiB", "simplify the mesh"},
       "ulimit -v 300000;");
}

}  // namespace
}  // namespace bnvpl
