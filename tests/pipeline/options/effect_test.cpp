// Options without effect, malformed numbers, and the contents of records.
#include <nlohmann/json.hpp>

#include "formats/image/exr_io.h"
#include "formats/shard/checkpoint.h"
#include "formats/vpl/vpl_io.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using Effect = PipelineTest;
using Json = nlohmann::json;

Json lastRecord(const std::string& provenance) { return Json::parse(provenance).back(); }

TEST_F(Effect, OptionsWithoutEffectAreRefused) {
  makeStages(scene_);
  const std::string lit = scene_ + " " + path("lit.vpl") + " --spp 1 -o " + path("i.exr");
  const std::string paths = scene_ + " --spp 1 --integrator path -o " + path("i.exr");
  fail("vpl-render", paths + " --clamp 5", kExitUsage, {"--clamp", "--integrator path", "vpl"});
  fail("vpl-render", paths + " --gather all", kExitUsage, {"--gather", "--integrator vpl"});
  fail("vpl-render", lit + " --max-bounces 3", kExitUsage,
       {"--max-bounces", "--integrator vpl; it needs --integrator"});
  fail("vpl-render", lit + " --exposure 2", kExitUsage, {"--exposure", "--png"});
  fail("vpl-render", lit + " --gather all --error 0.1", kExitUsage,
       {"--error", "--gather all", "tilecuts"});
  const std::string keep = path("candidates.vpl") + " -n 5 -o " + path("v.vpl");
  fail("vpl-eliminate", keep + " --density uniform --uniform-share 0.5", kExitUsage,
       {"--uniform-share", "--density uniform", "--density local"});
  fail("vpl-eliminate", keep + " --scene " + scene_, kExitUsage, {"--scene", "elimination"});
  fail("vpl-eliminate", keep + " --method rejection", kExitUsage, {"rejection", "--scene SCENE"});
  fail("vpl-place", scene_ + " -n 5 -o " + path("c.vpl") + " --light-depth 3", kExitUsage,
       {"--light-depth", "--method light"});
  EXPECT_FALSE(fs::exists(at("i.exr")) || fs::exists(at("v.vpl")) || fs::exists(at("c.vpl")));
}

// The warning says why VPLs are dark, and what helps.
TEST_F(Effect, TheWarningOfDarkVplsNamesTheCause) {
  makeStages(scene_);
  const auto warning = [&](const std::string& options) {
    const Outcome r = tool(
        "vpl-estimate", scene_ + " " + path("vpls.vpl") + " -o " + path("l.vpl") + " " + options);
    EXPECT_EQ(r.code, kExitOk) << r.err;
    return r.err;
  };
  const std::string few = warning("--photons 5"), near = warning("--radius 0.01 --photons 10k");
  EXPECT_TRUE(contains(few, "hits, for 60 VPLs; raise --photons")) << few;
  EXPECT_TRUE(contains(near, "raise --radius (1.7 unless given)")) << near;
  EXPECT_EQ(warning("--photons 10k"), "");
}

// Where all VPLs are dark, the warning speaks of no others.
TEST_F(Effect, VplsWithoutAnyLightAreToldOf) {
  write("box.toml",
        "[film]\nwidth=16\nheight=12\n[camera]\nposition=[0,0,0.9]\nlook_at=[0,0,0]\n"
        "vertical_fov_deg=60\n[[mesh]]\nfile=\"box.obj\"\n[[light]]\ntype=\"environment\"\n"
        "radiance=[1,1,1]\n");
  write("box.obj",
        "mtllib box.mtl\nusemtl w\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\n"
        "v 1 -1 1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 4 3 7 8\nf 1 4 8 5\n"
        "f 2 6 7 3\n");
  write("box.mtl", "newmtl w\nKd .5 .5 .5\n");
  const std::string box = path("box.toml") + " ";
  succeed("vpl-place", box + "-n 500 -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 50 -o " + path("v.vpl"));
  for (const std::string method : {"guarded", "both", "paths"}) {
    const Outcome r = tool("vpl-estimate", box + path("v.vpl") + " --quiet --method " + method +
                                               (method == "paths" ? "" : " --photons 10k") +
                                               " -o " + path("l.vpl"));
    EXPECT_EQ(r.code, kExitOk) << r.err;
    EXPECT_TRUE(contains(r.err, "warning: no VPL ")) << method << ": " << r.err;
    EXPECT_FALSE(contains(r.err, "the others")) << method << ": " << r.err;
  }
}

