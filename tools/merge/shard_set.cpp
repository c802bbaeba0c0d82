#include "tools/merge/shard_set.h"

#include <algorithm>
#include <tuple>

#include "tools/common/files/shell_text.h"
#include "tools/common/run/build_id.h"
#include "tools/common/run/checkpoint.h"
#include "tools/common/run/processor_id.h"

namespace bnvpl {

namespace {

constexpr size_t kMaxWorks = 64;  // kinds of work; a stage has at most ten
constexpr size_t kMaxOpen = 256;  // files; processes may have 1024 by default

}  // namespace

Processor processorOfShard(const fs::path& file) {
  return processorOf(parseShardInfo(file, ShardReader(file).info()).run.run);
}

ShardSet::ShardSet(const std::vector<fs::path>& files) : files_(files) {
  std::vector<Holder> holders;
  for (size_t f = 0; f < files_.size(); ++f) {
    const ShardReader reader(files_[f]);
    takeInfo(f, reader.info(), holders);
    takeRecords(f, reader);
  }
  joinParts(holders);
  const auto key = [](const Record& r) { return std::tie(r.work, r.unit); };
  std::ranges::sort(records_, {}, key);
  const auto twice = std::ranges::adjacent_find(records_, {}, key);
  if (twice != records_.end())
    throw InputError(files_[twice->file], "holds what another shard holds, too; make it again");
}

size_t ShardSet::workNamed(std::string_view name) {
  const auto found = std::ranges::find(works_, name);
  if (found != works_.end()) return static_cast<size_t>(found - works_.begin());
  if (works_.size() == kMaxWorks)
    throw InputError("the shards hold more kinds of work than a stage has; make them again");
  works_.emplace_back(name);
  return works_.size() - 1;
}

void ShardSet::takeInfo(size_t index, const std::string& text, std::vector<Holder>& holders) {
  const fs::path& file = files_[index];
  ShardInfo info = parseShardInfo(file, text);
  if (holders.empty()) {
    whole_ = std::move(info.run);
    processor_ = info.processor;
    of_ = info.of;
    requireThisPlace(file);
  } else {
    requireSameRun(file, info);
  }
  for (const auto& [first, last] : info.parts) holders.push_back({first, last, index});
}

void ShardSet::requireThisPlace(const fs::path& file) const {
  const std::string build = fieldOf<std::string>(whole_.run, "version");
  if (build != buildId()) {
    throw InputError(file, "was made by another build (" + build + ", this is " + buildId() +
                               "); use its vpl-merge, or make all shards again");
  }
  const std::string here = processorId(processorOf(whole_.run));
  if (processor_ != here) {
    throw InputError(file, "was made on a processor that rounds otherwise than this one (" +
                               processor_ + ", this is " + here +
                               "); merge on one of its kind, or make all shards again here");
  }
}

void ShardSet::requireSameRun(const fs::path& file, const ShardInfo& info) const {
  const auto refuse = [&](const std::string& what,
                          const std::string& cure = "make all shards by one command") {
    throw InputError(file, what + "; leave it out, or " + cure);
  };
  const Json& run = info.run.run;
  if (run != whole_.run) {
    const bool build =
        fieldOf<std::string>(run, "version") != fieldOf<std::string>(whole_.run, "version");
    refuse(std::string("is of another ") + (build ? "build" : "run") + " than " +
           files_.front().string() + " (" + differenceOf(whole_.run, run) + ")");
  }
  if (info.processor != processor_) {
    refuse("was made on a processor that rounds otherwise than that of " + files_.front().string() +
               " (" + info.processor + ", not " + processor_ + ")",
           "make all shards on processors of one kind");
  }
  if (info.of != of_) {
    refuse("is one of " + std::to_string(info.of) + " shards, " + files_.front().string() +
           " one of " + std::to_string(of_));
  }
}

void ShardSet::joinParts(std::vector<Holder>& holders) {
  std::ranges::sort(holders, {}, &Holder::first);
  for (size_t i = 0; i < holders.size(); ++i) {
    const Holder& h = holders[i];
    if (h.first < 1 || h.last < h.first || h.last > of_)
      throw InputError(files_[h.file], "holds parts that there are not; make it again");
    if (i > 0 && h.first <= holders[i - 1].last) {
      const fs::path &a = files_[holders[i - 1].file], &b = files_[h.file];
      throw InputError(a.string() + " and " + b.string() + " both hold shard " +
                       std::to_string(h.first) + " of " + std::to_string(of_) +
                       "; leave one of them out");
    }
    if (!parts_.empty() && parts_.back().second + 1 == h.first)
      parts_.back().second = h.last;
    else
      parts_.emplace_back(h.first, h.last);
  }
}

void ShardSet::takeRecords(size_t file, const ShardReader& reader) {
  std::vector<std::pair<std::string, size_t>> sums;
  for (size_t b = 0; b < reader.blocks().size(); ++b) {
    const ShardBlock& block = reader.blocks()[b];
    if (block.kind == kShardRecord) {
      records_.push_back({workNamed(block.name()), block.index, file, reader.offsetOf(b), block});
      continue;
    }
    if (sums.empty() || sums.back().first != block.name())
      sums.emplace_back(std::string(block.name()), 0);
    if (block.index != sums.back().second)
      throw InputError(files_[file], "is damaged (order of its sums); make it again");
    sums.back().second += block.count;
  }
  if (file == 0) sums_ = sums;
  if (sums != sums_)
    throw InputError(files_[file],
                     "has other sums than " + files_.front().string() + "; make it again");
}

void ShardSet::requireComplete() const {
  ShardParts missing;
  uint64_t next = 1;
  for (const auto& [first, last] : parts_) {
    if (first > next) missing.emplace_back(next, first - 1);
    next = last + 1;
  }
  if (next <= of_) missing.emplace_back(next, of_);
  if (missing.empty()) return;
  const auto [first, last] = missing.front();
  throw InputError("of " + std::to_string(of_) + " shards these are missing: " + textOf(missing) +
                   "; make " + (missing.size() > 1 ? "the first" : "them") + " with " +
                   commandFor({first - 1, last, of_}));
}

std::string ShardSet::commandFor(const Shard& shard, const std::string& more) const {
  const std::string range = bnvpl::textOf(shard);
  std::string name = range + kShardExtension;
  name.replace(name.find('/'), 1, "-of-");
  return whole_.command + " --shard " + range + more + " -o " +
         shellWord((files_.front().parent_path() / name).string());
}

ShardSource ShardSet::source() {
  return {[this](std::string_view work, uint64_t unit) { return record(work, unit); },
          [this](std::string_view work, size_t count) { return sums(work, count); }, of_};
}

std::optional<std::string> ShardSet::record(std::string_view work, uint64_t unit) {
  const size_t named = workNamed(work);
  const auto at =
      std::ranges::lower_bound(records_, std::pair(named, unit), {},
                               [](const Record& r) { return std::pair(r.work, r.unit); });
  if (at == records_.end() || at->work != named || at->unit != unit) return {};
  return read(*at);
}

// Units take turns among the shards, so the files stay open.
std::ifstream& ShardSet::opened(size_t file) {
  if (const auto known = open_.find(file); known != open_.end()) return known->second;
  if (open_.size() == kMaxOpen) open_.clear();
  return open_.emplace(file, std::ifstream(files_[file], std::ios::binary)).first->second;
}

std::string ShardSet::read(Record& record) {
  if (!record.verified) progress_(1);
  record.verified = true;
  return readShardBlock(files_[record.file], opened(record.file), record.block, record.offset);
}

void ShardSet::verifyRest() {
  for (Record& record : records_) {
    if (!record.verified) read(record);
  }
}

std::vector<int64_t> ShardSet::sums(std::string_view work, size_t count) const {
  const auto known = std::ranges::find(sums_, work, &std::pair<std::string, size_t>::first);
  if (known == sums_.end() || known->second != count)
    throw InputError(files_.front(), "lacks sums of its stage; make all shards again");
  std::vector<int64_t> all(count);
  for (const fs::path& file : files_) {
    ShardReader reader(file);
    for (size_t b = 0; b < reader.blocks().size(); ++b) {
      const ShardBlock& block = reader.blocks()[b];
      if (block.kind == kShardSums && block.name() == work) reader.addSums(b, all);
    }
  }
  return all;
}

void ShardSet::writeTo(AtomicFile& output) {
  ShardWriter writer(output);
  for (const auto& [work, count] : sums_) writer.sums(work, sums(work, count));
  for (const fs::path& file : files_) {
    ShardReader reader(file);
    for (size_t b = 0; b < reader.blocks().size(); ++b) {
      if (reader.blocks()[b].kind != kShardRecord) continue;
      writer.copy(reader.blocks()[b], reader.read(b));
      progress_(1);
    }
  }
  writer.finish(textOf(ShardInfo{whole_, processor_, parts_, of_}));
}

}  // namespace bnvpl
