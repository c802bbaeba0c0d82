#include "core/hash.h"

#include <xxhash.h>

#include <cstdio>
#include <new>

namespace bnvpl {

Hasher::Hasher() : state_(XXH3_createState(), [](XXH3_state_s* state) { XXH3_freeState(state); }) {
  if (!state_) throw std::bad_alloc();
  XXH3_64bits_reset(state_.get());
}
void Hasher::add(Bytes bytes) { XXH3_64bits_update(state_.get(), bytes.data(), bytes.size()); }
uint64_t Hasher::digest() const { return XXH3_64bits_digest(state_.get()); }

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
