// The names of a file's objects, and the triangles and instances that they have in the scene.
#include "scene/builder/scene_builder.h"
#include "tests/scene/gltf/gltf_files.h"

namespace bnvpl {
namespace {

using Objects = SceneFiles;

// "name: triangles, name: triangles" of all objects, those of instances once for each.
std::string objectsOf(const Scene& s) {
  std::vector<size_t> counts(s.objectNames.size());
  for (uint32_t t = 0; t < s.worldEnd(); ++t) ++counts.at(s.objectOf(t));
  for (uint32_t i = 0; i < s.instances.size(); ++i) {
    const Prototype& p = s.prototypes[s.instances[i].prototype];
    for (uint32_t t = p.begin; t < p.end; ++t) ++counts.at(s.objectOf(t, i));
  }
  std::string text;
  for (size_t o = 0; o < counts.size(); ++o)
    text += (o > 0 ? ", " : "") + s.objectNames[o] + ": " + std::to_string(counts[o]);
  return text;
}

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string kQuad = "f 1 2 3 4\n", kTriangle = "f 1 2 3\n";

TEST_F(Objects, ObjNamesThemByOOrElseByG) {
  EXPECT_EQ(objectsOf(loadMesh(kVertices + kQuad, "")), "square: 2");
  EXPECT_EQ(objectsOf(loadMesh(kVertices + kTriangle + "o my table\n" + kQuad + kTriangle +
                                   "o lamp\ng shade\n" + kTriangle + "o my table\n" + kTriangle,
                               "")),
            "square: 1, my table: 4, lamp: 1");
  EXPECT_EQ(objectsOf(loadMesh(kVertices + "g left wall\n" + kQuad + "g\n" + kTriangle, "")),
            "left wall: 2, square: 1");
}

// Lost polygons, faces of too few corners and cut polygons keep the names in step.
TEST_F(Objects, ObjNamesStayWithTheirFaces) {
  EXPECT_EQ(objectsOf(loadMesh(kVertices + "o a\nf 1 2\nf 1 2 99999999999\n" + kQuad +
                                   "o b\nf 1 2 9\n" + kTriangle + "o none\no c\n" + kQuad,
                               "")),
            "a: 2, b: 1, c: 2");
}

TEST_F(Objects, ObjNamesAreTheSameInPieces) {
  std::string obj = kVertices, expected;
  for (int i = 0; i < 40000; ++i) {
    if (i % 10000 == 5000) obj += "o part " + std::to_string(i) + "\n";
    obj += "f 1 2 3 # a comment that makes the file longer than a piece\n";
  }
  EXPECT_GT(obj.size(), 2u << 20);
  EXPECT_EQ(objectsOf(loadMesh(obj, "")),
            "square: 5000, part 5000: 10000, part 15000: 10000, part 25000: 10000, "
            "part 35000: 5000");
}

// Masked triangles are stored behind the others, lamps lie in the world, broken ones are dropped.
TEST_F(Objects, TrianglesKeepThemWhereverTheyAreMoved) {
  SceneBuilder builder("s");
  Material holes, lamp;
  holes.opacity = 0.2f;
  lamp.emission = Vec3(1.0f);
  const uint32_t masked = builder.addMaterial(holes), shining = builder.addMaterial(lamp);
  const std::vector<double> p{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, NAN};
  const auto add = [&](uint32_t firstMaterial, const char* name) {
    const uint32_t object = builder.addObject(name), rest = builder.addObject("rest");
    const auto t = [](uint32_t c, uint32_t m) {
      return Triangle{{0, 1, c}, kNoCorners, kNoCorners, m};
    };
    builder.addMesh("m", {p,
                          {},
                          {},
                          {t(2, firstMaterial), t(3, kNone), t(1, kNone), t(2, kNone)},
                          {{0, object}, {3, rest}}});
  };
  add(masked, "masked\nobject");
  const uint32_t prototype = builder.beginPrototype();
  add(shining, "lamp");
  builder.endPrototype();
  builder.addInstance(prototype, Affine::fromParts({5, 0, 0}, {}, {1, 1, 1}));
  builder.addInstance(prototype, Affine::fromParts({9, 0, 0}, {}, {1, 1, 1}),
                      builder.addObject("chair"));
  EXPECT_EQ(objectsOf(builder.finish()), "rest: 2, lamp: 1, chair: 2, masked_object: 1");
}

TEST_F(Objects, InstancesOfTomlMayHaveNames) {
  write("square.obj", kSquareObj);
  const std::string toml = kFilmAndCamera + "[[mesh]]\nfile = \"square.obj\"\n[[mesh.instance]]\n";
  const std::string named = "name = \"left\"\n",
                    other = "[[mesh.instance]]\ntranslate = [5, 0, 0]\n";
  EXPECT_EQ(objectsOf(load(toml + named)), "left: 2");
  EXPECT_EQ(objectsOf(load(toml + other)), "square: 4");
  EXPECT_EQ(objectsOf(load(toml + named + other)), "square: 2, left: 2");
  EXPECT_EQ(objectsOf(load(toml + named + other + "name = \"right\"\n")), "left: 2, right: 2");
  EXPECT_NE(loadError(toml + "name = \"\"\n").find("'name' must not be empty"), std::string::npos);
}

TEST_F(Objects, GltfNamesThemByNodeOrMesh) {
  Gltf g = cornerGltf();
  const std::string corner = "{\"attributes\":{\"POSITION\":0}}";
  g.addMesh(corner + "," + corner);
  g.add("meshes", "{\"name\":\"M\",\"primitives\":[" + corner + "]}");
  g.addMesh(corner);
  g.show("{\"name\":\"Tür\",\"mesh\":0}");
  g.show("{\"name\":\"Door\",\"mesh\":0,\"translation\":[3,0,0]}");
  g.show("{\"mesh\":1}");
  g.show("{\"mesh\":2}");
  write("room.gltf", g.text());
  EXPECT_EQ(objectsOf(loadScene(at("room.gltf"))), "M: 1, room node 3: 1, Tür: 2, Door: 2");
}

TEST_F(Objects, PbrtNamesThemByParameterObjectOrPlace) {
  const std::string shape = "Shape \"disk\" ";
  write("more.pbrt", "\n\n" + shape + "\n");
  write("s.pbrt", "WorldBegin\n" + shape + "\n" + shape + "\"string name\" \"lid\"\n" +
                      "ObjectBegin \"chair\"\n" + shape + "\nShape \"sphere\"\nObjectEnd\n" +
                      "ObjectInstance \"chair\"\nTranslate 5 0 0 ObjectInstance \"chair\"\n" +
                      "Include \"more.pbrt\"\nAttributeBegin\n" +
                      "Attribute \"shape\" \"string name\" \"top\"\n" + shape + "\nAttributeEnd\n");
  const Scene s = loadScene(at("s.pbrt"));
  EXPECT_EQ(s.objectNames,
            (std::vector<std::string>{"s.pbrt:2", "lid", "more.pbrt:3", "top", "chair"}));
  EXPECT_EQ(joined(s.warnings).find("name"), std::string::npos) << joined(s.warnings);
  EXPECT_EQ(s.objectOf(s.worldEnd(), 0), 4u);
}

TEST_F(Objects, NamelessOnesOfSeveralFilesStaySeparate) {
  const std::string room = triangleGltf().text();
  write("a.gltf", room);
  write("b.gltf", room);
  EXPECT_EQ(objectsOf(load(kFilmAndCamera +
                           "[[mesh]]\nfile = \"a.gltf\"\n[[mesh]]\nfile = \"b.gltf\"\n")),
            "a node 0: 1, b node 0: 1");
}

}  // namespace
}  // namespace bnvpl
