#include "core/hash.h"

#define XXH_STATIC_LINKING_ONLY  // declares the state's members, so that it needs no allocator
#include <xxhash.h>

#include <cstdio>

namespace bnvpl {

struct Hasher::State {
  XXH3_state_t hash;
};

Hasher::Hasher() : state_(std::make_unique<State>()) { XXH3_64bits_reset(&state_->hash); }
Hasher::~Hasher() = default;
void Hasher::add(Bytes bytes) { XXH3_64bits_update(&state_->hash, bytes.data(), bytes.size()); }
uint64_t Hasher::digest() const { return XXH3_64bits_digest(&state_->hash); }

uint64_t hashPieces(const std::vector<Bytes>& pieces) {
  Hasher hasher;
  for (const Bytes piece : pieces) hasher.add(piece);
  return hasher.digest();
}

std::string hashText(uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace bnvpl
