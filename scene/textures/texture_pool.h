// The textures of a scene, decoded in parallel with its loaders.
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
  fs::path file;                                   // a unique name if `bytes` holds the image
  bool srgb = true;                                // decode to linear on lookup
  bool mask = false;                               // fill the alpha channel: see loadTexture
  std::array<float, 2> scale{1, 1}, offset{0, 0};  // transform texture coordinates
  std::shared_ptr<const std::string> bytes = {};   // encoded image within another file
};

class TexturePool {
 public:
  struct Result {
    std::vector<Texture> textures;      // those that could be read, in the order of add()
    std::vector<uint32_t> indexOf;      // index in `textures` for each number, or kUnreadable
    std::vector<std::string> problems;  // file and problem of the others
  };
  static constexpr uint32_t kUnreadable = 0xffffffffu;

  TexturePool() = default;
  ~TexturePool();
  TexturePool(const TexturePool&) = delete;
  TexturePool& operator=(const TexturePool&) = delete;

  // Starts to decode a regular file; ignores others.
  void expect(const TextureUse& use);
  // Returns the number of the use, counted from 0; equal uses share one.
  uint32_t add(const TextureUse& use);
  // Waits for all textures and empties the pool. Throws InputError if a file changed while it was
  // read, and any error that is not about a damaged image, such as std::bad_alloc.
  Result take();

 private:
  struct Entry {
    static constexpr uint32_t kOnlyExpected = kUnreadable;
    uint32_t number = kOnlyExpected;
    Texture texture;
    std::string problem;         // why the texture is unreadable
    std::exception_ptr failure;  // error that take() rethrows
  };
  Entry& start(const TextureUse& use);

  std::map<std::string, Entry> entries_;  // by file and use; each task writes to its own
  std::vector<Entry*> added_;             // in the order of their numbers
  tbb::task_group tasks_;
};

}  // namespace bnvpl
