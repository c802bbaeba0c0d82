// The sides of a film have one limit, wherever they are given.
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

class Limits : public PipelineTest {
 protected:
  // A scene with the given film and a missing mesh; an error about the mesh accepts the film.
  std::string film(const std::string& width, const std::string& height) const {
    write("film.toml", "[film]\nwidth = " + width + "\nheight = " + height +
                           "\n[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\n"
                           "vertical_fov_deg = 40\n[[mesh]]\nfile = \"lost.obj\"\n");
    return path("film.toml");
  }
  const std::string path_ = " --integrator path --spp 1 -o " + path("x.exr");
};

TEST_F(Limits, TheFilmOfTheSceneAndSizeHaveTheSame) {
  for (const char* beyond : {"16385", "65536", "4294967297"}) {
    for (const auto& [width, height] : {std::pair<std::string, std::string>{beyond, "1"},
                                        std::pair<std::string, std::string>{"1", beyond}}) {
      fail("vpl-render", film(width, height) + path_, kExitInput, {"[film]", "from 1 to 16384"});
      fail("vpl-render", scene_ + path_ + " --size " + width + "x" + height, kExitUsage,
           {"--size", "from 1 to 16384"});
    }
  }
  fail("vpl-render", film("16384", "16384") + path_, kExitInput, {"lost.obj"});
  succeed("vpl-render", scene_ + path_ + " --size 16384x1");
}

}  // namespace
}  // namespace bnvpl
