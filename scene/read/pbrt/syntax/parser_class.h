// The directives of a pbrt file, one member function for each. parse() is the way in.
#pragma once

#include <set>
#include <string_view>
#include <unordered_map>

#include "scene/read/pbrt/syntax/param_list.h"
#include "scene/read/pbrt/syntax/parser.h"
#include "scene/read/pbrt/syntax/state.h"
#include "scene/read/pbrt/syntax/text_file.h"

namespace bnvpl::pbrt {

class Parser {
 public:
  Parser(Description& out, Notes& notes, fs::path folder)
      : out_(out), notes_(notes), folder_(std::move(folder)) {}

  void readFile(const fs::path& file, const Place* from);
  void requireClosed() const { states_.requireClosed(end_); }

 private:
  using Directive = void (Parser::*)(const Token&);
  static const std::unordered_map<std::string_view, Directive>& directives();

  State& now() { return states_.now(); }
  Entity entity(const Token& at, const char* target = nullptr);
  void skipUnknown(const Token& at);
  // Refuses a directive that must stand above WorldBegin, as pbrt-v4 does.
  void requireAboveWorld(const Token& at) const;

  // Transforms.
  void identity(const Token& at) { states_.setTransform(at.place, {}); }
  void translate(const Token& at);
  void scale(const Token& at);
  void rotate(const Token& at);
  void look(const Token& at);
  void transform(const Token& at) { states_.setTransform(at.place, matrix(at)); }
  void concatTransform(const Token& at) { states_.transformBy(at.place, matrix(at)); }
  void coordinateSystem(const Token& at);
  void coordSysTransform(const Token& at);
  void activeTransform(const Token& at);
  void transformTimes(const Token&) { numbers<2>(); }
  Affine matrix(const Token& at);

  // Attributes.
  void attributeBegin(const Token& at) { states_.push(at.place); }
  void attributeEnd(const Token& at) { states_.pop(at.place, "AttributeBegin"); }
  void attribute(const Token& at);
  void reverseOrientation(const Token&) { now().reverseOrientation ^= true; }
  void colorSpace(const Token& at);
  void mediumInterface(const Token& at);
  void worldBegin(const Token& at);

  // Camera, film, materials, lights and shapes.
  void camera(const Token& at);
  void film(const Token& at);
  void pixelFilter(const Token& at);
  void material(const Token& at);
  void namedMaterial(const Token& at);
  void makeNamedMaterial(const Token& at);
  void makeNamedMedium(const Token& at);
  void texture(const Token& at);
  void lightSource(const Token& at);
  void areaLightSource(const Token& at);
  void shape(const Token& at);
  void objectBegin(const Token& at);
  void objectEnd(const Token& at);
  void objectInstance(const Token& at);

  // Files and ignored directives.
  void include(const Token& at);
  void import(const Token& at);
  void ignoreOption(const Token& at);
  void option(const Token& at);
  void ignore(const Token&) {}

  template <size_t kCount>
  std::array<double, kCount> numbers() {
    return readNumbers<kCount>(*tokens_);
  }
  std::string string(const char* what) { return readString(*tokens_, what); }

  Description& out_;
  Notes& notes_;
  fs::path folder_;
  States states_;
  Tokens* tokens_ = nullptr;       // tokens of the file that is being read
  std::vector<fs::path> reading_;  // that file and those that include it
  size_t included_ = 0;
  bool inWorld_ = false;
  Object* object_ = nullptr;  // the object that ObjectBegin opened
  Place end_;
};

}  // namespace bnvpl::pbrt
