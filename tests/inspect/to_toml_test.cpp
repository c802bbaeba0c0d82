// vpl-inspect scene --to-toml writes a scene equal to the original, and replaces no other files.
#include "formats/image/exr_io.h"
#include "formats/image/png_io.h"
#include "scene/choose_view.h"
#include "scene/load_scene.h"
#include "scene/visit_material.h"
#include "tests/inspect/run_inspect.h"
#include "tests/inspect/tiny_scene.h"
#include "tools/inspect/scene/scene_difference.h"

namespace bnvpl {
namespace {

const std::string kPbrtView =
    "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\nWorldBegin\n"
    "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const std::string kSquare =
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] \"integer indices\" "
    "[0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1]\n";
const std::string kView =
    "[film]\nwidth = 32\nheight = 24\n[camera]\nposition = [0, 0, 3]\nlook_at = [0, 0, 0]\n"
    "vertical_fov_deg = 40\n";

class ToToml : public InspectTest {
 protected:
  static std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }
  Outcome convert(const std::string& name, const std::string& to, const std::string& more = "") {
    return runInspect("scene " + quoted(at(name)) + " --to-toml " + quoted(at(to)) + " " + more);
  }
  // Converts the scene, converts the result again, and expects both copies to equal the original.
  Scene copyOf(const std::string& name) {
    for (const char* folder : {"copy", "copy of copy"}) {
      const Outcome done =
          convert(folder == std::string("copy") ? name : "copy/scene.toml", folder);
      EXPECT_EQ(done.code, 0) << done.output;
    }
    const Scene scene = loadScene(at(name)), copy = loadScene(at("copy/scene.toml"));
    EXPECT_EQ(sceneDifference(scene, copy), "");
    EXPECT_EQ(sceneDifference(scene, loadScene(at("copy of copy/scene.toml"))), "");
    EXPECT_TRUE(copy.warnings.empty()) << copy.warnings.front();
    return copy;
  }
  Scene copyOfPbrt(const std::string& world) {
    writeAll(at("s.pbrt"), kPbrtView + world);
    return copyOf("s.pbrt");
  }
  void writePicture(const std::string& name) const {  // 2 x 2: red, green, blue, grey
    writePng(at(name), 2, 2, std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 90, 90, 90});
  }
  template <typename Model>
  static const Model& modelOf(const Scene& scene) {
    return std::get<Model>(scene.materials.at(scene.triangles.at(0).material).model);
  }
  void writeTinyAs(const std::string& name) const {
    writeTinyScene(at("."));
    fs::rename(at("tiny.toml"), at(name));
  }
};

TEST_F(ToToml, KeepsInstances) {
  writeTinyScene(at("."));
  writeAll(at("tiny.toml"), readAll(at("tiny.toml")) +
                                "[[mesh]]\nfile = \"tiny.obj\"\nscale = 0.5\n"
                                "[[mesh.instance]]\ntranslate = [1, 2, 2]\n"
                                "[[mesh.instance]]\nrotate_deg = [0, 30, 0]\nscale = [1, -2, 1]\n");
  const Scene copy = copyOf("tiny.toml");
  ASSERT_EQ(copy.instances.size(), 2u);
  EXPECT_EQ(copy.instances[0].point({}), Vec3(1, 2, 2));
  EXPECT_EQ(copy.instances[1].mirrored, 1u);
  EXPECT_EQ(copy.prototypes.size(), 1u);
}

TEST_F(ToToml, NamesMaterialsWithoutAName) {
  writeAll(at("s.gltf"), R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":
    "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAA"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,
    "count":3,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}],
    "materials":[{"extensions":{"KHR_materials_specular":{"specularFactor":0}}}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
    "nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})");
  EXPECT_EQ(convert("s.gltf", "copy").code, 0);
  EXPECT_EQ(sceneDifference(loadScene(at("s.gltf")), loadScene(at("copy/scene.toml"))), "");
}

TEST_F(ToToml, KeepsTheSidesOfAMirroredCamera) {
  const Scene copy = copyOfPbrt("Material \"diffuse\"\n" + kSquare);
  EXPECT_EQ(copy.camera.right, Vec3(-1, 0, 0));
  EXPECT_EQ(copy.camera.up, Vec3(0, 1, 0));
}

