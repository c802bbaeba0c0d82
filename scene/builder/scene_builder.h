// Builds a Scene. The loaders of all formats add what they read; finish() returns the result.
//
//   SceneBuilder builder("room.toml");
//   Material paint;
//   paint.model = DiffuseModel{Vec3(0.5f)};
//   Mesh mesh{positions, {}, {}, {Triangle{{0, 1, 2}, kNoCorners, kNoCorners,
//                                          builder.addMaterial(paint)}}};
//   builder.addMesh("room.obj", std::move(mesh));
//   builder.setCamera({0, 1, 3}, camera);
//   const Scene scene = builder.finish();
//
// Lengths are in the scene's own unit, angles in radians, colours in linear sRGB; y is up where a
// format has no up of its own. Loaders must make colours and powers finite and not negative, and
// directions of unit length. The numbers that add...() returns count from 0.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_set>

#include "scene/affine.h"
#include "scene/scene.h"
#include "scene/strays.h"
#include "scene/textures/texture_pool.h"

namespace bnvpl {

inline constexpr std::array<uint32_t, 3> kNoCorners{kNone, kNone, kNone};

// A mesh as its file gives it. The arrays are borrowed until addMesh() returns.
struct Mesh {
  std::span<const double> positions;  // x, y, z of each vertex
  std::span<const double> normals;    // x, y, z of each, of any length; 0 means none
  std::span<const double> uvs;        // u, v of each, v = 0 at the bottom row of a texture
  // Corners index the arrays above; a corner lacks an attribute if its index is kNone or out of
  // range. `material` is a number from addMaterial(), or kNone for grey. The front of a face, on
  // which it emits, is the side where its corners run anti-clockwise.
  std::vector<Triangle> triangles;
  // Objects of the triangles, by numbers from addObject(); the first run begins at 0. A mesh
  // without any is one object, with the name of its file.
  std::vector<ObjectRun> objects = {};
};

// A name of a file as one line: control characters become '_'.
std::string onOneLine(std::string name);

class SceneBuilder {
 public:
  // Ends of warnings about textures that cannot be read: colours, other numbers, reliefs, masks.
  static constexpr const char* kPlainColour = "the plain material colour is used";
  static constexpr const char* kPlainNumber = "the plain value is used";
  static constexpr const char* kNoRelief = "the surface has no relief";
  static constexpr const char* kNoHoles = "the surface has no holes";
  // `sceneFile` names the scene in messages and is the first of Scene::files. Each warning goes to
  // `onWarning` at once, even if an error follows and no Scene results.
  explicit SceneBuilder(fs::path sceneFile, OnWarning onWarning = {});

  // Changes the film of all cameras from number `first` on, and of the scene if it has none.
  void changeFilm(const std::function<Film(const Film&)>& changed, size_t first);
  const Film& film() const { return scene_.film; }
  void setFilm(const Film& film) {
    changeFilm([&](const Film&) { return film; }, 0);
  }
  // The camera of a format that has one. finish() computes camera.position from `position`.
  void setCamera(const FilePoint& position, const Camera& camera);
  // Adds one of several cameras; the first is used unless the user chooses another. A scene without
  // a camera gets one that sees all of it, with a warning.
  void addCamera(const std::string& name, const FilePoint& position, const Camera& camera,
                 const Film& film);
  // The cameras so far, without their positions, in the order of their numbers.
  const std::vector<View>& views() const { return scene_.views; }
  void dropCameras(size_t first);  // removes those from number `first` on

