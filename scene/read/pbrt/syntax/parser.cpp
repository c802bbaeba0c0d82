#include "scene/read/pbrt/syntax/parser.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/read/pbrt/syntax/parser_class.h"

namespace bnvpl::pbrt {

namespace {

constexpr size_t kMaxIncludeDepth = 64, kMaxIncludes = 10'000;
constexpr size_t kMaxAttributes = 64;  // limit on parameters of Attribute for one target

}  // namespace

const std::unordered_map<std::string_view, Parser::Directive>& Parser::directives() {
  static const std::unordered_map<std::string_view, Directive> all{
      {"Identity", &Parser::identity},
      {"Translate", &Parser::translate},
      {"Scale", &Parser::scale},
      {"Rotate", &Parser::rotate},
      {"LookAt", &Parser::look},
      {"Transform", &Parser::transform},
      {"ConcatTransform", &Parser::concatTransform},
      {"CoordinateSystem", &Parser::coordinateSystem},
      {"CoordSysTransform", &Parser::coordSysTransform},
      {"ActiveTransform", &Parser::activeTransform},
      {"TransformTimes", &Parser::transformTimes},
      {"AttributeBegin", &Parser::attributeBegin},
      {"AttributeEnd", &Parser::attributeEnd},
      {"TransformBegin", &Parser::attributeBegin},
      {"TransformEnd", &Parser::attributeEnd},
      {"Attribute", &Parser::attribute},
      {"ReverseOrientation", &Parser::reverseOrientation},
      {"ColorSpace", &Parser::colorSpace},
      {"MediumInterface", &Parser::mediumInterface},
      {"WorldBegin", &Parser::worldBegin},
      {"WorldEnd", &Parser::ignore},
      {"Camera", &Parser::camera},
      {"Film", &Parser::film},
      {"Material", &Parser::material},
      {"NamedMaterial", &Parser::namedMaterial},
      {"MakeNamedMaterial", &Parser::makeNamedMaterial},
      {"MakeNamedMedium", &Parser::makeNamedMedium},
      {"Texture", &Parser::texture},
      {"LightSource", &Parser::lightSource},
      {"AreaLightSource", &Parser::areaLightSource},
      {"Shape", &Parser::shape},
      {"ObjectBegin", &Parser::objectBegin},
      {"ObjectEnd", &Parser::objectEnd},
      {"ObjectInstance", &Parser::objectInstance},
      {"Include", &Parser::include},
      {"Import", &Parser::import},
      {"Option", &Parser::option},
      {"Sampler", &Parser::ignoreOption},
      {"Integrator", &Parser::ignoreOption},
      {"Accelerator", &Parser::ignoreOption},
      {"PixelFilter", &Parser::pixelFilter},
  };
  return all;
}

void Parser::readFile(const fs::path& file, const Place* from) {
  const fs::path real = realPath(file);
  if (std::find(reading_.begin(), reading_.end(), real) != reading_.end())
    failAt(*from, file.string() + " includes itself; remove one of the Includes");
  if (reading_.size() == kMaxIncludeDepth || included_ == kMaxIncludes) {
    failAt(*from, reading_.size() == kMaxIncludeDepth ? "Includes lie more than 64 deep"
                                                      : "more than 10000 Includes");
  }
  if (from && !isRegularFile(file))
    failAt(*from, file.string() + ": " + whyUnreadable(file, "file") + "; check its name");
  ++included_;
  out_.files.push_back(file.string());
  const std::string text = readPacked(file);
  Tokens tokens(out_.files.back(), text);
  Tokens* const outer = std::exchange(tokens_, &tokens);
  reading_.push_back(real);
  for (;;) {
    const Token token = tokens.next();
    end_ = token.place;
    if (token.kind == Token::Kind::End) break;
    if (token.kind != Token::Kind::Word) {
      failAt(token.place, "a directive is expected here, not '" + std::string(token.text) +
                              "'; is a bracket or a quote missing above?");
    }
    const auto known = directives().find(token.text);
    if (known != directives().end()) {
      (this->*known->second)(token);
    } else {
      skipUnknown(token);
    }
  }
  reading_.pop_back();
  tokens_ = outer;
}

// Skips an unknown directive, up to the next one.
void Parser::skipUnknown(const Token& at) {
  double number;
  const std::string name(at.text);
  if (toNumber(at.text, number) || name.size() > 64 || !std::isalpha(uint8_t(name[0])))
    failAt(at.place, "a directive is expected here, not '" + name.substr(0, 64) + "'");
  notes_.add(at.place, "directive '" + name + "' is unknown and ignored");
  for (;;) {
    const Token& t = tokens_->peek();
    if (t.kind == Token::Kind::End) return;
    const bool isWord = t.kind == Token::Kind::Word;
    if (isWord && !toNumber(t.text, number) && t.text != "true" && t.text != "false") return;
    tokens_->next();
  }
}

Entity Parser::entity(const Token& at, const char* target) {
  Entity e;
  e.place = at.place;
  e.type = string("a type in quotes");
  e.colorSpace = now().colorSpace;
  e.params = readParams(*tokens_, now().colorSpace, notes_);
  if (!target) return e;
  const auto set = now().attributes.find(target);
  if (set != now().attributes.end()) e.params.setFallback(set->second);
  return e;
}

void Parser::translate(const Token& at) {
  states_.transformBy(at.place, translation(numbers<3>()));
}

void Parser::scale(const Token& at) {
  const FilePoint by = numbers<3>();
  if (by[0] == 0.0 || by[1] == 0.0 || by[2] == 0.0)
    failAt(at.place, "Scale by 0 flattens the scene; use other factors");
  states_.transformBy(at.place, scaling(by));
}

void Parser::rotate(const Token& at) {
  const auto n = numbers<4>();
  if (n[1] == 0.0 && n[2] == 0.0 && n[3] == 0.0)
    failAt(at.place, "Rotate needs an axis, not 0 0 0");
  states_.transformBy(at.place, rotation(n[0], {n[1], n[2], n[3]}));
}

void Parser::look(const Token& at) {
  const auto n = numbers<9>();
  const auto camera = lookAt({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]});
  if (!camera)
    failAt(at.place, "LookAt has no direction: its points are equal, or up lies along the view");
  states_.transformBy(at.place, *camera);
}

