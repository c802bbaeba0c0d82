// XXH3-64, the checksum of all files and the identity of scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct XXH3_state_s;

namespace bnvpl {

using Bytes = std::span<const std::byte>;

template <typename T>
Bytes bytesOf(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

// Hashes what is added as one sequence of bytes.
class Hasher {
 public:
  Hasher();  // throws std::bad_alloc
  void add(Bytes bytes);
  uint64_t digest() const;

 private:
  std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)> state_;
};

// Hash of the concatenated pieces.
uint64_t hashPieces(const std::vector<Bytes>& pieces);

std::string hashText(uint64_t hash);  // 16 hexadecimal digits

}  // namespace bnvpl