// With --only direct, options of indirect light are refused.
TEST_F(Effect, DirectLightAloneNeedsNoVpls) {
  makeStages(scene_);
  const std::string lit = scene_ + " " + path("lit.vpl") +
                          " --spp 1 --only direct --direct-samples 1 --near-field-rays 2 -o ";
  for (const char* option : {"--gather all", "--error 0.1", "--clamp 3", "--light disk"}) {
    const std::string name = std::string(option).substr(0, std::string(option).find(' '));
    fail("vpl-render", lit + path("i.exr") + " " + option, kExitUsage,
         {name + " has no effect with --only direct; it needs --only all or indirect"});
  }
  for (const char* integrator : {"path", "light"}) {
    fail("vpl-render",
         scene_ + " --spp 1 --only direct --max-bounces 3 --integrator " + integrator + " -o " +
             path("i.exr"),
         kExitUsage, {"--max-bounces has no effect with --only direct"});
  }
  succeed("vpl-render", lit + path("near.exr"));
  succeed("vpl-render", lit + path("none.exr") + " --compensate none");
  EXPECT_NE(*readExr(at("near.exr")).find("R"), *readExr(at("none.exr")).find("R"));
  fail(
      "vpl-render", scene_ + " --only direct --near-field-rays 2 -o " + path("i.exr"), kExitUsage,
      {"--near-field-rays has no effect", "it needs --only all or indirect or --direct-samples 1"});
}

// Redistribution moves light within the image; a merge of shards does the same.
TEST_F(Effect, FirefliesAreRedistributedOrKept) {
  const std::string paths = scene_ + " --spp 2 --size 32x24 --integrator path --layers all -o ";
  succeed("vpl-render", paths + path("kept.exr"));
  succeed("vpl-render", paths + path("same.exr") + " --fireflies keep");
  succeed("vpl-render", paths + path("spread.exr") + " --fireflies redistribute");
  const Image kept = readExr(at("kept.exr")), spread = readExr(at("spread.exr"));
  EXPECT_EQ(*kept.find("R"), *readExr(at("same.exr")).find("R"));
  EXPECT_NE(*kept.find("R"), *spread.find("R"));
  EXPECT_EQ(*kept.find("albedo.R"), *spread.find("albedo.R"));
  for (const char* channel : {"G", "direct.G", "indirect.G"}) {
    const auto sum = [&](const Image& image) {
      double all = 0.0;
      for (const float v : *image.find(channel)) all += double{v};
      return all;
    };
    EXPECT_NEAR(sum(spread) / sum(kept), 1.0, 1e-5) << channel;
  }
  std::string shards;
  for (const char* shard : {"1", "2"}) {
    const std::string file = path(std::string("s") + shard + ".shard");
    succeed("vpl-render", paths + file + " --fireflies redistribute --shard " + shard + "/2");
    shards += " " + file;
  }
  succeed("vpl-merge", shards + " -o " + path("merged.exr"));
  EXPECT_EQ(readAll(at("merged.exr")), readAll(at("spread.exr")));
  // With VPLs, fireflies are redistributed by default.
  makeStages(scene_);
  const std::string vpls = scene_ + " " + path("lit.vpl") + " --spp 2 --size 32x24 -o ";
  succeed("vpl-render", vpls + path("v.exr"));
  succeed("vpl-render", vpls + path("v-redistributed.exr") + " --fireflies redistribute");
  succeed("vpl-render", vpls + path("v-kept.exr") + " --fireflies keep");
  EXPECT_EQ(readAll(at("v.exr")), readAll(at("v-redistributed.exr")));
  const auto recorded = [&](const char* file) {
    const Image image = readExr(at(file));
    return Json::parse(image.attributes.at("bnvpl.provenance"))
        .back()
        .at("options")
        .at("fireflies");
  };
  EXPECT_EQ(recorded("v.exr"), "redistribute");
  EXPECT_EQ(recorded("v-kept.exr"), "keep");
  // --only direct needs no compensation, and no sample allocation where --direct-samples is given.
  for (const char* option : {"--compensate none", "--allocate off --direct-samples 3"}) {
    fail("vpl-render", scene_ + " --only direct -o " + path("i.exr") + " " + option, kExitUsage,
         {"has no effect", "--direct-samples"});
  }
}

