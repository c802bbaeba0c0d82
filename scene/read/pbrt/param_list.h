// Tokens of one file -> the strings, numbers and parameters of its directives.
#pragma once

#include <optional>
#include <span>

#include "scene/read/pbrt/description.h"

namespace bnvpl::pbrt {

class Tokens {
 public:
  Tokens(const std::string& file, std::string_view text) : lexer_(file, text) {}
  Token next();
  const Token& peek();

 private:
  Lexer lexer_;
  std::optional<Token> ahead_;
};

// Throws InputError when the next token is no string; `what` should be there.
std::string readString(Tokens& tokens, const char* what);

// In brackets or not. Throws InputError when they are no numbers, or beyond kMax.
void readNumbers(Tokens& tokens, std::span<double> out);
template <size_t kCount>
std::array<double, kCount> readNumbers(Tokens& tokens) {
  std::array<double, kCount> out;
  readNumbers(tokens, out);
  return out;
}

// All "type name" values up to the next directive. Those of an unknown type are noted and left out.
Params readParams(Tokens& tokens, ColorSpace colorSpace, Notes& notes);

}  // namespace bnvpl::pbrt
