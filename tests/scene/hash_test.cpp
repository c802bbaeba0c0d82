// The content hash changes with everything that light transport depends on, and with nothing else.
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

class ContentHash : public SceneFiles {
 protected:
  const std::string mtl_ = "newmtl paint\nKd 0.5 0.5 0.5\nmap_Kd paint.tga\n";
  const std::string light_ =
      "[[light]]\ntype = \"point\"\nposition = [0, 0, 1]\nintensity = [1, 1, 1]\n";

  void SetUp() override { writeTexture(7); }
  void writeTexture(uint8_t value) const {
    write("paint.tga", tga(2, 1, {{value, 0, 0, 255}, {9, 9, 9, 255}}));
  }
  uint64_t hash(const std::string& obj, const std::string& mtl, const std::string& more,
                const std::string& meshKeys = "") const {
    return loadMesh(obj, mtl, meshKeys, more).contentHash;
  }
  uint64_t base() const { return hash(kSquareObj, mtl_, light_); }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(ContentHash, SameFilesSameHash) { EXPECT_EQ(base(), base()); }

TEST_F(ContentHash, DoesNotDependOnTheFolder) {
  const uint64_t here = base();
  for (const char* name : {"scene.toml", "square.obj", "square.mtl", "paint.tga"}) {
    fs::create_directories(at("elsewhere"));
    fs::copy_file(at(name), at("elsewhere") / name);
  }
  EXPECT_EQ(loadScene(at("elsewhere/scene.toml")).contentHash, here);
}

TEST_F(ContentHash, DoesNotDependOnCameraAndFilm) {
  const uint64_t before = base();
  std::string toml = kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n" + light_;
  for (const auto& [from, to] :
       {std::pair{"width = 8", "width = 80"}, std::pair{"[0.0, 0.0, 5.0]", "[1.0, 0.0, 4.0]"},
        std::pair{"40.0", "55.0"}}) {
    toml = replaced(toml, from, to);
    EXPECT_EQ(load(toml).contentHash, before) << to;
  }
}

TEST_F(ContentHash, FollowsEverythingElse) {
  std::vector<uint64_t> hashes{base()};
  hashes.push_back(hash(replaced(kSquareObj, "v 1 1 0", "v 1 1 0.001"), mtl_, light_));
  hashes.push_back(hash(replaced(kSquareObj, "vt 1 1", "vt 1 0.9"), mtl_, light_));
  hashes.push_back(
      hash(replaced(kSquareObj, "f 1/1 2/2 3/3 4/4", "f 4/4 3/3 2/2 1/1"), mtl_, light_));
  hashes.push_back(hash(kSquareObj, mtl_, light_, "translate = [0.0, 0.1, 0.0]\n"));
  hashes.push_back(hash(kSquareObj, replaced(mtl_, "0.5 0.5 0.5", "0.5 0.5 0.6"), light_));
  for (const char* field : {"Ke 1 0 0\n", "Ke 1 0 0\nemission_sides 2\n", "Ks 0.1 0.1 0.1\n",
                            "Ks 0.1 0.1 0.1\nNs 15\n", "illum 7\n", "illum 7\nNi 1.4\n", "d 0.3\n",
                            "map_d paint.tga\n", "map_Ks paint.tga\nKs 0.1 0.1 0.1\n"}) {
    hashes.push_back(hash(kSquareObj, mtl_ + field, light_));
  }
  hashes.push_back(hash(kSquareObj, mtl_, ""));
  hashes.push_back(hash(kSquareObj, mtl_, replaced(light_, "[1, 1, 1]", "[1, 1, 2]")));
  hashes.push_back(hash(kSquareObj, mtl_, replaced(light_, "[0, 0, 1]", "[0, 0, 2]")));
  hashes.push_back(hash(kSquareObj, mtl_, light_ + light_));
  hashes.push_back(hash(kSquareObj, replaced(mtl_, "map_Kd", "map_Kd -s 2 2 1"), light_));
  writeTexture(8);
  hashes.push_back(base());
  for (size_t i = 0; i < hashes.size(); ++i) {
    for (size_t j = 0; j < i; ++j)
      EXPECT_NE(hashes[i], hashes[j]) << "changes " << i << " and " << j;
  }
}

TEST_F(ContentHash, FollowsLightsAtInfinity) {
  std::vector<uint64_t> hashes;
  for (const char* keys :
       {"direction = [0, -1, 0]\nirradiance = [1, 1, 1]\n",
        "direction = [0, -1, 0.1]\nirradiance = [1, 1, 1]\n",
        "direction = [0, -1, 0]\nirradiance = [1, 2, 1]\n",
        "direction = [0, -1, 0]\nirradiance = [1, 1, 1]\nangular_diameter_deg = 0.5\n"}) {
    hashes.push_back(
        hash(kSquareObj, mtl_, std::string("[[light]]\ntype = \"directional\"\n") + keys));
  }
  for (const char* keys : {"", "rotate_deg = 10\n", "scale = 2\n"}) {
    hashes.push_back(
        hash(kSquareObj, mtl_,
             std::string("[[light]]\ntype = \"environment\"\nimage = \"paint.tga\"\n") + keys));
  }
  writeTexture(9);
  hashes.push_back(hash(kSquareObj, "newmtl paint\nKd 1 1 1\n",
                        "[[light]]\ntype = \"environment\"\nimage = \"paint.tga\"\n"));
  for (size_t i = 0; i < hashes.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_NE(hashes[i], hashes[j]) << i << " and " << j;
  }
}

}  // namespace
}  // namespace bnvpl