// Layers of gathered VPLs mean nothing in an image without VPLs.
TEST_F(Effect, LayersOfVplsNeedVpls) {
  const std::string paths = scene_ + " --spp 1 --size 8x6 --integrator path -o " + path("p.exr");
  for (const char* layer : {"clamped", "cutsize", "shadowrays"}) {
    fail("vpl-render", paths + " --layers albedo," + layer, kExitUsage, {"--layers", layer});
    fail("vpl-render", paths + " --layers all," + layer, kExitUsage, {"--layers", layer});
  }
  succeed("vpl-render", paths + " --layers all");
  const Image all = readExr(at("p.exr"));
  for (const char* name : {"direct.R", "indirect.R", "albedo.R", "N.X", "Z"})
    EXPECT_NE(all.find(name), nullptr) << name;
  for (const char* name : {"clamped.R", "cutsize", "shadowrays"})
    EXPECT_EQ(all.find(name), nullptr) << name;
}

// What a gather counts is a layer of its images alone, and its mean a statistic.
TEST_F(Effect, CountersOfAGatherAreLayersAndStatistics) {
  makeStages(scene_);
  const std::string render = scene_ + " " + path("lit.vpl") + " --spp 1 --size 8x6 -o " +
                             path("c.exr") + " --layers brightlights --gather ";
  fail("vpl-render", render + "all", kExitUsage, {"--layers", "brightlights"});
  succeed("vpl-render", render + "shirley --stats " + path("c.json"));
  const Image image = readExr(at("c.exr"));
  double sum = 0.0;
  for (const float v : *image.find("brightlights")) sum += double{v};
  EXPECT_GT(sum, 0.0);
  const Json stats = Json::parse(readAll(at("c.json")));
  EXPECT_NEAR(stats.at("mean_brightlights").get<double>(), sum / 48.0, 1e-3);
}

TEST_F(Effect, NeighboursThatNobodyCountsAreRefused) {
  makeStages(scene_);
  const std::string keep = path("candidates.vpl") + " -n 5 -o " + path("v.vpl");
  fail("vpl-eliminate", keep + " --density uniform --area 4 --neighbours 7", kExitUsage,
       {"--neighbours has no effect with --density uniform and --area 4; it needs --density local "
        "or --area 0"});
  succeed("vpl-eliminate", keep + " --density uniform --area 4");
  succeed("vpl-eliminate", keep + " --density uniform --neighbours 7");
  succeed("vpl-eliminate", keep + " --area 4 --neighbours 7");
}

TEST_F(Effect, CheckpointsThatNobodySavesAreRefused) {
  fail("vpl-estimate", scene_ + " v.vpl -o l.vpl --checkpoint-every 5", kExitUsage,
       {"--checkpoint-every", "--checkpoint"});
  fail("vpl-render", scene_ + " v.vpl -o l.exr --checkpoint-every 5", kExitUsage,
       {"--checkpoint-every", "--checkpoint"});
}

TEST_F(Effect, DefinesThatTheSceneDoesNotUseAreRefused) {
  fail("vpl-place", scene_ + " -n 5 -o " + path("c.vpl") + " --define A=1", kExitUsage,
       {"--define A has no effect", "${A}"});
  EXPECT_TRUE(listing().empty());
}

// A script's variable without a value gives an empty text.
TEST_F(Effect, EmptyValuesAreRefusedByName) {
  const std::string render = scene_ + " --integrator path --spp 1 -o " + path("i.exr");
  for (const char* option : {"--size", "--stats", "--png", "--layers", "--exposure", "--depfile",
                             "--checkpoint", "--define", "--threads"}) {
    fail("vpl-render", render + " " + option + " ''", kExitUsage, {option});
  }
  fail("vpl-render", "'' --integrator path -o " + path("i.exr"), kExitUsage, {"scene"});
  EXPECT_TRUE(listing().empty());
}