TEST_F(ToToml, AViewMirrorsAsTheScenesCameraDoes) {
  writeAll(at("s.pbrt"), kPbrtView + "Material \"diffuse\"\n" + kSquare);
  writeAll(at("view.toml"), kView);
  writeAll(at("plain.toml"), kView + "mirrored = false\n");
  Scene scene = loadScene(at("s.pbrt"));
  useViewFile(at("view.toml"), scene);
  EXPECT_EQ(scene.camera.right, Vec3(-1, 0, 0));
  useViewFile(at("plain.toml"), scene);
  EXPECT_EQ(scene.camera.right, Vec3(1, 0, 0));
  useViewFile(at("view.toml"), scene);  // not mirrored as in the view before
  EXPECT_EQ(scene.camera.right, Vec3(-1, 0, 0));
}

TEST_F(ToToml, KeepsScaleAndTransformOfTextures) {
  writePicture("t.png");
  const Scene copy = copyOfPbrt(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.png\" \"float uscale\" 2\n"
      "  \"float vdelta\" .25 \"float scale\" .5 \"string wrap\" \"clamp\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\n" +
      kSquare);
  const uint32_t texture = modelOf<DiffuseModel>(copy).reflectance.texture;
  ASSERT_NE(texture, kNone);
  const TextureExpression& e = copy.expressions[texture];
  EXPECT_EQ(e.uv.a, 2.0f);
  EXPECT_EQ(e.uv.f, 0.25f);
  EXPECT_EQ(e.value, Vec3(0.5f));
  EXPECT_EQ(e.wrapU, Wrap::Clamp);
}

TEST_F(ToToml, KeepsTexturesMadeOfTextures) {
  writePicture("t.png");
  const Scene copy = copyOfPbrt(
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"t.png\" \"bool invert\" true\n"
      "Texture \"c\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"t\" \"rgb tex2\" [.1 .2 .3]\n"
      "  \"float uscale\" 3\n"
      "Texture \"s\" \"spectrum\" \"scale\" \"texture tex\" \"c\" \"float scale\" .5\n"
      "Texture \"m\" \"spectrum\" \"mix\" \"texture tex1\" \"s\" \"rgb tex2\" [1 1 0]\n"
      "Material \"diffuse\" \"texture reflectance\" \"m\"\n" +
      kSquare);
  EXPECT_NE(modelOf<DiffuseModel>(copy).reflectance.texture, kNone);
}

TEST_F(ToToml, KeepsLampImages) {
  writePicture("t.png");
  Image floats;
  floats.width = floats.height = 1;
  for (const char* name : {"R", "G", "B", "A"}) floats.add(name)[0] = 40.0f;
  writeExr(at("t.exr"), floats, ExrPixelType::Float);
  for (const std::string file : {"t.png", "t.exr"}) {
    const Scene copy =
        copyOfPbrt("AreaLightSource \"diffuse\" \"string filename\" \"" + file + "\"\n" + kSquare);
    EXPECT_NE(copy.materials.at(copy.triangles[0].material).emissionTexture, kNone);
    EXPECT_EQ(copy.textures.at(0).floats, std::vector(file == "t.exr" ? 4 : 0, 40.0f));
  }
}

TEST_F(ToToml, KeepsEveryModel) {
  const std::pair<const char*, std::string> kModels[] = {
      {"\"diffuse\"", "diffuse"},
      {"\"diffusetransmission\" \"rgb reflectance\" [.1 .2 .3] \"rgb transmittance\" [.3 .2 .1]",
       "diffuse_transmission"},
      {"\"conductor\" \"spectrum eta\" \"metal-Cu-eta\" \"spectrum k\" \"metal-Cu-k\" "
       "\"float uroughness\" .2 \"float vroughness\" .4",
       "conductor"},
      {"\"conductor\" \"rgb reflectance\" [.9 .5 .2] \"bool remaproughness\" false", "conductor"},
      {"\"dielectric\" \"float eta\" 1.7 \"float roughness\" .1", "dielectric"},
      {"\"thindielectric\"", "dielectric"},
      {"\"coateddiffuse\" \"rgb reflectance\" [.9 .5 .2] \"float roughness\" .3", "coated_diffuse"},
      {"\"coatedconductor\" \"float interface.roughness\" .2", "coated_conductor"},
  };
  for (const auto& [text, model] : kModels) {
    const Scene copy = copyOfPbrt(std::string("Material ") + text + "\n" + kSquare);
    EXPECT_EQ(nameOf(copy.materials.at(copy.triangles[0].material).model), model) << text;
  }
}

