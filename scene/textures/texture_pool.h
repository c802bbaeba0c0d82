// The textures of a scene, read side by side while its loaders go on.
#pragma once

#include <tbb/task_group.h>

#include <exception>
#include <map>
#include <memory>
#include <string>

#include "scene/textures/texture.h"

namespace bnvpl {

// A file and how a material reads it.
struct TextureUse {
  fs::path file;  // or a name of its own for an image that lies in another file:
  bool srgb = true;                                // decode to linear on lookup
  bool mask = false;                               // fill the alpha channel: see loadTexture
  std::array<float, 2> scale{1, 1}, offset{0, 0};  // of the texture coordinates
  std::shared_ptr<const std::string> bytes = {};   // that image, as PNG, JPEG, ...
};

class TexturePool {
 public:
  struct Result {
    std::vector<Texture> textures;      // those that could be read, in the order of add()
    std::vector<uint32_t> indexOf;      // of each number of add(), in `textures`; kUnreadable
    std::vector<std::string> problems;  // file and problem of the others
  };
  static constexpr uint32_t kUnreadable = 0xffffffffu;

  TexturePool() = default;
  ~TexturePool();
  TexturePool(const TexturePool&) = delete;
  TexturePool& operator=(const TexturePool&) = delete;

  // Starts to read a regular file; others are passed over.
  void expect(const TextureUse& use);
  // The use's number, counted from 0; the same for the same use.
  uint32_t add(const TextureUse& use);
  // Waits, and empties the pool. Throws InputError when a file changed while it was read, and what
  // else is no matter of a damaged image, such as std::bad_alloc.
  Result take();

 private:
  struct Entry {
    static constexpr uint32_t kOnlyExpected = kUnreadable;
    uint32_t number = kOnlyExpected;
    Texture texture;
    std::string problem;         // why there is none
    std::exception_ptr failure;  // why there can be no scene
  };
  Entry& start(const TextureUse& use);

  std::map<std::string, Entry> entries_;  // by file, use and place; each task writes to its own
  std::vector<Entry*> added_;             // by number
  tbb::task_group tasks_;
};

}  // namespace bnvpl
