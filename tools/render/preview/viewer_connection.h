// TCP connection to a viewer that may come and go.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "tools/common/options/cli_types.h"

namespace bnvpl {

// Address such as "localhost:14158", "render7" or "[::1]:14158".
struct ViewerAddress {
  std::string host;
  uint16_t port;
};
// "localhost:14158", "[::1]:14158"
std::string addressText(const ViewerAddress& address);
void addPreviewOption(CLI::App& cli, std::string& address);
// Throws UsageError for a text that is no address, or a host that has none.
ViewerAddress parseViewerAddress(const std::string& text);

class ViewerConnection {
 public:
  explicit ViewerConnection(ViewerAddress to) : to_(std::move(to)) {}
  ~ViewerConnection() { close(); }
  ViewerConnection(const ViewerConnection&) = delete;
  ViewerConnection& operator=(const ViewerConnection&) = delete;

  // Whether the viewer is there, as far as is known before the next send.
  bool isOpen();
  // Tries once, for some seconds at most. Returns whether the viewer is there.
  bool open();
  // Returns false, and closes, if the viewer has gone or takes nothing for some seconds.
  bool send(std::string_view bytes);

 private:
  void close();
  ViewerAddress to_;
  int socket_ = -1;
};

}  // namespace bnvpl