TEST_F(ToToml, KeepsMixesMasksAndRelief) {
  writePicture("t.png");
  const Scene copy = copyOfPbrt(
      "MakeNamedMaterial \"a\" \"string type\" \"conductor\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"string normalmap\" \"t.png\"\n"
      "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .25\n" +
      kSquare +
      "Texture \"f\" \"float\" \"imagemap\" \"string filename\" \"t.png\"\n"
      "Texture \"g\" \"float\" \"scale\" \"texture tex\" \"f\" \"float scale\" .7\n"
      "Material \"diffuse\" \"texture displacement\" \"f\"\n" +
      kSquare + "AttributeBegin\n" + kSquare.substr(0, kSquare.size() - 1) +
      " \"texture alpha\" \"f\"\nTranslate 0 0 1\n" + kSquare.substr(0, kSquare.size() - 1) +
      " \"texture alpha\" \"g\"\nTranslate 0 0 1\n" + kSquare.substr(0, kSquare.size() - 1) +
      " \"float alpha\" .2\nAttributeEnd\n");
  EXPECT_EQ(copy.maskedBegin, 4u);
  EXPECT_EQ(copy.triangles.size(), 10u);
}

TEST_F(ToToml, KeepsWhatAnMtlStates) {
  writePicture("t.png");
  writeTinyScene(at("."));
  writeAll(at("tiny.obj"), readAll(at("tiny.obj")) +
                               "vt 0 0\nvt 1 0\nvt 1 1\nusemtl lamp\nf 1/1 2/2 3/3\nusemtl glass\n"
                               "f 1 2 3\nusemtl rough\nf 1/1 2/2 3/3\nusemtl mirror\nf 5 6 7\n");
  writeAll(at("tiny.mtl"),
           readAll(at("tiny.mtl")) +
               "newmtl lamp\nKd .5 .5 .5\nmap_Kd -s 2 3 1 t.png\nKs .2 .2 .2\nNs 40\nillum 2\n"
               "map_Ks -o .25 .5 0 t.png\nKe 3 2 1\nmap_Ke -s 4 1 1 -o 0 .5 0 t.png\n"
               "emission_sides 2\nmap_Bump -bm 3 -s 2 2 1 t.png\nmap_d t.png\n"
               "newmtl glass\nillum 7\nNi 1.4\nTf .9 .8 .7\n"
               "newmtl rough\nPr .4\nKd .8 .6 .4\nmap_Pr -s 2 2 1 t.png\nPm .3\nnorm t.png\n"
               "Pc .5\nmap_d -s 3 3 1 t.png\naniso .5\nKe 1 1 1\n"
               "newmtl mirror\nillum 3\nKs .9 .9 .9\n");
  const Scene copy = copyOf("tiny.toml");
  const auto lamp = std::ranges::find_if(
      copy.materials, [](const Material& m) { return m.emission == Vec3(3, 2, 1); });
  ASSERT_NE(lamp, copy.materials.end());
  EXPECT_TRUE(lamp->twoSidedEmission);
  EXPECT_NE(lamp->emissionTexture, kNone);
  EXPECT_EQ(lamp->relief.strength, 3.0f);
}

