// vpl-inspect scene --to-toml writes a scene equal to the original.
#include "tests/inspect/scene/to_toml.h"

#include "formats/image/exr_io.h"
#include "scene/choose_view.h"
#include "scene/visit_material.h"

namespace bnvpl {
namespace {

TEST_F(ToToml, KeepsInstances) {
  writeTinyWith(
      "[[mesh]]\nfile = \"tiny.obj\"\nscale = 0.5\n"
      "[[mesh.instance]]\ntranslate = [1, 2, 2]\n"
      "[[mesh.instance]]\nrotate_deg = [0, 30, 0]\nscale = [1, -2, 1]\n");
  const Scene copy = copyOf("tiny.toml");
  ASSERT_EQ(copy.instances.size(), 2u);
  EXPECT_EQ(copy.instances[0].point({}), Vec3(1, 2, 2));
  EXPECT_EQ(copy.instances[1].mirrored, 1u);
  EXPECT_EQ(copy.prototypes.size(), 1u);
}

// Faces that reach far away are written whole, not as the pieces into which reading cuts them.
TEST_F(ToToml, KeepsTheExtentOfScenesWithFarFaces) {
  writeTinyScene(at("."));
  writeAll(at("tiny.obj"), readAll(at("tiny.obj")) +
                               "o ground\nv -1e5 -9 -1e5\nv 1e5 -9 -1e5\nv 1e5 -9 1e5\n"
                               "v -1e5 -9 1e5\nf -4 -3 -2 -1\n");
  for (const char* from : {"tiny.toml", "copy/scene.toml"}) {
    const Outcome done = convert(from, from[0] == 't' ? "copy" : "copy of copy");
    ASSERT_EQ(done.code, 0) << done.output;
  }
  const Scene scene = loadScene(at("tiny.toml"));
  EXPECT_GT(scene.triangles.size(), 100u);
  EXPECT_EQ(scene.cutFaces.size(), 2u);
  for (const char* folder : {"copy", "copy of copy"}) {
    const std::string obj = readAll(at(folder + std::string("/scene.obj")));
    EXPECT_LT(std::ranges::count(obj, 'f'), 20) << folder;
    const Scene copy = loadScene(at(folder + std::string("/scene.toml")));
    EXPECT_EQ(sceneDifference(scene, copy), "") << folder;
    EXPECT_NEAR(copy.offsetSize(), scene.offsetSize(), 1e-4f * scene.offsetSize());
    EXPECT_EQ(copy.objectNames, scene.objectNames);
  }
  Scene other = scene;
  other.nearSize *= 2.0f;
  EXPECT_EQ(sceneDifference(scene, other), "which triangles lie far away");
}

TEST_F(ToToml, KeepsAMeshOfWhichAllInstancesButOneHaveNoVolume) {
  writeTinyWith(
      "[[mesh]]\nfile = \"tiny.obj\"\n"
      "[[mesh.instance]]\ntranslate = [1, 2, 2]\n"
      "[[mesh.instance]]\nscale = [0, 0, 0]\n");
  const Scene scene = loadScene(at("tiny.toml"));
  EXPECT_EQ(scene.instances.size(), 0u);
  EXPECT_EQ(std::ranges::count_if(
                scene.warnings,
                [](const std::string& w) { return w.find("without volume") != std::string::npos; }),
            1);
  copyOf("tiny.toml");
}

TEST_F(ToToml, KeepsLampsThatAreOff) {
  writePicture("p.png");
  writeTinyWith(
      "[[texture]]\nname = \"t\"\ntype = \"image\"\nimage = \"p.png\"\n"
      "[[material]]\nname = \"white\"\nmodel = \"diffuse\"\nemission = [0, 0, 0]\n"
      "emission_texture = \"t\"\nemission_sides = 2\n");
  copyOf("tiny.toml");
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

}  // namespace
}  // namespace bnvpl
