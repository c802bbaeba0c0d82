// stdout, stderr and stdin, whatever whoever started the tool has made of them. All that a tool
// prints goes out here: names and texts from files cannot command the terminal, and the progress
// line is erased first.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace bnvpl {

// Gives stdin, stdout and stderr something to be when they are closed: else the next file that is
// opened takes the number, and gets what is printed. Using them still fails, as on a closed one.
void occupyClosedStreams();

// For text that was asked for, such as --help or what vpl-inspect finds: throws OutputError when
// stdout cannot take it. Control characters other than line breaks and tabs are escaped.
void print(const std::string& text);

// For text that comes along: whether stdout took it.
bool tryPrint(const std::string& text);

// One line on stderr, written without allocating memory and without the C library's locks, so that
// a signal handler and a process out of memory can use it.
class ErrorLine {
 public:
  ErrorLine();   // erases the progress line
  ~ErrorLine();  // ends the line
  ErrorLine(const ErrorLine&) = delete;
  ErrorLine& operator=(const ErrorLine&) = delete;

  ErrorLine& add(std::string_view text);  // control characters and line breaks are escaped

 private:
  void addRaw(std::string_view bytes);
  void flush();

  std::array<char, 2048> line_;
  size_t length_ = 0;
};

// On a terminal: the one line that each call rewrites, cut to its width.
void showProgress(const std::string& text);
void eraseProgress();

}  // namespace bnvpl
