// Shards of vpl-place that hold too few VPLs, and --shard-spare, which makes more.
#include "formats/shard/shard_file.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using PlaceShards = PipelineTest;

TEST_F(PlaceShards, SpareIsAShareOfTheShardsPart) {
  const std::string place = scene_ + " -n 40k --shard 1/2 --quiet -o ";
  succeed("vpl-place", place + path("none.shard"));
  succeed("vpl-place", place + path("some.shard") + " --shard-spare 1");
  const auto none = static_cast<double>(fs::file_size(at("none.shard")));
  EXPECT_NEAR(static_cast<double>(fs::file_size(at("some.shard"))), 1.95 * none, 0.1 * none);
}

TEST_F(PlaceShards, TheCommandOfTheMessageMakesMore) {
  const std::string place = scene_ + " -n 20k --quiet -o ";
  succeed("vpl-place", place + path("whole.vpl"));
  for (const std::string part : {"1", "2"})
    succeed("vpl-place", place + path(part + ".shard") + " --shard " + part + "/2");
  {  // the first shard without the last third of its records
    ShardReader reader(at("1.shard"));
    AtomicFile file(at("short.shard"));
    ShardWriter writer(file);
    for (size_t b = 0; b < reader.blocks().size() * 2 / 3; ++b)
      writer.record(reader.blocks()[b].name(), reader.blocks()[b].index, reader.read(b));
    writer.finish(reader.info());
    file.commit();
  }
  const std::string merge = path("2.shard") + " --quiet -o " + path("merged.vpl") + " ";
  const Outcome r = tool("vpl-merge", merge + path("short.shard"));
  EXPECT_EQ(r.code, kExitInput) << r.err;
  EXPECT_TRUE(contains(r.err, "too few VPLs: shard 1 ended early")) << r.err;
  const size_t by = r.err.find(", by ");
  ASSERT_NE(by, std::string::npos) << r.err;
  const std::string command = r.err.substr(by + 5);
  EXPECT_TRUE(contains(command, "--shard-spare")) << command;
  write("more.sh", "PATH='" BNVPL_BIN "':$PATH\ncd " + path("") + "\n" + command);
  ASSERT_EQ(shell("bash -e " + path("more.sh")).code, 0) << command;
  succeed("vpl-merge", merge + path("1-of-2.shard"));
  EXPECT_EQ(readAll(at("merged.vpl")), readAll(at("whole.vpl")));
}

}  // namespace
}  // namespace bnvpl
