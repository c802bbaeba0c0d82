// Splits the text of a pbrt file into tokens, with their places for messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/errors.h"

namespace bnvpl::pbrt {

// A place in a file. The file name must outlive it.
struct Place {
  const std::string* file = nullptr;
  uint32_t line = 0, column = 0;  // from 1
  std::string text() const;       // room.pbrt:3:14
};

// Throws InputError with place and problem.
[[noreturn]] void failAt(const Place& place, const std::string& problem);

struct Token {
  enum class Kind { End, Word, String, Open, Close };  // Open, Close: brackets
  Kind kind = Kind::End;
  std::string_view text;  // a string lacks its quotes and keeps its escapes
  Place place;
};

class Lexer {
 public:
  // Borrows both arguments.
  Lexer(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  // Throws InputError at a string that does not end on its line.
  Token next();

 private:
  void skipBlanks();
  Token take(Token::Kind kind, size_t begin, size_t end, size_t after);

  const std::string& file_;
  std::string_view text_;
  size_t at_ = 0, lineBegin_ = 0;
  uint32_t line_ = 1;
};

// Replaces the escapes \" \\ \n \t and the like.
std::string unescaped(std::string_view text);

// Converts a whole token to a number. Returns false if it is none or not finite.
bool toNumber(std::string_view text, double& number);

}  // namespace bnvpl::pbrt
