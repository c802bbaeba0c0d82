#include "scene/read/pbrt/syntax/param_list.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bnvpl::pbrt {

namespace {

constexpr size_t kMaxParams = 256;  // limit for one directive

bool isTruth(std::string_view text) { return text == "true" || text == "false"; }

double numberOf(const Token& token) {
  double number;
  if (token.kind != Token::Kind::Word || !toNumber(token.text, number)) {
    failAt(token.place,
           token.kind == Token::Kind::End
               ? "the file ends where a number is expected"
               : "a number is expected, not '" + std::string(token.text.substr(0, 64)) + "'");
  }
  return number;
}

ParamType typeOf(const std::string& name) {
  static const std::map<std::string, ParamType> kTypes{
      {"integer", ParamType::Integer},  {"float", ParamType::Float},
      {"bool", ParamType::Bool},        {"string", ParamType::String},
      {"texture", ParamType::Texture},  {"point2", ParamType::Point2},
      {"vector2", ParamType::Point2},   {"point3", ParamType::Point3},
      {"vector3", ParamType::Point3},   {"point", ParamType::Point3},
      {"vector", ParamType::Point3},    {"normal", ParamType::Point3},
      {"normal3", ParamType::Point3},   {"rgb", ParamType::Rgb},
      {"color", ParamType::Rgb},        {"blackbody", ParamType::Blackbody},
      {"spectrum", ParamType::Spectrum}};
  const auto known = kTypes.find(name);
  return known == kTypes.end() ? ParamType::Unknown : known->second;
}

bool wantsStrings(ParamType type) {
  return type == ParamType::String || type == ParamType::Texture || type == ParamType::Bool;
}

// Parses the declaration "type name" of a parameter.
Param declared(const Token& token) {
  const std::string text = unescaped(token.text);
  const size_t typeEnd = text.find_first_of(" \t"), name = text.find_first_not_of(" \t", typeEnd);
  if (typeEnd == 0 || name == std::string::npos)
    failAt(token.place, "\"" + text.substr(0, 64) + "\" must be a type and a name");
  Param p;
  p.type = typeOf(text.substr(0, typeEnd));
  p.name = text.substr(name, text.find_first_of(" \t", name) - name);
  p.place = token.place;
  return p;
}

void addValue(Param& p, const Token& token) {
  if (token.kind == Token::Kind::String || (token.kind == Token::Kind::Word && isTruth(token.text)))
    p.strings.push_back(unescaped(token.text));
  else
    p.numbers.push_back(std::clamp(numberOf(token), -kMax, kMax));  // FLT_MAX: no limit
}

void checkValues(const Param& p) {
  const bool strings = wantsStrings(p.type), either = p.type == ParamType::Spectrum;
  if (!p.numbers.empty() && !p.strings.empty())
    failAt(p.place, "'" + p.name + "' mixes numbers and strings");
  if (p.type == ParamType::Unknown || either) return;
  if (strings ? !p.numbers.empty() : !p.strings.empty()) {
    failAt(p.place, "'" + p.name + "' must be " +
                        (p.type == ParamType::Bool ? "true or false"
                         : strings                 ? "a string"
                                                   : "numbers"));
  }
}

}  // namespace

Token Tokens::next() {
  if (!ahead_) return lexer_.next();
  const Token token = *ahead_;
  ahead_.reset();
  return token;
}

const Token& Tokens::peek() {
  if (!ahead_) ahead_ = lexer_.next();
  return *ahead_;
}

std::string readString(Tokens& tokens, const char* what) {
  bool bracket = false;
  Token token = tokens.next();
  if (token.kind == Token::Kind::Open) {
    bracket = true;
    token = tokens.next();
  }
  if (token.kind != Token::Kind::String)
    failAt(token.place, std::string(what) + " is expected here, not '" +
                            std::string(token.text.substr(0, 64)) + "'");
  if (bracket && tokens.next().kind != Token::Kind::Close)
    failAt(token.place, "one string is expected in these brackets");
  return unescaped(token.text);
}

void readNumbers(Tokens& tokens, std::span<double> out) {
  const bool bracket = tokens.peek().kind == Token::Kind::Open;
  if (bracket) tokens.next();
  for (double& number : out) {
    const Token token = tokens.next();
    number = numberOf(token);
    if (std::fabs(number) > kMax)
      failAt(token.place, "the number " + std::string(token.text) + " is beyond 1e30");
  }
  if (!bracket) return;
  const Token close = tokens.next();
  if (close.kind != Token::Kind::Close)
    failAt(close.place, std::to_string(out.size()) + " numbers are expected in these brackets");
}

Params readParams(Tokens& tokens, ColorSpace colorSpace, Notes& notes) {
  Params params;
  while (tokens.peek().kind == Token::Kind::String) {
    Param p = declared(tokens.next());
    p.colorSpace = colorSpace;
    Token value = tokens.next();
    if (value.kind == Token::Kind::Open) {
      for (value = tokens.next(); value.kind != Token::Kind::Close; value = tokens.next()) {
        if (value.kind == Token::Kind::End)
          failAt(p.place, "the values of '" + p.name + "' do not end; add a ]");
        addValue(p, value);
      }
    } else {
      addValue(p, value);
    }
    checkValues(p);
    if (p.type == ParamType::Unknown) {
      notes.add(p.place, "parameter '" + p.name + "' has an unknown type and is ignored");
    } else {
      const Place place = p.place;
      params.add(std::move(p));
      if (params.all().size() > kMaxParams) failAt(place, "more than 256 parameters");
    }
  }
  return params;
}

}  // namespace bnvpl::pbrt
