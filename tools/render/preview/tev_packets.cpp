#include "tools/render/preview/tev_packets.h"

#include <array>
#include <bit>
#include <cstring>

namespace bnvpl {

namespace {

static_assert(std::endian::native == std::endian::little, "packets are little-endian");

enum class Type : uint8_t { Close = 2, Create = 4, Update = 6 };  // update is its third version

class Packet {
 public:
  explicit Packet(Type type) { (*this)(uint32_t{0})(type); }
  template <typename T>
  Packet& operator()(T number) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    return append(&number, sizeof number);
  }
  Packet& operator()(std::string_view text) {
    append(text.data(), text.size());
    return (*this)('\0');
  }
  Packet& append(const void* data, size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
    return *this;
  }
  std::string done() && {
    const auto length = static_cast<uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof length);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

constexpr std::array<std::string_view, 3> kChannels{"R", "G", "B"};
constexpr bool kGrabFocus = false;  // the viewer stays on the image that is looked at

}  // namespace

std::string tevCreateImage(std::string_view name, uint32_t width, uint32_t height) {
  Packet packet(Type::Create);
  packet(kGrabFocus)(name)(width)(height)(static_cast<uint32_t>(kChannels.size()));
  for (const std::string_view channel : kChannels) packet(channel);
  return std::move(packet).done();
}

std::string tevUpdateImage(std::string_view name, const PixelBox& box, std::span<const float> rgb) {
  Packet packet(Type::Update);
  packet(kGrabFocus)(name)(static_cast<uint32_t>(kChannels.size()));
  for (const std::string_view channel : kChannels) packet(channel);
  packet(int32_t{box.x0})(int32_t{box.y0})(int32_t{box.x1 - box.x0})(int32_t{box.y1 - box.y0});
  for (size_t c = 0; c < kChannels.size(); ++c) packet(static_cast<int64_t>(c));    // first float
  for (size_t c = 0; c < kChannels.size(); ++c) packet(int64_t{kChannels.size()});  // stride
  packet.append(rgb.data(), rgb.size_bytes());
  return std::move(packet).done();
}

std::string tevCloseImage(std::string_view name) {
  Packet packet(Type::Close);
  packet(name);
  return std::move(packet).done();
}

}  // namespace bnvpl
