// Standard streams. A tool prints everything through these functions: they escape control
// characters in names and texts from files, and erase the progress line first.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace bnvpl {

// Opens /dev/null for each of stdin, stdout and stderr that is closed. Otherwise the next file that
// is opened would take its number and receive what is printed. Using such a stream still fails.
void occupyClosedStreams();

// Prints requested text, such as --help or a report of vpl-inspect. Throws OutputError if stdout
// cannot take it. Escapes control characters other than line breaks and tabs.
void print(const std::string& text);

// Width of the terminal that stdout is; 80 if it is none.
size_t outputColumns();

// Prints text that was not requested; returns whether stdout took it.
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

// Rewrites the progress line of a terminal, cut to the terminal's width.
void showProgress(const std::string& text);
void eraseProgress();

}  // namespace bnvpl
