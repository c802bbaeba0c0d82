#include "tools/merge/shard_set.h"

#include <algorithm>
#include <tuple>

#include "formats/provenance.h"
#include "tools/common/build_id.h"
#include "tools/common/checkpoint.h"
#include "tools/common/shell_text.h"

namespace bnvpl {
namespace {

struct Info {
  ShardRun run;
  ShardParts parts;
  uint64_t of;
};

Info parseInfo(const fs::path& file, const std::string& text) {
  // One object, as the only one of an array, whose depth and letters isProvenance() judges.
  const std::string list = "[" + text + "]";
  const Json all = isProvenance(list) ? Json::parse(list) : Json::array();
  if (all.size() != 1)
    throw InputError(file, "is damaged (what it says of itself); delete it and make it again");
  const Json& json = all.front();
  Info info{
      {fieldOf<Json>(json, "run"), fieldOf<Given>(json, "given"), fieldOf<Json>(json, "sources"),
       fieldOf<std::string>(json, "command"), fieldOf<std::string>(json, "history")},
      fieldOf<ShardParts>(json, "parts"),
      fieldOf<uint64_t>(json, "of")};
  const bool history = info.run.history.empty() || isProvenance(info.run.history);
  if (!history || info.parts.empty() || info.of < 1 || info.of > kMostShards)
    throw InputError(file, "is damaged (its parts or history); delete it and make it again");
  return info;
}

std::string textOf(const ShardParts& parts) {
  std::string text;
  for (const auto& [first, last] : parts) {
    text += (text.empty() ? "" : ", ") + std::to_string(first) +
            (last > first ? "-" + std::to_string(last) : "");
  }
  return text;
}

}  // namespace

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
  works_.emplace_back(name);
  return works_.size() - 1;
}

void ShardSet::takeInfo(size_t index, const std::string& text, std::vector<Holder>& holders) {
  const fs::path& file = files_[index];
  Info info = parseInfo(file, text);
  if (holders.empty()) {
    whole_ = std::move(info.run);
    of_ = info.of;
    const std::string build = fieldOf<std::string>(whole_.run, "version");
    if (build != buildId()) {
      throw InputError(file, "was made by another build (" + build + ", this is " + buildId() +
                                 "); use its vpl-merge, or make all shards again");
    }
  } else {
    requireSameRun(file, info.run, info.of);
  }
  for (const auto& [first, last] : info.parts) holders.push_back({first, last, index});
}

void ShardSet::requireSameRun(const fs::path& file, const ShardRun& run, uint64_t of) const {
  const auto refuse = [&](const std::string& what) {
    throw InputError(file, what + "; leave it out, or make all shards by one command");
  };
  if (run.run != whole_.run) {
    const bool build =
        fieldOf<std::string>(run.run, "version") != fieldOf<std::string>(whole_.run, "version");
    refuse(std::string("is of another ") + (build ? "build" : "run") + " than " +
           files_.front().string() + " (" + differenceOf(whole_.run, run.run) + ")");
  }
  if (of != of_) {
    refuse("is one of " + std::to_string(of) + " shards, " + files_.front().string() + " one of " +
           std::to_string(of_));
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
      throw InputError(a, "and " + b.string() + " both hold shard " + std::to_string(h.first) +
                              " of " + std::to_string(of_) + "; leave one of them out");
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

std::string ShardSet::read(Record& record) {
  if (openFile_ != record.file) {
    open_ = std::ifstream(files_[record.file], std::ios::binary);
    openFile_ = record.file;
  }
  record.verified = true;
  return readShardBlock(files_[record.file], open_, record.block, record.offset);
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
      if (reader.blocks()[b].kind == kShardRecord) writer.copy(reader.blocks()[b], reader.read(b));
    }
  }
  writer.finish(shardInfo(whole_, parts_, of_));
}

}  // namespace bnvpl
