// Reads strings, numbers and parameters of directives from the tokens of a file.
#pragma once

#include <optional>
#include <span>

#include "scene/read/pbrt/syntax/description.h"

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

// Throws InputError if the next token is no string; `what` names what is expected.
std::string readString(Tokens& tokens, const char* what);

// Fills `out`, from brackets or not. Throws InputError for what is no number or beyond kMax.
void readNumbers(Tokens& tokens, std::span<double> out);
template <size_t kCount>
std::array<double, kCount> readNumbers(Tokens& tokens) {
  std::array<double, kCount> out;
  readNumbers(tokens, out);
  return out;
}

// Reads all parameters up to the next directive. Those of unknown type are noted and left out.
Params readParams(Tokens& tokens, ColorSpace colorSpace, Notes& notes);

}  // namespace bnvpl::pbrt
