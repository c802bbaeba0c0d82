// Shows the film in a viewer while it is rendered (--preview).
//
// Renderers write into a copy of the film and mark its blocks of 64 x 64 pixels as changed, which
// takes no time. A thread of its own sends changed blocks as fast as the viewer takes them: a block
// that changes again before it is sent goes out once, with its newest pixels. A viewer that comes
// late, or comes back, gets all blocks that were shown so far.
#pragma once

#include <condition_variable>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/vec3.h"
#include "formats/image/image.h"
#include "tools/render/preview/viewer_connection.h"

namespace bnvpl {

class LiveViewer {
 public:
  // `name` is what the viewer calls the image.
  LiveViewer(ViewerAddress to, std::string name, uint32_t width, uint32_t height);
  ~LiveViewer();  // without finish(), sends nothing more
  LiveViewer(const LiveViewer&) = delete;
  LiveViewer& operator=(const LiveViewer&) = delete;

  // Replaces the pixels of a box, row by row. From any thread.
  void show(const PixelBox& box, std::span<const Vec3> radiance);
  // Replaces the film by R, G, B of an image of its size.
  void show(const Image& image);
  struct Sent {
    uint64_t blocks;  // over the whole run
    bool whole;       // whether the viewer has all newest pixels
  };
  // Sends what is left, if a viewer is there, for ten seconds at most; one that takes nothing for
  // three seconds gets no more.
  Sent finish();

 private:
  void run();
  bool sendNext(std::unique_lock<std::mutex>& lock);
  PixelBox blockAt(size_t index) const;

  std::string name_;
  uint32_t width_, height_, across_;
  ViewerConnection connection_;  // used by the thread alone
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<float> rgb_;
  std::vector<uint8_t> known_, changed_;  // blocks that have pixels; those to send
  size_t changedCount_ = 0, next_ = 0;
  uint64_t sent_ = 0;
  bool finishing_ = false, stop_ = false;
  std::thread thread_;  // last, as it uses the others
};

}  // namespace bnvpl