  // Starts to decode a texture in the background. Only the time of loading depends on it.
  void expectTexture(const TextureUse& use) { textures_.expect(use); }
  // What becomes of a texture that cannot be read, and where it is named: the beginning of the
  // warning, such as "room.mtl:7: ".
  struct TextureNotice {
    std::string otherwise = kPlainColour;
    std::string where = {};
  };
  // Returns the number for a Material's map; equal uses share one. Returns kNone, with a warning,
  // if the file does not exist. finish() removes a damaged texture from its materials. Of several
  // places that name a file, the first is told.
  uint32_t addTexture(const TextureUse& use, const TextureNotice& notice);
  uint32_t addTexture(const TextureUse& use) { return addTexture(use, TextureNotice()); }
  // Adds an image expression that is grey, 0.5, if the image is missing or damaged. `prefersAlpha`:
  // it takes the alpha of an image that has one, whatever its channel.
  uint32_t addFallbackImage(const TextureUse& use, TextureExpression image, bool prefersAlpha,
                            const std::string& where = {});
  // Returns the number for a parameter of a material. Operands are numbers of expressions added
  // before, the image is a number from addTexture(). A damaged image counts as white.
  uint32_t addExpression(const TextureExpression& expression);
  // The value of a constant expression; nothing if it depends on texture coordinates.
  std::optional<Vec3> constantValue(uint32_t expression) const;
  uint32_t addMaterial(Material material);
  // Adds a material that replaces all that are added later under its name: their addMaterial()
  // returns its number. The name must not be empty; an outer file's replacement comes first.
  uint32_t addReplacement(Material material);
  bool isReplaced(const std::string& name) const { return replaced_.contains(name); }
  // The material that replaces those of this name, which counts as used; null if none does.
  const Material* useReplacement(const std::string& name);
  // Adds a material that none replaces, whatever its name.
  uint32_t addOwnMaterial(Material material);
  // What a scene.toml says of the emission of a named material.
  struct Emission {
    std::optional<Vec3> radiance;  // on its front or both sides; empty: what it emits by itself
    bool twoSided = false;
    uint32_t group = 0;  // into Scene::lightGroups
  };
  // All materials of this name that are added later emit so. An outer file's emission comes first.
  void addEmission(const std::string& name, const Emission& emission) {
    emissions_.try_emplace(name, emission);
  }
  bool isLit(const std::string& name) const { return lit_.contains(name); }
  // Reads the radiance of an image at once. Negative values become 0, with a warning. Throws
  // InputError if the file is no image.
  EnvironmentImage readEnvironment(const fs::path& image);
  uint32_t addEnvironment(const fs::path& image) {
    return addEnvironment(image, readEnvironment(image));
  }
  // Adds a radiance map that was derived from the file `image`.
  uint32_t addEnvironment(const fs::path& image, EnvironmentImage radiance);
  // The number of a light group, which is new unless it was named before. Returns nothing if there
  // are kMaxLightGroups others.
  std::optional<uint32_t> lightGroup(const std::string& name);
  // finish() computes light.position from `position`, which has no meaning for lights at infinity.
  void addLight(const LightSpec& light, const FilePoint& position = {});

  // Returns the number of the object of this name; equal names are one object. Control characters
  // become '_'.
  uint32_t addObject(std::string name);
  // The object of a mesh that has no name but that of its file: "room" of "scenes/room.obj".
  uint32_t addObjectOf(const fs::path& file) { return addObject(file.stem().string()); }

  struct Place {
    Affine toScene;
    uint32_t object = kNone;  // what all that stands there is; kNone: its own objects
  };
  // What is added until endInclude() is part of a file within another. `place` leads from its
  // coordinates to those of the outer file, and scales the light of lamps that are points by its
  // square, so that the picture stays the same. With `instances` the file stands once at each of
  // them, `place` counts first, its triangles are stored once and its cameras are left out.
  // Replacements of materials that the file adds end with it; those of outer files come before
  // them.
  void beginInclude(const fs::path& file, const Affine& place, std::vector<Place> instances);
  void endInclude();
  bool including() const { return !includes_.empty(); }
  // Why the file must not be included: it is being read, or there are too many. Empty: it may.
  std::string whyNotInclude(const fs::path& file) const;

  // Leaves out triangles with a corner that has no finite position, with a warning that names
  // `file`. A transform that mirrors flips the windings, so that outside stays outside. Returns the
  // number of triangles that became grey for lack of a material; the loader reports why. Throws
  // InputError if the scene has more vertices than 32 bits count.
  size_t addMesh(const fs::path& file, Mesh mesh, const Affine& transform = {});

  // Meshes added until endPrototype() form a prototype, which occurs only where addInstance()
  // places it. Geometry that is placed more than once is stored once, except for emissive
  // triangles. Prototypes do not nest.
  uint32_t beginPrototype();
  void endPrototype() { open_ = kNone; }
  // The instance is the given object; kNone: its triangles keep theirs.
  void addInstance(uint32_t prototype, const Affine& toWorld, uint32_t object = kNone);

  // Records a file that was read or found missing, once each, for depfiles.
  void addFile(const fs::path& file);
  // Reports once what was ignored or repaired: file, problem, consequence.
  void warn(const std::string& text);
  std::string name() const { return scene_.name(); }

  // Returns the scene and leaves the builder empty. Coordinates count from an origin where floats
  // resolve them. Triangles that floats cannot hold and duplicates of emissive triangles are left
  // out, with warnings. Throws InputError if no triangle is left, if the scene is smaller or larger
  // than floats can compute with, and if a texture changed while it was read.
  Scene finish();

