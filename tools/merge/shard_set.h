// The shards of one run, as given to vpl-merge.
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "core/progress.h"
#include "tools/common/stage/shard.h"

namespace bnvpl {

// The processor option that a shard records. Throws what the constructor of ShardSet throws.
Processor processorOfShard(const fs::path& file);

class ShardSet {
 public:
  // Reads the descriptions in the files. Throws InputError, which names file and remedy, for files
  // that are damaged, of another run, build, processor or number of parts, and for parts that two
  // files hold.
  explicit ShardSet(const std::vector<fs::path>& files);
  ShardSet(const ShardSet&) = delete;
  ShardSet& operator=(const ShardSet&) = delete;

  const ShardRun& whole() const { return whole_; }
  uint64_t of() const { return of_; }
  const ShardParts& parts() const { return parts_; }
  // Throws InputError with the command that makes missing parts.
  void requireComplete() const;
  size_t records() const { return records_.size(); }
  // From now on, each record that is read for the first time counts as one unit.
  void reportTo(ProgressFn progress) { progress_ = std::move(progress); }
  // The command that makes these parts, with further options `more`.
  std::string commandFor(const Shard& shard, const std::string& more = "") const;

  ShardSource source();  // borrows this
  // Reads all records that have not been requested. Throws InputError for one that is damaged.
  void verifyRest();
  void writeTo(AtomicFile& output);  // writes all parts as one shard

 private:
  struct Record {
    size_t work;  // index into works_
    uint64_t unit;
    size_t file;
    uint64_t offset;
    ShardBlock block;
    bool verified = false;
  };
  struct Holder {  // a file that holds the parts [first, last]
    uint64_t first, last;
    size_t file;
  };
  size_t workNamed(std::string_view name);
  void takeInfo(size_t file, const std::string& text, std::vector<Holder>& holders);
  void takeRecords(size_t file, const ShardReader& reader);
  void requireThisPlace(const fs::path& file) const;
  void requireSameRun(const fs::path& file, const ShardInfo& info) const;
  void joinParts(std::vector<Holder>& holders);
  std::optional<std::string> record(std::string_view work, uint64_t unit);
  std::string read(Record& record);
  std::ifstream& opened(size_t file);
  std::vector<int64_t> sums(std::string_view work, size_t count) const;

  std::vector<fs::path> files_;
  ShardRun whole_;
  std::string processor_;
  uint64_t of_ = 0;
  ShardParts parts_;
  std::vector<std::string> works_;
  std::vector<std::pair<std::string, size_t>> sums_;  // works with sums, and their number of sums
  std::vector<Record> records_;                       // sorted by work and unit
  std::map<size_t, std::ifstream> open_;              // by index of the file
  ProgressFn progress_;
};

}  // namespace bnvpl
