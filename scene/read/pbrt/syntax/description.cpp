#include "scene/read/pbrt/syntax/description.h"

namespace bnvpl::pbrt {

std::string nameOf(const Entity& entity, const fs::path& folder) {
  const std::string name = entity.params.text("name");
  if (!name.empty()) return name;
  const fs::path file = fs::path(*entity.place.file).lexically_proximate(folder);
  return file.string() + ":" + std::to_string(entity.place.line);
}

void Notes::add(const Place& place, const std::string& text) {
  const auto [it, isNew] = numberOf_.try_emplace(text, entries_.size());
  if (isNew) entries_.push_back({place, text, 0});
  ++entries_[it->second].count;
}

std::vector<std::string> Notes::lines() const {
  std::vector<std::string> out;
  for (const Entry& e : entries_) {
    out.push_back(e.place.text() + ": " + e.text +
                  (e.count > 1 ? " (and " + std::to_string(e.count - 1) + " more)" : ""));
  }
  return out;
}

}  // namespace bnvpl::pbrt
