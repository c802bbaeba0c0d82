#include "tools/render/preview/live_viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "tools/common/process/clock.h"
#include "tools/render/preview/tev_packets.h"

namespace bnvpl {

namespace {

constexpr int kSentSide = 64;  // side of a block, in pixels
constexpr std::chrono::seconds kRetryEvery{1};
constexpr double kFinishS = 10.0;
// Rest after each block, so that sending, and what the system does for it, takes less than one per
// cent of a thread's time.
constexpr double kRestForEach = 199.0, kLongestRestS = 0.1;

uint32_t blocks(uint32_t pixels) { return (pixels + kSentSide - 1) / kSentSide; }

}  // namespace

LiveViewer::LiveViewer(ViewerAddress to, std::string name, uint32_t width, uint32_t height)
    : name_(std::move(name)),
      width_(width),
      height_(height),
      across_(blocks(width)),
      connection_(std::move(to)),
      rgb_(size_t{3} * width * height),
      known_(size_t{across_} * blocks(height)),
      changed_(known_.size()),
      thread_([this] { run(); }) {}

LiveViewer::~LiveViewer() {
  {
    const std::scoped_lock lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

PixelBox LiveViewer::blockAt(size_t index) const {
  const int x0 = static_cast<int>(index % across_) * kSentSide,
            y0 = static_cast<int>(index / across_) * kSentSide;
  return {x0, y0, std::min(static_cast<int>(width_), x0 + kSentSide),
          std::min(static_cast<int>(height_), y0 + kSentSide)};
}

void LiveViewer::show(const PixelBox& box, std::span<const Vec3> radiance) {
  {
    const std::scoped_lock lock(mutex_);
    auto from = radiance.begin();
    for (int y = box.y0; y < box.y1; ++y) {
      float* to =
          &rgb_[3 * (size_t{width_} * static_cast<size_t>(y) + static_cast<size_t>(box.x0))];
      for (int x = box.x0; x < box.x1; ++x, ++from) {
        for (int c = 0; c < 3; ++c) *to++ = (*from)[c];
      }
    }
    for (int y = box.y0 / kSentSide; y <= (box.y1 - 1) / kSentSide; ++y) {
      for (int x = box.x0 / kSentSide; x <= (box.x1 - 1) / kSentSide; ++x) {
        const size_t block = static_cast<size_t>(y) * across_ + static_cast<size_t>(x);
        changedCount_ += !changed_[block];
        known_[block] = changed_[block] = 1;
      }
    }
  }
  wake_.notify_one();
}

void LiveViewer::show(const Image& image) {
  const std::vector<float>&r = *image.find("R"), &g = *image.find("G"), &b = *image.find("B");
  std::vector<Vec3> radiance(r.size());
  for (size_t i = 0; i < radiance.size(); ++i) radiance[i] = {r[i], g[i], b[i]};
  show({0, 0, static_cast<int>(width_), static_cast<int>(height_)}, radiance);
}

LiveViewer::Sent LiveViewer::finish() {
  {
    const std::scoped_lock lock(mutex_);
    finishing_ = true;
  }
  wake_.notify_all();
  thread_.join();
  return {sent_, sent_ > 0 && changedCount_ == 0};
}

void LiveViewer::run() {
  std::unique_lock lock(mutex_);
  double untilS = INFINITY;
  for (;;) {
    wake_.wait(lock, [this] { return changedCount_ > 0 || finishing_ || stop_; });
    if (finishing_ && untilS == INFINITY) untilS = nowS() + kFinishS;
    if (stop_ || (finishing_ && changedCount_ == 0) || nowS() > untilS) return;
    if (sendNext(lock)) continue;
    if (finishing_) return;  // no viewer is there
    wake_.wait_for(lock, kRetryEvery, [this] { return finishing_ || stop_; });
  }
}

// Sends one changed block. Returns false if no viewer takes it.
bool LiveViewer::sendNext(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  const bool isNew = !connection_.isOpen();
  if (isNew) {
    // An image of an earlier run with another size would stay.
    const bool there = connection_.open() && connection_.send(tevCloseImage(name_)) &&
                       connection_.send(tevCreateImage(name_, width_, height_));
    lock.lock();
    if (!there) return false;
    changed_ = known_;
    changedCount_ = static_cast<size_t>(std::ranges::count(changed_, 1));
  } else {
    lock.lock();
  }
  const double startS = nowS();
  // Round robin, so that no block waits for ever.
  while (!changed_[next_]) next_ = (next_ + 1) % changed_.size();
  const size_t block = next_;
  next_ = (next_ + 1) % changed_.size();
  changed_[block] = 0, --changedCount_;
  const PixelBox box = blockAt(block);
  std::vector<float> pixels;
  for (int y = box.y0; y < box.y1; ++y) {
    const auto row = rgb_.begin() + 3 * (std::ptrdiff_t{width_} * y + box.x0);
    pixels.insert(pixels.end(), row, row + std::ptrdiff_t{3} * (box.x1 - box.x0));
  }
  lock.unlock();
  const bool taken = connection_.send(tevUpdateImage(name_, box, pixels));
  const double restS = std::min(kLongestRestS, kRestForEach * (nowS() - startS));
  lock.lock();
  sent_ += taken;
  if (!taken) changedCount_ += !changed_[block], changed_[block] = 1;
  if (taken)
    wake_.wait_for(lock, std::chrono::duration<double>(restS),
                   [this] { return finishing_ || stop_; });
  return taken;
}

}  // namespace bnvpl