TEST_F(ToToml, KeepsLightsFarPlacesAndNames) {
  writeTinyScene(at("."));
  writeAll(at("sky.pfm"), std::string("PF\n2 1\n-1.0\n") + std::string(24, '\0'));
  writeAll(at("tiny.mtl"), "newmtl a \"quoted\" \xc3\xa4 name\nKd 1 1 1\nPr .5\n");
  writeAll(at("tiny.obj"),
           "mtllib tiny.mtl\nv 9e6 0 0\nv 9.000001e6 0 0\nv 9e6 1 0\n"
           "usemtl a \"quoted\" \xc3\xa4 name\nf 1 2 3\n");
  writeAll(at("tiny.toml"),
           "[film]\nwidth = 8\nheight = 6\n[camera]\nposition = [9e6, 0, 4]\n"
           "forward = [0, 0.1, -1]\nvertical_fov_deg = 50.0\nshift = [0.5, 0.25]\n"
           "[[mesh]]\nfile = \"tiny.obj\"\n"
           "[[light]]\ntype = \"spot\"\nposition = [9e6, 2, 3]\nintensity = [1, 2, 3]\n"
           "direction = [0, -1, 0]\ncone_deg = 30\nfalloff_deg = 30\n"
           "[[light]]\ntype = \"directional\"\ndirection = [1, -1, 0]\nirradiance = [1, 2, 3]\n"
           "angular_diameter_deg = 0.5\n"
           "[[light]]\ntype = \"environment\"\nimage = \"sky.pfm\"\nrotate_deg = 77\nscale = 2\n");
  EXPECT_EQ(convert("tiny.toml", "copy").code, 0);
  const Scene scene = loadScene(at("tiny.toml")), copy = loadScene(at("copy/scene.toml"));
  EXPECT_EQ(sceneDifference(scene, copy), "");
  EXPECT_EQ(copy.lights.size(), 3u);
  EXPECT_NE(copy.materials.at(0).name.find("\"quoted\" \xc3\xa4 name"), std::string::npos);
}

TEST_F(ToToml, ANameThatIsNoUtf8IsWritten) {
  writeTinyScene(at("."));
  for (const char* file : {"tiny.obj", "tiny.mtl"}) {
    std::string text = readAll(at(file));
    text.replace(text.find("white"), 5, "wei\xdf");
    writeAll(at(file), text);
  }
  copyOf("tiny.toml");
}

TEST_F(ToToml, EachPartCountsInTheComparison) {
  writeTinyAs("scene.toml");
  const Scene scene = loadScene(at("scene.toml"));
  ASSERT_EQ(convert("scene.toml", "copy").code, 0);
  const auto differs = [&](const char* file, const char* from, const char* to) {
    const std::string text = readAll(at(file));
    std::string changed = text;
    EXPECT_NE(text.find(from), std::string::npos) << from << " in\n" << text;
    changed.replace(text.find(from), std::string(from).size(), to);
    writeAll(at(file), changed);
    const std::string difference = sceneDifference(scene, loadScene(at("copy/scene.toml")));
    writeAll(at(file), text);
    return difference;
  };
  EXPECT_EQ(differs("copy/scene.toml", "up = [0, 1, 0]", "up = [0, 1, 1]\nmirrored = true"),
            "camera or film");
  EXPECT_EQ(differs("copy/scene.toml", "[0, 2, 3]", "[0, 2, 3.1]"), "a light");
  EXPECT_EQ(differs("copy/scene.mtl", "0.7 0.7 0.7", "0.7 0.7 0.6"), "material 'white'");
  EXPECT_EQ(differs("copy/scene.obj", "v 3 -3 0", "v 3 -3 0.1"), "triangle 0");
  EXPECT_EQ(differs("copy/scene.obj", "f 1 2 4\n", ""), "4 triangles became 3");
}

TEST_F(ToToml, WhatTheReaderWouldRefuseIsRefusedWhole) {
  std::string narrow = kPbrtView;  // a field of view of 0.0008 degrees
  narrow.replace(narrow.find("fov\" 40"), 7, "fov\" .004");
  narrow.replace(narrow.find("\nWorld"), 1, " \"float cropwindow\" [0 1 .4 .6]\n");
  writeAll(at("s.pbrt"), narrow + kSquare);
  const Outcome refused = convert("s.pbrt", "copy");
  EXPECT_EQ(refused.code, 4) << refused.output;
  EXPECT_NE(refused.output.find("cannot state this scene"), std::string::npos) << refused.output;
  EXPECT_NE(refused.output.find("vertical_fov_deg"), std::string::npos) << refused.output;
  EXPECT_EQ(refused.output.find(".partial"), std::string::npos) << refused.output;
  EXPECT_FALSE(fs::exists(at("copy")));
}

