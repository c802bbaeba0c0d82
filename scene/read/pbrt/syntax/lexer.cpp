#include "scene/read/pbrt/syntax/lexer.h"

#include <charconv>
#include <cmath>

namespace bnvpl::pbrt {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool endsWord(char c) { return isBlank(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

}  // namespace

std::string Place::text() const {
  return (file ? *file : std::string("scene")) + ":" + std::to_string(line) + ":" +
         std::to_string(column);
}

void failAt(const Place& place, const std::string& problem) {
  throw InputError(place.text() + ": " + problem);
}

void Lexer::skipBlanks() {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (c == '#') {
      at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
    } else if (isBlank(c)) {
      ++at_;
      const bool lineEnds = c == '\n' || (c == '\r' && !text_.substr(at_).starts_with('\n'));
      if (lineEnds) {
        ++line_;
        lineBegin_ = at_;
      }
    } else {
      return;
    }
  }
}

Token Lexer::take(Token::Kind kind, size_t begin, size_t end, size_t after) {
  const Token token{kind,
                    text_.substr(begin, end - begin),
                    {&file_, line_, static_cast<uint32_t>(at_ - lineBegin_ + 1)}};
  at_ = after;
  return token;
}

Token Lexer::next() {
  skipBlanks();
  if (at_ >= text_.size()) return take(Token::Kind::End, text_.size(), text_.size(), at_);
  switch (text_[at_]) {
    case '[':
      return take(Token::Kind::Open, at_, at_ + 1, at_ + 1);
    case ']':
      return take(Token::Kind::Close, at_, at_ + 1, at_ + 1);
    case '"':
      for (size_t end = at_ + 1; end < text_.size() && text_[end] != '\n'; ++end) {
        if (text_[end] == '"') return take(Token::Kind::String, at_ + 1, end, end + 1);
        if (text_[end] == '\\') ++end;
      }
      failAt(take(Token::Kind::String, at_, at_, at_).place,
             "a string does not end on its line; add a closing \"");
    default: {
      size_t end = at_ + 1;
      while (end < text_.size() && !endsWord(text_[end])) ++end;
      return take(Token::Kind::Word, at_, end, end);
    }
  }
}

std::string unescaped(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      out += text[i];
      continue;
    }
    constexpr std::string_view kLetters = "bfnrt", kMeant = "\b\f\n\r\t";
    const size_t letter = kLetters.find(text[++i]);
    out += letter == std::string_view::npos ? text[i] : kMeant[letter];
  }
  return out;
}

bool toNumber(std::string_view text, double& number) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && std::isfinite(number);
}

}  // namespace bnvpl::pbrt
