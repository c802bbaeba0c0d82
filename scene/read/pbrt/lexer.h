// The text of a pbrt file as tokens, and places in it for messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/errors.h"

namespace bnvpl::pbrt {

// Where something stands. The file's name outlives it.
struct Place {
  const std::string* file = nullptr;
  uint32_t line = 0, column = 0;  // from 1
  std::string text() const;       // room.pbrt:3:14
};

// Throws InputError: place, problem and cure.
[[noreturn]] void failAt(const Place& place, const std::string& problem);

struct Token {
  enum class Kind { End, Word, String, Open, Close };  // Open, Close: brackets
  Kind kind = Kind::End;
  std::string_view text;  // of a string what is between its quotes, escapes as they are
  Place place;
};

class Lexer {
 public:
  // Both are borrowed.
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

// With \" \\ \n \t and the like replaced by what they stand for.
std::string unescaped(std::string_view text);

// A whole token as a number. False for anything else, and for what is not finite.
bool toNumber(std::string_view text, double& number);

}  // namespace bnvpl::pbrt
