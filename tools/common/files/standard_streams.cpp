#include "tools/common/files/standard_streams.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/errors.h"
#include "tools/common/files/escape_text.h"

namespace bnvpl {

namespace {

std::atomic<bool> progressShown{false};
constexpr std::string_view kEraseLine = "\r\x1b[K";

void writeToStderr(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    bytes.remove_prefix(static_cast<size_t>(written));
  }
}

size_t columnsOf(int stream) {
  winsize size{};
  return ::ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

size_t outputColumns() { return columnsOf(STDOUT_FILENO); }

void occupyClosedStreams() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(fd, F_GETFD) != -1 || errno != EBADF) continue;
    // open() takes the lowest free number, which is `fd`. The opposite access mode makes every use
    // of the stream fail.
    [[maybe_unused]] const int taken =
        ::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

bool tryPrint(const std::string& text) {
  eraseProgress();
  const std::string safe = escapedText(text);
  errno = 0;
  return std::fwrite(safe.data(), 1, safe.size(), stdout) == safe.size() &&
         std::fflush(stdout) == 0;
}

void print(const std::string& text) {
  if (!tryPrint(text)) {
    throw OutputError("standard output", std::string("cannot write: ") + std::strerror(errno));
  }
}

ErrorLine::ErrorLine() {
  if (progressShown.exchange(false)) addRaw(kEraseLine);
}

ErrorLine::~ErrorLine() {
  addRaw("\n");
  flush();
}

ErrorLine& ErrorLine::add(std::string_view text) {
  escapeText(text, LineBreaks::Escape, [this](std::string_view part) { addRaw(part); });
  return *this;
}

void ErrorLine::addRaw(std::string_view bytes) {
  while (!bytes.empty()) {
    if (length_ == line_.size()) flush();
    const size_t fits = std::min(bytes.size(), line_.size() - length_);
    std::memcpy(line_.data() + length_, bytes.data(), fits);
    length_ += fits;
    bytes.remove_prefix(fits);
  }
}

void ErrorLine::flush() {
  writeToStderr({line_.data(), length_});
  length_ = 0;
}

void showProgress(const std::string& text) {
  progressShown = true;
  writeToStderr(std::string(kEraseLine) + text.substr(0, columnsOf(STDERR_FILENO) - 1));
}

void eraseProgress() {
  if (progressShown.exchange(false)) writeToStderr(kEraseLine);
}

}  // namespace bnvpl
