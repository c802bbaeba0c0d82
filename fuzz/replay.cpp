// The fuzz targets without a fuzzer: every file of a corpus, then damaged ones, the same each time.
//   replay_obj fuzz/corpus/obj 500
// The tests run this in the release build; scripts/fuzz.sh looks for more, with sanitizers.
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

namespace fs = std::filesystem;
constexpr size_t kMaxBytes = 4096;
constexpr unsigned kMaxSecondsEach = 60;

std::vector<std::string> filesIn(const fs::path& folder) {
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path());
  std::ranges::sort(names);
  std::vector<std::string> files;
  for (const fs::path& name : names) {
    std::ifstream in(name, std::ios::binary);
    files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return files;
}

// Random numbers whose sequence every standard library agrees on.
size_t below(size_t end, std::mt19937_64& random) { return end == 0 ? 0 : random() % end; }

// One to four changes: a bit turned, bytes overwritten, left out or doubled, the end cut off, or
// bytes of another file put in.
std::string damaged(std::string bytes, const std::string& other, std::mt19937_64& random) {
  constexpr unsigned char kOddBytes[] = {0x00, 0x01, 0x7f, 0x80, 0xff, '-', '9', '\n', ' '};
  for (size_t change = 1 + below(4, random); change > 0; --change) {
    const size_t at = below(bytes.size(), random);
    const size_t length = std::min<size_t>(1 + below(16, random), bytes.size() - at);
    switch (below(6, random)) {
      case 0:
        if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8, random)));
        break;
      case 1: {
        const auto odd = static_cast<char>(kOddBytes[below(sizeof kOddBytes, random)]);
        bytes.replace(at, length, length, odd);
        break;
      }
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        bytes.resize(at);
        break;
      case 5:
        bytes.insert(at, other.substr(below(other.size(), random), 64));
        break;
    }
  }
  if (bytes.size() > kMaxBytes) bytes.resize(kMaxBytes);
  return bytes;
}

void run(const std::string& input) {
  ::alarm(kMaxSecondsEach);  // ends the process, and so fails the test
  // A copy that ends where the input ends.
  const std::vector<uint8_t> bytes(input.begin(), input.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s CORPUS COUNT\n", argv[0]);
    return 2;
  }
  const std::vector<std::string> files = filesIn(argv[1]);
  const size_t count = std::strtoul(argv[2], nullptr, 10);
  if (files.empty()) {
    std::fprintf(stderr, "%s holds no file\n", argv[1]);
    return 1;
  }
  for (const std::string& file : files) run(file);
  std::mt19937_64 random(1);
  for (size_t i = 0; i < count; ++i) {
    const std::string& other = files[below(files.size(), random)];
    const std::string input = damaged(files[i % files.size()], other, random);
    std::ofstream(fs::temp_directory_path() / "replayed-last-input", std::ios::binary) << input;
    run(input);
  }
  std::printf("%zu files and %zu damaged ones\n", files.size(), count);
  return 0;
}