 private:
  struct Part {  // the triangles of one addMesh()
    fs::path file;
    size_t endTriangle, endPoint;
    uint32_t prototype;   // kNone: the world
    bool pieces = false;  // parts of faces that reach far away; unusable ones go without warning
  };
  struct KeptMesh {  // mesh of a prototype, kept until finish()
    fs::path file;
    std::vector<double> positions, normals, uvs;
    std::vector<Triangle> triangles;
    Affine transform;
    Mesh mesh(std::vector<Triangle> of) const { return {positions, normals, uvs, std::move(of)}; }
    KeptMesh part(std::vector<Triangle> of) const;
  };
  struct Placed {
    uint32_t prototype;
    Affine toWorld;
    uint32_t object;
  };
  // Until finish() lists the runs of objects, Triangle::material is an index into surfaces_, so
  // that triangles keep their object wherever they are moved.
  struct Surface {
    uint32_t material, object;  // `material` is kNone for grey until the triangle is found usable
    auto operator<=>(const Surface&) const = default;
  };
  struct FallbackImage {
    uint32_t expression;  // a number from addFallbackImage()
    bool prefersAlpha;
  };
  struct Include {
    fs::path file;
    Affine outer;  // place_ of the outer file
    std::vector<Place> instances;
    std::map<std::string, uint32_t> replacements;  // those of the outer file
    std::map<std::string, Emission> emissions;     // the same
    size_t placed, lights, views;                  // how many there were
  };
  void placeLight(const Affine& place, LightSpec& light, FilePoint& position);
  void placeCamera(const Affine& place, Camera& camera, FilePoint& position) const;
  uint32_t surfaceOf(Surface surface);
  uint32_t materialNumber(const Triangle& t) const { return surfaces_[t.material].material; }
  const Material& materialOf(const Triangle& t) const {
    return scene_.materials[materialNumber(t)];
  }
  void giveSurfaces(const fs::path& file, Mesh& mesh);
  // Adds a mesh whose triangles have surfaces; `object`, unless kNone, replaces theirs.
  size_t addPart(const fs::path& file, Mesh mesh, const Affine& transform, uint32_t object);
  static uint32_t objectOfAll(const std::vector<Placed>& uses);
  Corners cornersOf(const Triangle& t) const {
    return {points_[t.position[0]], points_[t.position[1]], points_[t.position[2]]};
  }
  struct Base {  // offsets of a mesh's arrays in the scene's
    size_t position, normal, uv;
  };
  Base addCorners(const fs::path& file, const Mesh& mesh, const Affine& transform);
  void warnOfPixels(const std::string& image, size_t negative, size_t pixels,
                    const std::string& damage);
  uint32_t greyMaterial();
  // Whether the expression uses an image that could not be read.
  bool lacksImage(uint32_t expression) const;
  void recordMesh(const std::string& name, size_t triangles);

  void shareMesh(const KeptMesh& kept, uint32_t prototype, const std::vector<Placed>& uses);
  // Steps of finish(), in this order:
  void placePrototypes();
  void resolveTextures();
  void foldConstants();
  void warnOfMissingUvs();
  void findStrays();
  void cutFarFaces();
  void cut(const Triangle& face, std::vector<Triangle>& pieces);
  void roundPositions();
  void dropUnusable();
  void placeInstances();
  void dropDoubledLamps();
  void sortByMask();
  void listObjects();
  void sortLightGroups();
  void extendBounds();
  void placeViews();
  void requirePlace(const FilePoint& p, const char* what) const;
  void requireSize() const;

  Scene scene_;
  TexturePool textures_;
  std::vector<FilePoint> points_;  // become scene_.positions
  std::vector<Part> parts_;
  std::vector<std::vector<KeptMesh>> prototypes_;
  std::vector<Placed> placed_;
  std::vector<Include> includes_;  // files that are being read, the innermost last
  size_t includeCount_ = 0;
  Affine place_;  // from the innermost of them to the scene, or to their outermost instances
  std::vector<Surface> surfaces_;
  std::map<Surface, uint32_t> surfaceNumbers_;
  std::vector<std::string> objects_;  // names of the numbers from addObject()
  std::map<std::string, uint32_t> objectNumbers_;
  uint32_t open_ = kNone;    // prototype that receives meshes; kNone: the world
  uint32_t shared_ = kNone;  // the same, during finish()
  std::vector<FallbackImage> fallbackImages_;
  std::vector<TextureNotice> notices_;        // what the first use of each texture said
  std::set<fs::path> missing_;                // textures that do not exist
  std::vector<uint32_t> lookups_;             // lookups per expression, operands included
  std::vector<FilePoint> viewPositions_;      // positions of scene_.views
  std::vector<FilePoint> lightPositions_;     // positions of scene_.lights
  std::map<std::string, size_t> meshOfName_;  // indices in scene_.meshes
  // For each of scene_.materials, the number of materials that it mixes, itself included.
  std::vector<uint32_t> mixParts_;
  std::vector<uint32_t> lobes_;  // for each of scene_.materials, the largest number of its lobes
  std::map<std::string, uint32_t> replacements_;  // numbers by name
  std::map<std::string, Emission> emissions_;     // by the name of the material
  std::set<std::string> lit_;                     // names whose emission was used
  std::set<std::string> replaced_;                // names whose replacement was used
  uint32_t grey_ = kNone;
  Strays strays_;  // strays of the world
  std::set<std::string> warned_;
  std::unordered_set<std::string> fileNames_;  // the names in Scene::files
  OnWarning onWarning_;
};

}  // namespace bnvpl
