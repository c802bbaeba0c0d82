#include "scene/textures/texture_pool.h"

#include <utility>

#include "core/files.h"
#include "core/number_text.h"
#include "core/read_file.h"

namespace bnvpl {

namespace {

std::string keyOf(const TextureUse& use) {
  const auto pair = [](const std::array<float, 2>& v) {
    return shortestText(v[0]) + "," + shortestText(v[1]);
  };
  return use.file.string() + (use.srgb ? "|s" : "|l") + (use.mask ? "m" : "") + "|" +
         pair(use.scale) + "," + pair(use.offset);
}

}  // namespace

TexturePool::~TexturePool() {
  tasks_.cancel();
  tasks_.wait();
}

TexturePool::Entry& TexturePool::start(const TextureUse& use) {
  const auto [it, isNew] = entries_.try_emplace(keyOf(use));
  Entry& entry = it->second;
  if (!isNew) return entry;
  tasks_.run([use, &entry] {
    try {
      const ReadGuard guard(use.file);
      try {
        entry.texture = use.bytes ? decodeTexture(use.file, *use.bytes, use.srgb, use.mask)
                                  : loadTexture(use.file, use.srgb, use.mask);
        entry.texture.name = use.file.string();
        entry.texture.scale = use.scale;
        entry.texture.offset = use.offset;
      } catch (const InputError& e) {
        entry.problem = e.what();
      }
      guard.check();
    } catch (...) {
      entry.failure = std::current_exception();
    }
  });
  return entry;
}

void TexturePool::expect(const TextureUse& use) {
  if (use.bytes || isRegularFile(use.file)) start(use);
}

uint32_t TexturePool::add(const TextureUse& use) {
  Entry& entry = start(use);
  if (entry.number == Entry::kOnlyExpected) {
    entry.number = static_cast<uint32_t>(added_.size());
    added_.push_back(&entry);
  }
  return entry.number;
}

TexturePool::Result TexturePool::take() {
  tasks_.wait();
  Result out;
  for (Entry* entry : added_) {
    if (entry->failure) std::rethrow_exception(entry->failure);
    if (!entry->problem.empty()) {
      out.indexOf.push_back(kUnreadable);
      out.problems.push_back(std::move(entry->problem));
    } else {
      out.indexOf.push_back(static_cast<uint32_t>(out.textures.size()));
      out.textures.push_back(std::move(entry->texture));
    }
  }
  added_.clear();
  entries_.clear();
  return out;
}

}  // namespace bnvpl