TEST_F(Effect, NumbersAreWhatTheySay) {
  for (const char* seed : {"-1", "18446744073709551616", "''", "0x10", "1e3", "1.5"}) {
    fail("vpl-place", scene_ + " -n 5 -o " + path("c.vpl") + " --seed " + seed, kExitUsage,
         {"--seed"});
  }
  succeed("vpl-place", scene_ + " -n 5 --seed 010 -o " + path("a.vpl"));
  succeed("vpl-place", scene_ + " -n 5 --seed 10 -o " + path("b.vpl"));
  EXPECT_EQ(readAll(at("a.vpl")), readAll(at("b.vpl")));
  fail("vpl-estimate", scene_ + " v.vpl -o l.vpl --photons 3x", kExitUsage, {"--photons", "3x"});
  for (const char* seconds : {"0x10", "' 5'", "'5 '", "+5", "nan", "-1", "1e7"}) {
    fail("vpl-estimate",
         scene_ + " v.vpl -o l.vpl --checkpoint c --checkpoint-every " + std::string(seconds),
         kExitUsage, {"--checkpoint-every", "from 0 to 1000000"});
  }
  for (const char* stops : {"0x10", "' 5'", "+5"}) {
    fail("vpl-render",
         scene_ + " --integrator path --png x.png -o x.exr --exposure " + std::string(stops),
         kExitUsage, {"--exposure"});
  }
  fail("vpl-place", scene_ + " -o c.vpl --depth -1", kExitUsage,
       {"--depth: '-1' is not a whole number from 2 to 1000"});
  fail("vpl-render", scene_ + " l.vpl -o i.exr --clamp 1e400", kExitUsage,
       {"--clamp: '1e400' is out of range: from 0 to 1000"});
  fail("vpl-render", scene_ + " l.vpl -o i.exr --clamp big", kExitUsage,
       {"--clamp: 'big' is not a number from 0 to 1000"});
}

// Rays of the near field serve specular paths as well, so the option changes image and record.
TEST_F(Effect, TheRecordHoldsEverythingThatCounts) {
  makeStages(scene_);
  const std::string render = scene_ + " " + path("lit.vpl") + " --spp 1 --compensate none -o ";
  succeed("vpl-render", render + path("few.exr") + " --near-field-rays 2");
  const Image few = readExr(at("few.exr"));
  const Json record = lastRecord(few.attributes.at("bnvpl.provenance"));
  EXPECT_EQ(record["options"]["near-field-rays"], 2);
  EXPECT_EQ(record["options"]["compensate"], "none");
  EXPECT_TRUE(record["view"].contains("hash"));

  const Json placed = lastRecord(readVpl(at("candidates.vpl")).provenance);
  EXPECT_EQ(placed["view"]["size"], "64x48");
  // The version ends with a hash of the sources.
  const std::string version = placed["version"];
  EXPECT_TRUE(version.starts_with(BNVPL_VERSION "+")) << version;
  EXPECT_EQ(version.size(), std::string(BNVPL_VERSION "+").size() + 12);
}

// A checkpoint of another build or another view is not continued.
TEST_F(Effect, ACheckpointOfAnotherBuildIsRefused) {
  makeStages(scene_);
  const std::string command = scene_ + " " + path("vpls.vpl") + " -o " + path("again.vpl") +
                              " --photons 1G --irradiance-error 0 --threads 1 --checkpoint " +
                              path("c.checkpoint");
  interrupt("vpl-estimate", command + " --checkpoint-every 0", "c.checkpoint");
  if (HasFatalFailure()) return;
  CheckpointFile file = *findCheckpoint(at("c.checkpoint"));
  Json run = Json::parse(file.run);
  run["version"] = BNVPL_VERSION "+0123456789ab";
  file.run = run.dump();
  writeCheckpoint(at("c.checkpoint"), file);
  fail("vpl-estimate", command, kExitInput, {"c.checkpoint", "another run", "0123456789ab"});
  EXPECT_TRUE(fs::exists(at("c.checkpoint")));
}

