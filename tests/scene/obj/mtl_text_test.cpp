// Forms of MTL: colours, options of maps, upper-case keys. Errors in OBJ and MTL files are reported
// with their line.
#include "scene/read/obj/mtl/mtl_text.h"

#include "scene/read/obj/mtl/map_options.h"
#include "tests/scene/scene_files.h"

namespace bnvpl {
namespace {

class MtlForms : public SceneFiles {
 protected:
  Scene paint(const std::string& fields) const {
    return loadMesh(kSquareObj, "newmtl paint\n" + fields);
  }
  Vec3 diffuse(const std::string& fields) const {
    return paint(fields).materials.at(0).phong().diffuse;
  }
  std::string errorOf(const std::string& obj, const std::string& mtl) const {
    write("square.obj", obj);
    write("square.mtl", mtl);
    return loadError(kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n");
  }
};

TEST_F(MtlForms, OneValueIsGrey) {
  EXPECT_EQ(diffuse("Kd 0.5\n"), Vec3(0.5f));
  EXPECT_EQ(diffuse("Kd 0.1 0.2 0.3\n"), Vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(diffuse("KD .25 # all alike\n"), Vec3(0.25f));
  EXPECT_EQ(paint("Kd 0\nKe 10\n").materials.at(0).emission, Vec3(10));
  EXPECT_EQ(paint("Kd 0\nKs 0.5\nNs 9\n").materials.at(0).phong().glossy, Vec3(0.5f));
  EXPECT_EQ(paint("illum 4\nNi 1.5\nTf 0.5\n").materials.at(0).phong().transmission, Vec3(0.5f));
}

TEST_F(MtlForms, CieIsConvertedAndIgnoredSpectraAreReported) {
  const Vec3 white = diffuse("Kd xyz 0.9505 1 1.089\n");
  EXPECT_LT(length(white - Vec3(1)), 1e-3f);
  EXPECT_EQ(diffuse("Kd xyz +0.9505 +1 +1.089\n"), white);
  const Scene spectral = paint("Kd spectral white.rfl 0.5\n");
  EXPECT_EQ(spectral.materials.at(0).phong().diffuse, Vec3(0.5f));
  EXPECT_EQ(countContaining(spectral.warnings, "Kd spectral is ignored"), 1u);
}

TEST_F(MtlForms, WithoutAnyColourIsGreyWithAWord) {
  const Scene none = paint("Ns 10\nillum 1\n");
  EXPECT_EQ(none.materials.at(0).phong().diffuse, Vec3(0.5f));
  EXPECT_EQ(countContaining(none.warnings, "'paint': has no colour"), 1u) << joined(none.warnings);
  for (const char* stated : {"Kd 0\n", "Ke 1\n", "Ks 1\n", "illum 4\nNi 1.5\n"}) {
    const Scene s = paint(stated);
    EXPECT_EQ(s.materials.at(0).phong().diffuse, Vec3(0)) << stated;
    EXPECT_EQ(countContaining(s.warnings, "has no colour"), 0u) << stated;
  }
}

TEST_F(MtlForms, CapitalsCountAsUsual) {
  MtlNotes notes;
  const auto keys = [&](const std::string& text) { return plainMtl("m", text, notes); };
  EXPECT_EQ(keys("NEWMTL My Paint\nKD 1 1 1\nks 0 0 0\nMAP_KD T.png\nD 1\nILLUM 2\n"),
            "newmtl My Paint\nKd 1 1 1\nKs 0 0 0\nmap_Kd T.png\nd 1\nillum 2\n");
  EXPECT_EQ(keys("map_bump a\rmap_Bump b\r\nbump c\nxyzzy D\n"),
            "map_bump a\nmap_Bump b\nbump c\nxyzzy D\n");
}

TEST_F(MtlForms, KeysWithoutAMeaningAreNamedOnceTogether) {
  const Scene s = loadMesh(kSquareObj,
                           "\xef\xbb\xbf# of some tool\nnewmtl paint\nKdd 1 0 0\nDecal a.png\n"
                           "newmtl other\nKd 1 1 1\nKdd 1 0 0\nmap_aat on\nSharpness 60\nmap_Kd\n"
                           "newmtl third\nDecal b.png\n");
  EXPECT_EQ(countContaining(s.warnings,
                            "square.mtl: 2 keys have no meaning and are ignored: 'Kdd' "
                            "(line 3), 'Decal' (line 4); correct those"),
            1u)
      << joined(s.warnings);
  EXPECT_EQ(countContaining(s.warnings, "no meaning"), 1u) << joined(s.warnings);
  const Scene one = paint("Kd 1 1 1\n" + std::string(100, 'x') + " 1\n");
  EXPECT_EQ(countContaining(one.warnings, "a key has no meaning and is ignored: '" +
                                              std::string(40, 'x') + "...' (line 3); correct it"),
            1u)
      << joined(one.warnings);
  std::string many;
  for (int i = 0; i < 100; ++i) many += "key" + std::to_string(i) + " 1\n";
  EXPECT_EQ(countContaining(paint(many).warnings, "100 keys have no meaning"), 1u);
  EXPECT_EQ(countContaining(paint(many).warnings, "'key5' (line 7) and 94 more;"), 1u);
}

TEST_F(MtlForms, WhatIsIgnoredBeforeAnErrorIsToldBeforeIt) {
  write("square.obj", kSquareObj);
  write("square.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd -foo 3 a.png\nKdd 1\nd -halo 1\nNs many\n");
  write("scene.toml", kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n");
  std::vector<std::string> told;
  EXPECT_THROW(loadScene(at("scene.toml"), {}, [&](const std::string& w) { told.push_back(w); }),
               InputError);
  EXPECT_EQ(countContaining(told, "option -halo is ignored"), 1u) << joined(told);
  EXPECT_EQ(countContaining(told, "'Kdd' (line 4)"), 1u) << joined(told);
}

TEST_F(MtlForms, NumbersBeyondFloatsAreRefusedAndNegativeOnesAreTold) {
  for (const char* line : {"Ke 1e39 1 1", "Ks 1e39 .3 .3", "Kd .5 1e400 .5", "Ns 1e39", "Ni -1e39"})
    EXPECT_NE(errorOf(kSquareObj, std::string("newmtl paint\n") + line + "\n")
                  .find("square.mtl:2: " + std::string(line).substr(0, 2) + ": "),
              std::string::npos)
        << line;
  EXPECT_EQ(diffuse("Kd 1e-50 1 1\n").y, 1.0f);
  for (const char* line :
       {"Kd -1 .5 .5", "Ke -2", "Ks -.1 0 0", "Ns -3", "d -1", "Pr -1", "Tf -1"}) {
    const Scene s = paint("Kd 1 1 1\n" + std::string(line) + "\n");
    EXPECT_EQ(countContaining(s.warnings, "is negative and counts as 0"), 1u)
        << line << joined(s.warnings);
  }
  EXPECT_EQ(countContaining(paint("Kd -0 0 0\n").warnings, "negative"), 0u);
}

TEST_F(MtlForms, OptionsOfMapsThatAreNotFiniteAreTold) {
  for (const char* option : {"-s nan", "-o inf", "-bm nan"}) {
    const Scene s =
        paint("Kd 1 1 1\n" + std::string(option == std::string("-bm nan") ? "bump " : "map_Kd ") +
              option + " t.png\n");
    EXPECT_EQ(countContaining(s.warnings, std::string(option) + " counts as 0"), 1u)
        << option << joined(s.warnings);
  }
}

TEST_F(MtlForms, KnownKeysThatAreNotReadAreToldWhereTheyWouldChangeThePicture) {
  for (const char* line : {"map_Ps s.png", "refl r.png", "disp d.png", "map_refl r.png"}) {
    const std::string key = std::string(line).substr(0, std::string(line).find(' '));
    const Scene s = paint("Kd 1 1 1\n" + std::string(line) + "\n");
    EXPECT_EQ(countContaining(s.warnings, key + " is ignored"), 1u) << joined(s.warnings);
  }
  const Scene s = paint("Kd 1 1 1\nKa 1 1 1\nmap_Ka a.png\nsharpness 60\nMAP_AAT on\n");
  EXPECT_EQ(countContaining(s.warnings, "ignored"), 0u) << joined(s.warnings);
}

TEST_F(MtlForms, MalformedNumbersAreReportedWithTheirLine) {
  const auto expect = [&](const std::string& field, const std::string& part) {
    const std::string error = errorOf(kSquareObj, "newmtl paint\n" + field + "\n");
    EXPECT_NE(error.find("square.mtl:2: " + part), error.npos) << error;
  };
  expect("Kd 0,2 0,4 0,6", "Kd: '0,2' has a decimal comma; write 0.2");
  expect("Ns 10,5", "Ns: '10,5' has a decimal comma");
  expect("Ke bright", "Ke: 'bright' is no number");
  expect("Kd 0.2 0.4", "Kd: needs one number, or three");
  expect("map_Kd -s 1,5 t.png", "map_Kd: option -s needs a number: '1,5' has a decimal comma");
  const Scene nan = paint("Kd nan 0.5 1.#IND\n");
  EXPECT_EQ(nan.materials.at(0).phong().diffuse, Vec3(0, 0.5f, 0));
  EXPECT_EQ(countContaining(nan.warnings, "counts as 0"), 2u);
}

TEST_F(MtlForms, OptionsOfMaps) {
  const auto plain = [](const std::string& rest) {
    const MapOptions m = mapOptions(rest);
    return m.kept + m.name + (m.ignored.empty() ? "" : " | " + joined(m.ignored));
  };
  EXPECT_EQ(plain("t.png"), "t.png");
  EXPECT_EQ(plain("-s 2 my t.png"), "-s 2 1 1 my t.png");
  EXPECT_EQ(plain("-s 2 3 -o .5 t.png"), "-s 2 3 1 -o .5 0 0 t.png");
  EXPECT_EQ(plain("-s 2 3 4 7.png"), "-s 2 3 4 7.png");
  EXPECT_EQ(plain("-o 1 2 3"), "-o 1 2 0 3");  // the last word is the name
  EXPECT_EQ(plain("my  t.png -s 2 2 -bm 3"), "-s 2 2 1 -bm 3 my  t.png");
  EXPECT_EQ(plain("a -s b.png"), "a -s b.png");
  EXPECT_EQ(plain("-blendu on -blendv on -clamp off -cc off -mm 0 1 -t 0 t.png"), "t.png");
  EXPECT_EQ(plain("-clamp on -t 1 -imfchan r t.png"), "t.png | -clamp on\n-t 1 0 0\n-imfchan r\n");
}

TEST_F(MtlForms, ScaleAndOffsetActOnTheTexture) {
  write("my t.tga", tga(2, 1, {{255, 255, 255, 255}, {0, 0, 0, 255}}));
  for (const char* map : {"-s 2 2 -o 0.25 my t.tga", "my t.tga -s 2 2 1 -o 0.25 0"}) {
    const Scene s = paint("Kd 1 1 1\nmap_Kd " + std::string(map) + "\n");
    ASSERT_EQ(s.textures.size(), 1u) << joined(s.warnings);
    EXPECT_EQ(s.textures[0].scale, (std::array{2.0f, 2.0f}));
    EXPECT_EQ(s.textures[0].offset, (std::array{0.25f, 0.0f}));
    EXPECT_NEAR(s.textures[0].lookup(0.0f, 0.5f).x, 1.0f, 1e-6f);
    EXPECT_NEAR(s.textures[0].lookup(0.25f, 0.5f).x, 0.0f, 1e-6f);
  }
  const Scene two = paint("Kd 1 1 1\nmap_Kd -s 4e-7 4e-7 my t.tga\nmap_Ks -s 3e-7 3e-7 my t.tga\n");
  ASSERT_EQ(two.textures.size(), 2u) << "of small scales";
  EXPECT_NE(two.textures[0].scale, two.textures[1].scale);
  const Scene clamped = paint("Kd 1 1 1\nmap_Kd -clamp on my t.tga\nmap_Ks -clamp on my t.tga\n");
  EXPECT_EQ(countContaining(clamped.warnings, "map_Kd: option -clamp on is not supported"), 1u);
}

TEST_F(MtlForms, LinesOfAnObjThatAreWrongAreNamed) {
  const std::string mtl = "newmtl paint\nKd 1 1 1\n", corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto expect = [&](const std::string& line, const std::string& part) {
    const std::string error = errorOf(corners + line + "\nf 1 2 3\n", mtl);
    EXPECT_NE(error.find("square.obj:4: " + part), error.npos) << line << ": " << error;
  };
  expect("v 1,0 0,0 0,0", "'v': '1,0' has a decimal comma; write 1.0");
  expect("v 1 2", "'v' needs 3 numbers");
  expect("v 1 2 z", "'v': 'z' is no number");
  expect("v 1 2 0x1", "'v': '0x1' is no number");
  expect("vn 1 2", "'vn' needs 3 numbers");
  expect("vt", "'vt' needs 1 number");
  expect("f 1 2 three", "a face names 'three'");
  expect("f 1.5 2 3", "a face names '1.5'");
  expect("f 1/1/1/1 2 3", "a face names '1/1/1/1'");
  expect("f 1 2 0", "a face names '0', but numbers count from 1");
  for (const char* fine : {"f 1// 2// 3//", "f 1/ 2/ 3/", "f 1 2 3 # corner", "v +1.e0 .5 -3E-2 1",
                           "v 1.#IND nan -inf", "vt .5", "f -3 -2 -1"})
    EXPECT_EQ(errorOf(corners + fine + "\nf 1 2 3\n", mtl), "") << fine;
}

TEST_F(MtlForms, Utf16IsReportedByName) {
  const auto wide = [](const std::string& text) {
    std::string out = "\xff\xfe";
    for (const char c : text) out += {c, '\0'};
    return out;
  };
  const std::string problem = ": is UTF-16 text; save it as UTF-8",
                    mtl = "newmtl paint\nKd 1 1 1\n";
  EXPECT_NE(errorOf(wide(kSquareObj), mtl).find("square.obj" + problem), std::string::npos);
  EXPECT_NE(errorOf(wide(kSquareObj).substr(2), mtl).find("square.obj" + problem),
            std::string::npos);
  EXPECT_NE(errorOf(kSquareObj, wide(mtl)).find("square.mtl" + problem), std::string::npos);
  EXPECT_NE(loadError(wide(kFilmAndCamera)).find("scene.toml" + problem), std::string::npos);
  for (const char* name : {"a.pbrt", "a.gltf"}) {
    write(name, wide("WorldBegin {}"));
    EXPECT_THROW(
        {
          try {
            loadScene(at(name));
          } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find(problem), std::string::npos) << e.what();
            throw;
          }
        },
        InputError);
  }
}

TEST_F(MtlForms, AnObjWithoutFacesIsNamed) {
  write("more.obj", "v 0 0 0\nv 1 0 0\n");
  const Scene s =
      loadMesh(kSquareObj, "newmtl paint\nKd 1 1 1\n", "", "[[mesh]]\nfile = \"more.obj\"\n");
  EXPECT_EQ(countContaining(s.warnings, "more.obj: has no faces"), 1u) << joined(s.warnings);
}

}  // namespace
}  // namespace bnvpl
