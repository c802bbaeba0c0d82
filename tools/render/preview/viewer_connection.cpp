#include "tools/render/preview/viewer_connection.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <memory>

#include "core/errors.h"
#include "tools/common/options/cli_option.h"
#include "tools/render/preview/tev_packets.h"

namespace bnvpl {

namespace {

constexpr timeval kPatience{.tv_sec = 3, .tv_usec = 0};  // for a connection, and for a send

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

// The addresses of a host; null if it has none.
Addresses lookUp(const ViewerAddress& to) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  const int error = ::getaddrinfo(to.host.c_str(), std::to_string(to.port).c_str(), &hints, &found);
  return {error == 0 ? found : nullptr, &::freeaddrinfo};
}

}  // namespace

std::string addressText(const ViewerAddress& a) {
  const bool bracketed = a.host.find(':') != std::string::npos;
  return (bracketed ? "[" + a.host + "]" : a.host) + ":" + std::to_string(a.port);
}

void addPreviewOption(CLI::App& cli, std::string& address) {
  addOption(cli,
            inTopic(Topic::Main, textOption("preview", "", "HOST[:PORT]",
                                            "show the image while it comes, in the viewer tev")),
            [&address](const Value& value) { address = std::get<std::string>(value); });
}

ViewerAddress parseViewerAddress(const std::string& text) {
  const auto bad = [&] {
    return UsageError("--preview '" + text + "' is not HOST:PORT; write one such as localhost:" +
                      std::to_string(kTevPort));
  };
  const bool bracketed = text.starts_with('[');
  const size_t hostEnd = bracketed ? text.find(']') : text.find(':');
  if (bracketed && hostEnd == std::string::npos) throw bad();
  ViewerAddress to{text.substr(bracketed, hostEnd - bracketed), kTevPort};
  std::string_view rest = text;
  rest.remove_prefix(
      std::min(text.size(), hostEnd == std::string::npos ? text.size() : hostEnd + bracketed));
  if (!rest.empty()) {
    const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), to.port);
    if (rest.front() != ':' || error != std::errc() || end != rest.data() + rest.size() ||
        to.port == 0)
      throw bad();
  }
  if (to.host.empty()) throw bad();
  if (!lookUp(to)) {
    throw UsageError("--preview '" + text + "': the host " + to.host +
                     " is unknown; check its name");
  }
  return to;
}

bool ViewerConnection::isOpen() {
  char byte;
  // A viewer that has gone is at the end of its stream; one that is there says nothing.
  if (socket_ >= 0 && ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) close();
  return socket_ >= 0;
}

bool ViewerConnection::open() {
  close();
  const Addresses addresses = lookUp(to_);
  for (const addrinfo* a = addresses.get(); a && socket_ < 0; a = a->ai_next) {
    socket_ = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (socket_ < 0) continue;
    // This limit holds for connect(), too.
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
    if (::connect(socket_, a->ai_addr, a->ai_addrlen) != 0) close();
  }
  return socket_ >= 0;
}

bool ViewerConnection::send(std::string_view bytes) {
  while (!bytes.empty() && socket_ >= 0) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) {
      close();
      break;
    }
    bytes.remove_prefix(static_cast<size_t>(sent));
  }
  return bytes.empty();
}

void ViewerConnection::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

}  // namespace bnvpl
