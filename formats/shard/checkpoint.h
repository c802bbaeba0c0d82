// The state of an interrupted stage. The bytes on disk, little-endian:
//
//     0  CheckpointHeader, 64 bytes
//    64  run: UTF-8 JSON that identifies the run of the state
//     .  state: bytes of the stage
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/errors.h"

namespace bnvpl {

struct CheckpointHeader {
  std::array<char, 8> magic{'\x89', 'V', 'P', 'L', 'C', 'K', 'P', '\n'};
  uint32_t version = 1;
  uint32_t reserved0 = 0;
  uint64_t runBytes = 0;
  uint64_t stateBytes = 0;
  uint64_t checksum = 0;  // XXH3-64 of the whole file with this field taken as zero
  std::array<char, 24> reserved{};
};
static_assert(sizeof(CheckpointHeader) == 64);

struct CheckpointFile {
  std::string run, state;
};

// Whether `file` begins like a checkpoint; empty if it cannot be read. Does not throw.
std::optional<bool> beginsAsCheckpoint(const fs::path& file);

// None where there is no such file, as when another run has just removed it. Throws InputError if
// the file cannot be read or is damaged, cut short or of another version.
std::optional<CheckpointFile> findCheckpoint(const fs::path& file);

// Replaces `file` atomically. Throws OutputError, and then keeps the old file.
void writeCheckpoint(const fs::path& file, const CheckpointFile& checkpoint);

}  // namespace bnvpl
