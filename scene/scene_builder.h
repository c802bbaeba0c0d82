// Where the loaders of all formats meet: they add what they read, and finish() makes a Scene of it.
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
// Lengths are the scene's own unit, angles radians, colours linear sRGB; y is up where a format has
// no up of its own. Colours and powers must be finite and not negative, directions of unit length:
// the loader refuses or repairs what is not, and warns. Numbers that add...() returns count from 0.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>

#include "scene/affine.h"
#include "scene/scene.h"
#include "scene/strays.h"
#include "scene/textures/texture_pool.h"

namespace bnvpl {

inline constexpr std::array<uint32_t, 3> kNoCorners{kNone, kNone, kNone};

// A mesh as its file gives it. The arrays are borrowed until addMesh() returns.
struct Mesh {
  std::span<const double> positions;  // x, y, z of each vertex
  std::span<const double> normals;    // x, y, z of each, of any length; 0: none
  std::span<const double> uvs;        // u, v of each, v = 0 at the bottom row of a texture
  // Corners count in the arrays above; kNone, or beyond them: the corner has no such thing.
  // `material` is a number of addMaterial(); kNone: grey. A face is seen, and shines, from the side
  // where its corners run anti-clockwise.
  std::vector<Triangle> triangles;
};

class SceneBuilder {
 public:
  // What becomes of a texture that cannot be read.
  static constexpr const char* kPlainColour = "the plain material colour is used";
  // `sceneFile` names the scene in messages and is the first of the files. Each warning goes to
  // `onWarning` as it arises, also where an error follows and there is no Scene to hold it.
  explicit SceneBuilder(fs::path sceneFile, OnWarning onWarning = {});

  // Of a format that has one camera.
  void setFilm(const Film& film);
  // camera.position is what `position` becomes.
  void setCamera(const FilePoint& position, const Camera& camera);
  // Of a format that has several; the first is the scene's unless the user chooses. A scene without
  // any camera gets one that sees all of it, with a warning.
  void addCamera(const std::string& name, const FilePoint& position, const Camera& camera,
                 const Film& film);

  // A texture that will be wanted: it is decoded while the loader goes on. Nothing comes of it but
  // time.
  void expectTexture(const TextureUse& use) { textures_.expect(use); }
  // The number for a Material's map; the same for the same use. kNone, with a warning, where there
  // is no such file. One that turns out to be damaged is taken from its materials by finish().
  uint32_t addTexture(const TextureUse& use, const std::string& otherwise = kPlainColour);
  // The same for an expression that is grey, 0.5, where the image is missing or damaged.
  uint32_t addGreyableImage(const TextureUse& use, TextureExpression image);
  // The number for a parameter of a material. Its operands are numbers of expressions that were
  // added before, its image one of addTexture(); an image that turns out to be damaged counts as
  // white.
  uint32_t addExpression(const TextureExpression& expression);
  // What an expression is everywhere; nothing where it looks at texture coordinates.
  std::optional<Vec3> constantValue(uint32_t expression) const;
  uint32_t addMaterial(Material material);
  // Stands for every material of its name, which must not be empty, that is added afterwards: their
  // addMaterial() returns its number.
  uint32_t addReplacement(Material material);
  bool isReplaced(const std::string& name) const { return replaced_.contains(name); }
  // The radiance of an image, read at once; a warning counts negative pixels, which are 0. Throws
  // InputError when the file is no image.
  EnvironmentImage readEnvironment(const fs::path& image);
  uint32_t addEnvironment(const fs::path& image) {
    return addEnvironment(image, readEnvironment(image));
  }
  // One that was made of `image`.
  uint32_t addEnvironment(const fs::path& image, EnvironmentImage radiance);
  // light.position is what `position` becomes; it has no meaning for lights at infinity.
  void addLight(const LightSpec& light, const FilePoint& position = {});

