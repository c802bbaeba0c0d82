// `group` of [[light]]: which lights have which, and what is refused.
#include "tests/scene/scene_files.h"
#include "transport/lights/lights.h"

namespace bnvpl {
namespace {

class LightGroups : public SceneFiles {
 protected:
  void SetUp() override {
    write("square.obj", kSquareObj);
    write("square.mtl", "newmtl paint\nKd 1 1 1\nKe 1 2 3\n");
  }
  Scene lit(const std::string& lights) const {
    return load("[[mesh]]\nfile = \"square.obj\"\n" + lights);
  }
  std::string errorOf(const std::string& keys) const {
    return loadError("[[mesh]]\nfile = \"square.obj\"\n" + point(keys));
  }
  static std::string point(const std::string& keys) {
    return "[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\npower = [1, 1, 1]\n" + keys + "\n";
  }
  static std::string group(const std::string& name) { return "group = \"" + name + "\"\n"; }
};

TEST_F(LightGroups, EveryKindOfLightCanHaveOne) {
  const Scene s = lit(
      "[[light]]\ntype = \"material\"\nmaterial = \"paint\"\n" + group("lamps") + point("") +
      "[[light]]\ntype = \"disk\"\nradius = 1\nposition = [0, 9, 0]\ndirection = [0, 1, 0]\n" +
      "power = [1, 1, 1]\n" + group("Key_1") +
      "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0]\nirradiance = [1, 1, 1]\n" + group("sky") +
      "[[light]]\ntype = \"environment\"\nradiance = [1, 1, 1]\n" + group("sky"));
  EXPECT_EQ(s.lightGroups, (std::vector<std::string>{"default", "Key_1", "lamps", "sky"}));
  const Accelerator accel(s);
  const LightSet lights(accel);
  std::vector<uint32_t> groups;
  for (size_t i = 0; i < lights.size(); ++i) groups.push_back(lights.group(i));
  EXPECT_EQ(groups, (std::vector<uint32_t>{2, 1, 0, 3, 3}));
  EXPECT_EQ(s.materials.at(s.triangles.at(0).material).emission, Vec3(1, 2, 3))
      << "with a group alone, a material emits as its file says";
}

TEST_F(LightGroups, OnlyGroupsChangeTheHash) {
  const uint64_t none = lit(point("")).contentHash, key = lit(point(group("key"))).contentHash;
  EXPECT_EQ(lit(point(group("default"))).contentHash, none);
  EXPECT_NE(key, none);
  EXPECT_NE(lit(point(group("rim"))).contentHash, key);
}

TEST_F(LightGroups, WrongNamesAreRefused) {
  for (const std::string& name : {std::string(), std::string("a.b"), std::string("a b"),
                                  std::string("\u00e4"), std::string(41, 'a')}) {
    const std::string error = errorOf(group(name));
    EXPECT_NE(error.find("use 1 to 40 letters, digits, '_' and '-'"), std::string::npos)
        << name << ": " << error;
    EXPECT_NE(error.find("scene.toml:7: [[light]]"), std::string::npos) << error;
  }
  EXPECT_NE(errorOf("grup = \"key\"\n").find("did you mean 'group'?"), std::string::npos);
  EXPECT_NE(errorOf("group = 3\n").find("'group'"), std::string::npos);
  std::string many;
  for (int i = 0; i < 31; ++i) many += point(group("g" + std::to_string(i)));
  EXPECT_EQ(lit(many).lightGroups.size(), 32u);
  EXPECT_NE(errorOf(many.substr(many.find("group")) + point(group("one-more")))
                .find("more than 31 light groups"),
            std::string::npos);
  const std::string sides =
      loadError("[[light]]\ntype = \"material\"\nmaterial = \"paint\"\nsides = 2\n" + group("key"));
  EXPECT_NE(sides.find("'sides' needs 'radiance'"), std::string::npos) << sides;
}

}  // namespace
}  // namespace bnvpl