class ToTomlFolder : public ToToml {
 protected:
  void refuses(const Outcome& outcome, int code, const std::string& part) {
    EXPECT_EQ(outcome.code, code) << outcome.output;
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output;
    for (const auto& entry : fs::directory_iterator(at(".")))
      EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
  }
};

TEST_F(ToTomlFolder, OneThatItMadeIsReplaced) {
  writeTinyAs("scene.toml");
  fs::create_directory(at("copy"));  // empty
  ASSERT_EQ(convert("scene.toml", "copy").code, 0);
  writeAll(at("tiny.mtl"), "newmtl white\nKd 0.2 0.2 0.2\n");
  const Outcome again = convert("scene.toml", "copy/");
  ASSERT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(loadScene(at("copy/scene.toml")).materials.at(0).phong().diffuse, Vec3(0.2f));
  refuses(again, 0, "");
}

TEST_F(ToTomlFolder, WithOthersFilesIsRefused) {
  writeTinyAs("scene.toml");
  fs::create_directories(at("mine/textures"));
  writeAll(at("mine/textures/0.png"), "precious");
  refuses(convert("scene.toml", "mine"), 4, "textures/0.png");
  EXPECT_EQ(readAll(at("mine/textures/0.png")), "precious");
  ASSERT_EQ(convert("scene.toml", "copy").code, 0);
  writeAll(at("copy/notes.txt"), "precious");
  refuses(convert("scene.toml", "copy"), 4, "notes.txt");
  fs::remove(at("copy/notes.txt"));
  writeAll(at("copy/scene.mtl"), "newmtl mine\n");
  refuses(convert("scene.toml", "copy"), 4, "scene.mtl, which was changed");
  EXPECT_EQ(readAll(at("copy/scene.mtl")), "newmtl mine\n");
}

TEST_F(ToTomlFolder, WithTheScenesOwnFilesIsRefused) {
  writeTinyAs("scene.toml");
  ASSERT_EQ(convert("scene.toml", "copy").code, 0);
  const std::string before = readAll(at("copy/scene.toml"));
  refuses(convert("copy/scene.toml", "copy"), 2, "which the run reads");
  writeAll(at("uses.toml"), kView + "[[mesh]]\nfile = \"copy/scene.obj\"\n");
  refuses(convert("uses.toml", "copy"), 2, "which the run reads");
  refuses(convert("scene.toml", "copy", "--stats " + quoted(at("copy/stats.json"))), 2,
          "another output");
  EXPECT_EQ(readAll(at("copy/scene.toml")), before);
  fs::create_directory_symlink(at("copy"), at("link"));
  refuses(convert("copy/scene.toml", "link"), 2, "which the run reads");
  EXPECT_EQ(convert("scene.toml", "link").code, 0);
  EXPECT_TRUE(fs::is_symlink(at("link")));
}

TEST_F(ToTomlFolder, ThatCannotBeOneIsRefused) {
  writeTinyAs("scene.toml");
  writeAll(at("file"), "precious");
  refuses(convert("scene.toml", "file"), 4, "is no folder");
  EXPECT_EQ(readAll(at("file")), "precious");
  refuses(convert("scene.toml", "none/copy"), 4, "cannot write");
}

TEST_F(ToTomlFolder, ThatIsTheCurrentOneIsRefused) {
  writeTinyAs("scene.toml");
  fs::create_directory(at("here"));
  Outcome outcome;
  outcome.code = std::system(
      ("cd " + quoted(at("here")) + " && '" BNVPL_INSPECT "' scene ../scene.toml --to-toml . 2>err")
          .c_str());
  EXPECT_NE(readAll(at("here/err")).find("name a folder"), std::string::npos);
  EXPECT_NE(outcome.code, 0);
}

}  // namespace
}  // namespace bnvpl