  // Leaves out triangles that have a corner without a finite position, with a warning that names
  // `file`. A transform that mirrors turns the windings, so that outside stays outside. Returns how
  // many triangles have no material and became grey: why is the loader's to say. Throws InputError
  // when the scene has more vertices than 32 bits count.
  size_t addMesh(const fs::path& file, Mesh mesh, const Affine& transform = {});

  // What addMesh() gets until endPrototype() stands nowhere: addInstance() places it, as often as
  // is asked for. It is stored once if it is placed more than once, except for its lamps.
  // Prototypes hold no prototypes.
  uint32_t beginPrototype();
  void endPrototype() { open_ = kNone; }
  void addInstance(uint32_t prototype, const Affine& toWorld) {
    placed_.push_back({prototype, toWorld});
  }

  // A file that was read, or whose absence showed, for depfiles. Once each.
  void addFile(const fs::path& file);
  // Tells the user, once, what was ignored or repaired: file, problem, what became of it.
  void warn(const std::string& text);
  std::string name() const { return scene_.name(); }

  // The scene: coordinates count from where floats resolve them, opaque triangles come first,
  // triangles that floats cannot hold and doubled lamps are left out, with warnings. Throws
  // InputError when no triangle is left, when the scene is smaller or larger than floats can
  // compute with, and when a texture changed while it was read. The builder is empty afterwards.
  Scene finish();

 private:
  struct Part {  // the triangles of one addMesh()
    fs::path file;
    size_t endTriangle, endPoint;
    uint32_t prototype;   // kNone: of the world
    bool pieces = false;  // cut from faces that reach far away; floats may not hold all
  };
  struct KeptMesh {  // of a prototype, until finish()
    fs::path file;
    std::vector<double> positions, normals, uvs;
    std::vector<Triangle> triangles;
    Affine transform;
    Mesh mesh(std::vector<Triangle> of) const { return {positions, normals, uvs, std::move(of)}; }
  };
  struct Placed {
    uint32_t prototype;
    Affine toWorld;
  };
  Corners cornersOf(const Triangle& t) const {
    return {points_[t.position[0]], points_[t.position[1]], points_[t.position[2]]};
  }
  struct Base {  // where the arrays of a mesh begin in the scene's
    size_t position, normal, uv;
  };
  Base addCorners(const fs::path& file, const Mesh& mesh, const Affine& transform);
  void warnOfNegative(const std::string& image, size_t negative, size_t pixels);
  uint32_t greyMaterial();
  void recordMesh(const std::string& name, size_t triangles);

  void shareMesh(const KeptMesh& kept, uint32_t prototype);
  // Of finish(), in this order:
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
  void extendBounds();
  void placeViews();
  void requirePlace(const FilePoint& p, const char* what) const;
  void requireSize() const;

  Scene scene_;
  TexturePool textures_;
  std::vector<FilePoint> points_;  // what scene_.positions will be
  std::vector<Part> parts_;
  std::vector<std::vector<KeptMesh>> prototypes_;
  std::vector<Placed> placed_;
  uint32_t open_ = kNone;                     // prototype that meshes go to; kNone: the world
  uint32_t shared_ = kNone;                   // the same of finish()
  std::vector<uint32_t> greyable_;            // of scene_.expressions
  std::vector<uint32_t> lookups_;             // of scene_.expressions, operands included
  std::vector<FilePoint> viewPositions_;      // of scene_.views
  std::vector<FilePoint> lightPositions_;     // of scene_.lights
  std::map<std::string, size_t> meshOfName_;  // in scene_.meshes
  // Of scene_.materials: those that they are mixed of, and themselves.
  std::vector<uint32_t> mixParts_;
  std::map<std::string, uint32_t> replacements_;  // numbers by name
  std::set<std::string> replaced_;                // those of them that stood for another
  uint32_t grey_ = kNone;
  Strays strays_;  // of the world
  std::set<std::string> warned_;
  OnWarning onWarning_;
};

}  // namespace bnvpl
