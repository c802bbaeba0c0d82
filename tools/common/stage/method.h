// A method of a stage: one folder with its code, its test and its theory.md. The build lists the
// folders of a slot and generates the function that returns its methods (cmake/Methods.cmake).
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tools/common/options/option.h"

namespace bnvpl {

inline constexpr OptionKey<std::string> kMethodSlot{"method"};  // a stage with one set of methods

// Inputs that a method needs by its own fields: "scene", "lit".
template <typename M>
std::vector<std::string_view> needsOf(const M& method) {
  std::vector<std::string_view> needs;
  if constexpr (requires { method.needsScene; }) {
    if (method.needsScene) needs.push_back("scene");
  }
  if constexpr (requires { method.needsVpls; }) {
    if (method.needsVpls) needs.push_back("lit");
  }
  return needs;
}

// Options that the method says it does not work with, such as "--light spherical".
template <typename M>
std::vector<std::string_view> refusedBy(const M& method) {
  if constexpr (requires { method.refuses(); }) return method.refuses();
  return {};
}

// The methods of a slot as entries of its StageSpec.
template <typename M>
std::vector<MethodEntry> entriesOf(std::span<const M* const> methods) {
  std::vector<MethodEntry> entries;
  for (const M* m : methods)
    entries.push_back({m->name, m->summary, m->options, needsOf(*m), refusedBy(*m)});
  return entries;
}

// The method called `name`, which exists: resolve() refuses other names.
template <typename M>
const M& methodNamed(std::span<const M* const> methods, std::string_view name) {
  for (const M* m : methods) {
    if (m->name == name) return *m;
  }
  throw std::logic_error("no method " + std::string(name));
}

}  // namespace bnvpl