Affine Parser::matrix(const Token& at) {
  const auto m = fromColumns(numbers<16>());
  if (!m) failAt(at.place, "the last row of a transform must be 0 0 0 1");
  if (!inverse(*m)) failAt(at.place, "the transform flattens the scene; it needs an inverse");
  return *m;
}

void Parser::coordinateSystem(const Token&) {
  states_.coordinateSystems[string("a name in quotes")] = now().transform;
}

void Parser::coordSysTransform(const Token& at) {
  const std::string name = string("a name in quotes");
  const auto known = states_.coordinateSystems.find(name);
  if (known == states_.coordinateSystems.end()) {
    notes_.add(at.place, "there is no coordinate system '" + name + "'; the transform stays");
  } else {
    states_.setTransform(at.place, known->second);
  }
}

void Parser::activeTransform(const Token& at) {
  const Token which = tokens_->next();
  if (which.text == "EndTime") {
    now().transformsStart = false;
    notes_.add(at.place, "motion is not rendered: what moves stands where its motion begins");
  } else if (which.text == "StartTime" || which.text == "All") {
    now().transformsStart = true;
  } else {
    failAt(which.place, "ActiveTransform needs StartTime, EndTime or All");
  }
}

void Parser::attribute(const Token& at) {
  const std::string target = string("a target in quotes");
  static const std::set<std::string> kTargets{"shape", "light", "material", "medium", "texture"};
  if (!kTargets.contains(target)) {
    failAt(at.place, "Attribute's target '" + target +
                         "' is unknown; use shape, light, material, medium or texture");
  }
  const Params more = readParams(*tokens_, now().colorSpace, notes_);
  auto& set = now().attributes[target];
  const auto merged = std::make_shared<Params>(set ? *set : Params());
  for (const Param* p : more.all()) merged->add(*p);
  if (merged->all().size() > kMaxAttributes)
    failAt(at.place, "Attribute sets more than 64 parameters of one target");
  set = merged;
}

void Parser::colorSpace(const Token& at) {
  const std::string name = string("a name in quotes");
  static const std::map<std::string, ColorSpace> kSpaces{{"srgb", ColorSpace::Srgb},
                                                         {"dci-p3", ColorSpace::DciP3},
                                                         {"rec2020", ColorSpace::Rec2020},
                                                         {"aces2065-1", ColorSpace::Aces}};
  const auto known = kSpaces.find(name);
  if (known == kSpaces.end()) {
    failAt(at.place,
           "color space '" + name + "' is unknown; use srgb, dci-p3, rec2020 or aces2065-1");
  }
  now().colorSpace = known->second;
}

void Parser::mediumInterface(const Token& at) {
  bool any = !string("a medium in quotes").empty();
  if (tokens_->peek().kind == Token::Kind::String) any |= !string("a medium in quotes").empty();
  now().hasMedium = any;
  if (any)
    notes_.add(at.place, "MediumInterface: media are not rendered; the space is taken as empty");
}

void Parser::requireAboveWorld(const Token& at) const {
  if (inWorld_)
    failAt(at.place, std::string(at.text) + " stands behind WorldBegin; move it above that");
}

void Parser::ignoreOption(const Token& at) {
  requireAboveWorld(at);
  entity(at);
}

void Parser::worldBegin(const Token& at) {
  if (states_.depth() > 0) failAt(at.place, "WorldBegin stands within AttributeBegin; close it");
  now().transform = {};
  now().transformsStart = true;
  inWorld_ = true;
  states_.coordinateSystems["world"] = {};
}

void parse(const fs::path& file, Description& out, Notes& notes) {
  Parser parser(out, notes, file.parent_path());
  parser.readFile(file, nullptr);
  parser.requireClosed();
}

}  // namespace bnvpl::pbrt
