// Shards and views in the graphs of Make, ninja and Snakemake give the same files, byte for byte.
#include "tests/pipeline/tool_runner.h"

namespace bnvpl {
namespace {

class Graph : public PipelineTest {
 protected:
  static constexpr const char* kScene = "scenes/test/one-bounce.toml";  // from the project's root
  static constexpr const char* kProducts[] = {"candidates.vpl", "vpls.vpl", "lit.vpl", "image.exr",
                                              "image.png"};
  bool have(const std::string& program) const { return shell(program + " --version").code == 0; }
  void run(const std::string& command) const {
    const Outcome r = shell(command);
    ASSERT_EQ(r.code, 0) << command << "\n" << r.out << r.err;
  }
  // Runs Make and returns what it printed.
  std::string made(const std::string& out, const std::string& more) const {
    const Outcome r =
        shell(std::string("make -f pipelines/Makefile SCENE=") + kScene + " OUT=" + path(out) +
              " BIN=" BNVPL_BIN_FROM_SOURCE
              " CANDIDATES=2k VPLS=200 PHOTONS=20k SPP=1 RUN_FLAGS=--quiet " +
              more);
    EXPECT_EQ(r.code, 0) << r.out << r.err;
    return r.out;
  }
  void generate(const std::string& out, const std::string& more) const {
    run(std::string("pipelines/generate_ninja.py ") + kScene + " --out " + path(out) +
        " --bin " BNVPL_BIN_FROM_SOURCE " --candidates 2k --vpls 200 --photons 20k --spp 1 " +
        more);
  }
  std::string built(const std::string& out) const {
    const Outcome r = shell("ninja -v -f " + path(out + "/build.ninja"));
    EXPECT_EQ(r.code, 0) << r.out << r.err;
    return r.out;
  }
  void expectTheSame(const std::string& a, const std::string& b) const {
    EXPECT_TRUE(fs::exists(at(a)) && readAll(at(a)) == readAll(at(b))) << a << " and " << b;
  }
  static size_t countOf(const std::string& text, const std::string& part) {
    size_t count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
      ++count;
    return count;
  }
};

TEST_F(Graph, MakeInShardsGivesTheSameFilesAndRunsWhatChanged) {
  made("whole", "");
  const std::string three = "SHARDS=3", log = made("parts", three);
  EXPECT_EQ(countOf(log, "--checkpoint "), 9u) << log;
  EXPECT_EQ(countOf(log, "vpl-merge "), 3u) << log;
  for (const char* product : kProducts)
    expectTheSame(std::string("parts/") + product, std::string("whole/") + product);
  const std::string again = made("parts", three);
  EXPECT_TRUE(contains(again, "Nothing to be done")) << again;
  const std::string photons = made("parts", three + " PHOTONS=30k");
  EXPECT_EQ(countOf(photons, "vpl-place "), 0u) << photons;
  EXPECT_EQ(countOf(photons, "/vpl-estimate "), 3u) << photons;
  EXPECT_EQ(countOf(photons, "/vpl-render "), 3u) << photons;
  fs::remove(at("parts/shards/render-2-of-3.shard"));
  const std::string missing = made("parts", three + " PHOTONS=30k");
  EXPECT_EQ(countOf(missing, "/vpl-render "), 1u) << missing;
  EXPECT_EQ(countOf(missing, "/vpl-merge "), 1u) << missing;
  EXPECT_EQ(countOf(made("parts", "SHARDS=2 PHOTONS=30k"), "/vpl-place "), 2u);
  for (const char* wrong :
       {"SHARDS=0", "SHARDS=x", "SHARDS=1.5", "SHARDS=eliminate=2", "SHARDS=2,place=0"}) {
    const Outcome r = shell("make -n -f pipelines/Makefile OUT=" + path("x") + " " + wrong);
    EXPECT_TRUE(r.code != 0 && contains(r.err, "not a whole number from 1")) << r.err;
  }
}

TEST_F(Graph, NinjaMakesTheSameShardsAsMake) {
  if (!have("ninja")) GTEST_SKIP() << "ninja is not installed";
  const std::string log = made("m", "SHARDS=2,estimate=1,render=3");
  generate("n", "--shards 2,estimate=1,render=3");
  const std::string ninja = built("n");
  for (const char* product : kProducts)
    expectTheSame(std::string("n/test-one-bounce/") + product, std::string("m/") + product);
  for (const auto& [tool, runs] : {std::pair{"/vpl-place ", 2u}, std::pair{"/vpl-estimate ", 1u},
                                   std::pair{"/vpl-render ", 3u}, std::pair{"/vpl-merge ", 2u}}) {
    EXPECT_EQ(countOf(log, tool), runs) << log;
    EXPECT_EQ(countOf(ninja, tool), runs) << ninja;
  }
  for (const std::string shard : {"shards/place-2-of-2.shard", "shards/render-3-of-3.shard"})
    EXPECT_TRUE(fs::exists(at("m/" + shard)) && fs::exists(at("n/test-one-bounce/" + shard)));
  for (const auto& [wrong, problem] :
       {std::pair{"--shards eliminate=2", "'eliminate' is none of place, estimate, render"},
        std::pair{"--shards render=0", "'0' is not a count from 1"},
        std::pair{"--shards place=1501", "more than 1500"},
        std::pair{"--launcher srun --shards 1", "add --shards N"}}) {
    const Outcome r = shell(std::string("pipelines/generate_ninja.py ") + kScene + " --out " +
                            path("x") + " " + wrong);
    EXPECT_TRUE(r.code != 0 && contains(r.err, problem)) << r.err;
  }
}

TEST_F(Graph, SnakemakeMakesTheSameFiles) {
  if (!have("snakemake")) GTEST_SKIP() << "snakemake is not installed";
  made("m", "");
  // Snakemake gets its own folder, where it keeps its metadata and whose paths hold no space.
  fs::create_directory(at("work"));
  fs::create_directory_symlink(BNVPL_SOURCE "/scenes", at("work/scenes"));
  fs::create_directory_symlink(BNVPL_BIN, at("work/bin"));
  const std::string snakemake = "snakemake -s pipelines/Snakefile -d " + path("work") +
                                " --cores 1 --config candidates=2k vpls=200 photons=20k spp=1 "
                                "shards=2,estimate=1 bin=bin scenes=" +
                                kScene + " out=" + path("s") + " ";
  run(snakemake);
  for (const char* product : kProducts)
    expectTheSame(std::string("s/test-one-bounce/") + product, std::string("m/") + product);
  const Outcome again = shell(snakemake + "-n");
  EXPECT_TRUE(contains(again.out + again.err, "Nothing to be done")) << again.out << again.err;
  // On a cluster --jobs is enough. This one takes no job.
  const Outcome cluster =
      shell("snakemake -s pipelines/Snakefile -d " + path("work") +
            " --jobs 1 --cluster false --config bin=bin scenes=" + kScene + " out=" + path("c"));
  EXPECT_TRUE(contains(cluster.out + cluster.err, "Building DAG")) << cluster.out << cluster.err;
}

TEST_F(Graph, ViewsShareTheirVpls) {
  if (!have("ninja")) GTEST_SKIP() << "ninja is not installed";
  for (const auto& [name, x] :
       {std::pair{"one", "0.3"}, std::pair{"two", "-0.2"}, std::pair{"three", "0.1"}}) {
    write(std::string(name) + ".toml",
          std::string("[film]\nwidth = 32\nheight = 24\n[camera]\nposition = [") + x +
              ", 1.2, 3.2]\nlook_at = [-0.2, 0.4, 0.0]\nup = [0.0, 1.0, "
              "0.0]\nvertical_fov_deg = 50.0\n");
  }
  const std::string two = path("one.toml") + "," + path("two.toml"), dir = "n/test-one-bounce/";
  generate("n", "--views " + two);
  const std::string log = built("n");
  EXPECT_EQ(countOf(log, "/vpl-place "), 1u) << log;
  EXPECT_EQ(countOf(log, "/vpl-estimate "), 1u) << log;
  EXPECT_EQ(countOf(log, "/vpl-render "), 2u) << log;
  generate("s", "--shards 2 --views " + two);
  built("s");
  for (const char* file : {"lit.vpl", "views/one.exr", "views/two.exr", "views/two.png"})
    expectTheSame(dir + file, "s/test-one-bounce/" + std::string(file));
  // One more frame needs no placement: the lit file stays.
  generate("n", "--views " + two + "," + path("three.toml") + " --place-views " + two);
  const std::string more = built("n");
  EXPECT_EQ(countOf(more, "/vpl-place "), 0u) << more;
  EXPECT_EQ(countOf(more, "/vpl-render "), 1u) << more;
  EXPECT_TRUE(fs::exists(at(dir + "views/three.exr")));
  const Outcome r = shell(std::string("pipelines/generate_ninja.py ") + kScene +
                          " --views x.toml --out " + path("x"));
  EXPECT_TRUE(r.code != 0 && contains(r.err, "there is no view 'x.toml'")) << r.err;
}

}  // namespace
}  // namespace bnvpl