TEST_F(Effect, MeansOfWhatIsNotShownAreNotPrinted) {
  makeStages(scene_);
  const std::string render = scene_ + " " + path("lit.vpl") + " --spp 1 -o " + path("i.exr");
  const std::string indirect = tool("vpl-render", render + " --only indirect").out;
  EXPECT_TRUE(contains(indirect, "mean indirect")) << indirect;
  EXPECT_FALSE(contains(indirect, "mean direct")) << indirect;
  const std::string direct = tool("vpl-render", render + " --only direct").out;
  EXPECT_TRUE(contains(direct, "mean direct")) << direct;
  EXPECT_FALSE(contains(direct, "indirect")) << direct;
}

// Only the first stage that reads a scene prints its warnings.
TEST_F(Effect, WarningsOfTheSceneArePrintedOnce) {
  const std::string odd = "scenes/test/quirks.toml";
  const auto warned = [&](const std::string& name, const std::string& arguments) {
    const Outcome r = tool(name, arguments);
    EXPECT_EQ(r.code, kExitOk) << r.err;
    return contains(r.err, "warning: scenes/test");
  };
  EXPECT_TRUE(warned("vpl-place", odd + " -n 300 -o " + path("c.vpl")));
  EXPECT_FALSE(warned("vpl-eliminate", path("c.vpl") + " -n 20 -o " + path("v.vpl")));
  EXPECT_FALSE(
      warned("vpl-estimate", odd + " " + path("v.vpl") + " --photons 20k -o " + path("l.vpl")));
  EXPECT_FALSE(warned("vpl-render",
                      odd + " " + path("l.vpl") + " --spp 1 --size 16x12 -o " + path("i.exr")));
  EXPECT_TRUE(
      warned("vpl-render", odd + " --integrator path --spp 1 --size 16x12 -o " + path("p.exr")));
}

TEST_F(Effect, VplsWithoutPhotonsAreAWarningWithItsCure) {
  const std::string scene = "scenes/u-shape/scene.toml";
  succeed("vpl-place", scene + " -n 4k -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 1k -o " + path("v.vpl"));
  const Outcome few = tool("vpl-estimate", scene + " " + path("v.vpl") + " --photons 200 -o " +
                                               path("l.vpl") + " --quiet");
  EXPECT_EQ(few.code, kExitOk);
  EXPECT_TRUE(contains(few.err, "% of the VPLs got no photon")) << few.err;
  EXPECT_TRUE(contains(few.err, "raise --photons")) << few.err;
}

// A path tracer cannot hit a light without extent through glass.
TEST_F(Effect, PathsThatMissThePointLightBehindGlassSayIt) {
  write("m.obj",
        "mtllib m.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\n"
        "v -1 1 1\nusemtl w\nf 1 4 3 2\nusemtl pane\nf 5 6 7 8\n");
  const std::string light =
      "[[light]]\ntype = \"point\"\nposition = [0, 2, 0]\nintensity = [1, 1, 1]\n";
  write("s.toml",
        "[film]\nwidth = 8\nheight = 8\n[camera]\nposition = [0, 0.5, 3]\nlook_at = [0, 0, 0]\n"
        "vertical_fov_deg = 40\n[[mesh]]\nfile = \"m.obj\"\n" +
            light);
  const auto warnings = [&](const std::string& integrator, const std::string& pane) {
    write("m.mtl", "newmtl w\nKd .5 .5 .5\nnewmtl pane\n" + pane + "\n");
    const Outcome r = tool("vpl-render", path("s.toml") + " --spp 1 --integrator " + integrator +
                                             " -o " + path("i.exr"));
    EXPECT_EQ(r.code, kExitOk) << r.err;
    return r.err;
  };
  const std::string glass = "Ni 1.5\nillum 4";
  EXPECT_TRUE(
      contains(warnings("path", glass), "misses light of the point light through material 'pane'"));
  EXPECT_TRUE(contains(warnings("light", glass),
                       "where the camera sees it over a mirror or through glass"));
  for (const char* pane : {"Kd .5 .5 .5", "Kd 0 0 0\nKs 1 1 1\nillum 3"})
    EXPECT_FALSE(contains(warnings("path", pane), "misses light"));
}

}  // namespace
}  // namespace bnvpl
