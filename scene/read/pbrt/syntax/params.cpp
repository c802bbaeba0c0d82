#include "scene/read/pbrt/syntax/params.h"

#include <algorithm>
#include <cmath>

#include "core/number_text.h"

namespace bnvpl::pbrt {

namespace {

std::string quoted(const std::string& name) { return "'" + name + "'"; }

double oneNumber(const Param& p, double lower, double upper) {
  if (p.numbers.size() != 1) failAt(p.place, quoted(p.name) + " must be one number");
  if (p.numbers[0] < lower || p.numbers[0] > upper) {
    failAt(p.place, quoted(p.name) + " is " + shortestText(p.numbers[0]) + "; it must be from " +
                        shortestText(lower) + " to " + shortestText(upper));
  }
  return p.numbers[0];
}

}  // namespace

void Params::add(Param param) {
  std::erase_if(params_, [&](const Param& p) { return p.name == param.name; });
  params_.push_back(std::move(param));
}

const Param* Params::lookUp(const std::string& name) const {
  for (const Param& p : params_) {
    if (p.name == name) return &p;
  }
  return nullptr;
}

const Param* Params::find(const std::string& name) const {
  if (const Param* own = lookUp(name)) {
    own->used = true;
    return own;
  }
  return fallback_ ? fallback_->lookUp(name) : nullptr;
}

const Param* Params::find(const std::string& name, std::initializer_list<ParamType> types,
                          const char* expected) const {
  const Param* p = find(name);
  if (p && std::find(types.begin(), types.end(), p->type) == types.end())
    failAt(p->place, quoted(name) + " must be " + expected);
  return p;
}

double Params::number(const std::string& name, double otherwise, double lower, double upper) const {
  const Param* p = find(name, {ParamType::Float, ParamType::Integer}, "a float");
  return p ? oneNumber(*p, lower, upper) : otherwise;
}

int64_t Params::integer(const std::string& name, int64_t otherwise, int64_t lower,
                        int64_t upper) const {
  const Param* p = find(name, {ParamType::Integer, ParamType::Float}, "an integer");
  if (!p) return otherwise;
  const double number = oneNumber(*p, double(lower), double(upper));
  if (number != std::floor(number)) failAt(p->place, quoted(name) + " must be an integer");
  return static_cast<int64_t>(number);
}

bool Params::boolean(const std::string& name, bool otherwise) const {
  const Param* p = find(name, {ParamType::Bool, ParamType::String}, "a bool");
  if (!p) return otherwise;
  if (p->strings.size() != 1 || (p->strings[0] != "true" && p->strings[0] != "false"))
    failAt(p->place, quoted(name) + " must be true or false");
  return p->strings[0] == "true";
}

std::string Params::text(const std::string& name, const std::string& otherwise) const {
  const Param* p = find(name, {ParamType::String}, "a string");
  if (!p) return otherwise;
  if (p->strings.size() != 1) failAt(p->place, quoted(name) + " must be one string");
  return p->strings[0];
}

FilePoint Params::point(const std::string& name, const FilePoint& otherwise) const {
  const Param* p = find(name, {ParamType::Point3}, "a point3 or vector3");
  if (!p) return otherwise;
  if (p->numbers.size() != 3) failAt(p->place, quoted(name) + " must be three numbers");
  return {p->numbers[0], p->numbers[1], p->numbers[2]};
}

const std::vector<double>& Params::floats(const std::string& name, size_t each) const {
  static const std::vector<double> kNone;
  const Param* p = find(name);
  if (!p) return kNone;
  if (p->numbers.empty() && !p->strings.empty())
    failAt(p->place, quoted(name) + " must be numbers");
  if (p->numbers.size() % each != 0) {
    failAt(p->place, quoted(name) + " has " + std::to_string(p->numbers.size()) +
                         " numbers, no multiple of " + std::to_string(each));
  }
  return p->numbers;
}

std::vector<uint32_t> Params::indices(const std::string& name, size_t each, size_t below) const {
  const std::vector<double>& numbers = floats(name, each);
  std::vector<uint32_t> out(numbers.size());
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!(numbers[i] >= 0.0 && numbers[i] < double(below))) {
      failAt(*placeOf(name), quoted(name) + " has " + shortestText(numbers[i]) +
                                 ", outside of the " + std::to_string(below) + " vertices");
    }
    if (numbers[i] != std::floor(numbers[i]))
      failAt(*placeOf(name), quoted(name) + " must be integers, not " + shortestText(numbers[i]));
    out[i] = static_cast<uint32_t>(numbers[i]);
  }
  return out;
}

const Place* Params::placeOf(const std::string& name) const {
  const Param* p = find(name);
  return p ? &p->place : nullptr;
}

void Params::ignore(std::initializer_list<const char*> names) const {
  for (const char* name : names) find(name);
}

std::vector<const Param*> Params::unused() const {
  std::vector<const Param*> out;
  for (const Param& p : params_) {
    if (!p.used) out.push_back(&p);
  }
  return out;
}

std::vector<const Param*> Params::all() const {
  std::vector<const Param*> out;
  for (const Param& p : params_) out.push_back(&p);
  return out;
}

}  // namespace bnvpl::pbrt
