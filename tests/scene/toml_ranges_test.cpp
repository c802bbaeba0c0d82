// Numbers of a [[material]] that its model cannot use are told of, with the line.
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

class TomlRanges : public SceneFiles {
 protected:
  // The warnings of a scene whose material has these keys, the first in line 13.
  std::vector<std::string> warnings(const std::string& model, const std::string& keys) const {
    write("square.obj", kSquareObj);
    write("square.mtl", "newmtl paint\nKd 1 1 1\n");
    return load(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n[[material]]\nmodel = \"" +
                model + "\"\nname = \"paint\"\n" + keys + "emission = [1, 1, 1]\n")
        .warnings;
  }
  void expectWarning(const std::string& model, const std::string& keys,
                     const std::string& wanted) const {
    const std::vector<std::string> all = warnings(model, keys);
    EXPECT_EQ(all.size(), 1u) << joined(all);
    EXPECT_EQ(countContaining(all, "scene.toml:13: [[material]]: " + wanted), 1u) << joined(all);
  }
};

TEST_F(TomlRanges, WhatIsUsedInsteadIsNamed) {
  expectWarning("metallic_roughness", "metallic = 7\n", "'metallic' is 7, outside 0 to 1; 1 is used");
  expectWarning("metallic_roughness", "roughness = -1\n",
                "'roughness' is -1, outside 0 to 1; 0 is used");
  expectWarning("metallic_roughness", "ior = 0.5\n", "'ior' is 0.5, outside 1 to 100; 1 is used");
  expectWarning("dielectric", "ior = 0\n", "'ior' is 0, outside 0.01 to 100; 0.01 is used");
  expectWarning("coated_diffuse", "ior = 0.5\n", "'ior' is 0.5, outside 1 to 100; 1 is used");
  expectWarning("conductor", "eta = [1, 200, 1]\n", "'eta' is 200, outside 0 to 100; 100 is used");
  expectWarning("diffuse", "reflectance = [3, 2, 1]\n",
                "'reflectance' is 3, outside 0 to 1; 1 is used");
  expectWarning("diffuse", "opacity = 7\n", "'opacity' is 7, outside 0 to 1; 1 is used");
  expectWarning("diffuse", "opacity_cutoff = 2\n", "'opacity_cutoff' is 2, outside 0 to 1");
  expectWarning("diffuse_transmission", "reflectance = [0.8, 0.1, 0.1]\n",
                "'reflectance' and 'transmittance' together exceed 1; both are scaled down");
}

TEST_F(TomlRanges, WhatModelsCanUseIsNot) {
  for (const auto& [model, keys] : std::vector<std::pair<std::string, std::string>>{
           {"metallic_roughness", "ior = 0\nanisotropy_turns = 3\nspecular_colour = [4, 4, 4]\n"},
           {"diffuse", "reflectance = [1, 0, 1]\nopacity_cutoff = 0\n"},
           {"dielectric", "ior = 0.5\n"},
           {"diffuse_transmission", "reflectance = [0.7, 0.7, 0.7]\ntransmittance = [0.3, 0.3, 0.3]\n"}})
    EXPECT_EQ(joined(warnings(model, keys)), "") << model;
  // A texture's factor may be anything.
  write("square.obj", kSquareObj);
  write("square.mtl", "newmtl paint\nKd 1 1 1\n");
  write("t.tga", tga(1, 1, {{9, 9, 9, 255}}));
  const Scene s = load(kFilmAndCamera +
                       "[[mesh]]\nfile = \"square.obj\"\n[[texture]]\nname = \"t\"\ntype = "
                       "\"image\"\nimage = \"t.tga\"\n[[material]]\nname = \"paint\"\nmodel = "
                       "\"diffuse\"\nreflectance = [9, 9, 9]\nreflectance_texture = \"t\"\n"
                       "emission = [1, 1, 1]\n");
  EXPECT_EQ(joined(s.warnings), "");
}

}  // namespace
}  // namespace bnvpl
