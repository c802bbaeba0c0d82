// Options of every tool, and the values that they refuse.
#include <nlohmann/json.hpp>

#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

// The text with each run of blanks and line breaks as one blank.
std::string unwrapped(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n';
    if (!blank || line.empty() || line.back() != ' ') line += blank ? ' ' : c;
  }
  return line;
}

class Options : public PipelineTest {
 protected:
  // Names of the methods and options of a stage, which --help must mention.
  std::vector<std::string> toldByJson(const std::string& name) const {
    const auto spec = nlohmann::json::parse(tool(name, "--help-json").out);
    std::vector<std::string> texts;
    const auto add = [&](const nlohmann::json& options) {
      for (const auto& option : options)
        texts.push_back("--" + option.at("name").get<std::string>());
    };
    add(spec.at("options"));
    for (const auto& slot : spec.at("slots")) {
      std::string names;
      for (const auto& method : slot.at("methods")) {
        names += (names.empty() ? "" : "|") + method.at("name").get<std::string>();
        texts.push_back(method.at("summary"));
        add(method.at("options"));
      }
      texts.push_back("--" + slot.at("name").get<std::string>() + " " + names);
    }
    return texts;
  }
};

TEST_F(Options, HelpListsEveryOption) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> own{
      {"vpl-place", {"scene", "--output", "--define", "--depfile", "--shard I/N", "--shard-spare"}},
      {"vpl-eliminate", {"candidates", "--output", "--scene", "--define", "--depfile"}},
      {"vpl-estimate",
       {"scene", "vpls", "--output", "--define", "--depfile", "--checkpoint-every"}},
      {"vpl-render",
       {"scene", "lit", "--output", "--png", "--define", "--depfile", "--checkpoint-every"}},
      {"vpl-merge", {"shards", "--output", "--png", "--exposure", "--depfile"}},
      {"vpl-inspect", {"info", "check", "export", "plot", "compare"}}};
  for (auto [name, texts] : own) {
    Outcome help = tool(name, "--help-all");
    EXPECT_EQ(help.code, kExitOk) << name;
    EXPECT_EQ(help.err, "") << name;
    help.out = unwrapped(help.out);
    if (name != "vpl-inspect" && name != "vpl-merge") {
      for (const std::string& text : toldByJson(name)) texts.push_back(text);
    }
    for (const std::string& text : texts)
      EXPECT_TRUE(contains(help.out, text)) << name << " lacks " << text;
    for (const char* text : {"--threads", "--quiet", "--stats", "--version", "--help"}) {
      EXPECT_TRUE(contains(help.out, text)) << name << " lacks " << text;
    }
  }
}

// Each kind of value has one notation, and ranges are plain numbers.
TEST_F(Options, HelpIsPlain) {
  std::string all;
  all += tool("vpl-inspect", "--help-all").out;
  for (const std::string& name : kStages) all += tool(name, "--help-all").out;
  all = unwrapped(all);
  for (const char* odd : {"FLOAT", "UINT", "TEXT", "REQUIRED", "e+", "000000 ", " in ["})
    EXPECT_FALSE(contains(all, odd)) << odd;
  for (const char* text :
       {"--checkpoint-every NUMBER=60", "(0 to 1000000)", "--photons COUNT=10M", "(1 to 2^36)",
        "--dot NUMBER=5", "scene FILE (required)", "--layers NAME,...", "--size WIDTHxHEIGHT",
        "cutsize: clusters or VPLs gathered", "with --only all or indirect"}) {
    EXPECT_TRUE(contains(all, text)) << text;
  }
}

TEST_F(Options, HelpOfWhatDoesNotExistFails) {
  fail("vpl-inspect", "chain --help", kExitUsage, {"chain"});
  fail("vpl-inspect", "chain", kExitUsage);
  EXPECT_EQ(tool("vpl-place", scene_ + " --help").code, kExitOk);
}

TEST_F(Options, HelpShowsDefaults) {
  EXPECT_TRUE(contains(tool("vpl-place", "--help").out, "--count COUNT=120k"));
  EXPECT_TRUE(contains(tool("vpl-estimate", "--help").out, "--photons COUNT=10M"));
  EXPECT_TRUE(contains(tool("vpl-render", "--help-all").out, "default 0.02"));
  EXPECT_TRUE(contains(tool("vpl-render", "--help-all").out, "default 1000"));
}

TEST_F(Options, Version) {
  for (const std::string name :
       {"vpl-place", "vpl-eliminate", "vpl-estimate", "vpl-render", "vpl-merge", "vpl-inspect"}) {
    const Outcome r = tool(name, "--version");
    EXPECT_EQ(r.code, kExitOk);
    EXPECT_TRUE(r.out.starts_with(name + " " BNVPL_VERSION "+")) << r.out;
    EXPECT_TRUE(r.out.ends_with(" (Embree " BNVPL_EMBREE ")\n")) << r.out;
  }
}

TEST_F(Options, UnknownAndMissingOptions) {
  for (const std::string& name : kStages) {
    fail(name, "--no-such-option", kExitUsage, {"--help"});
    fail(name, "", kExitUsage, {" is required"});
    fail(name, "a b c d e -o x", kExitUsage);
    fail(name, "-o", kExitUsage);
  }
  fail("vpl-inspect", "", kExitUsage);
  fail("vpl-merge", "", kExitUsage, {" is required"});
  fail("vpl-place", scene_, kExitUsage, {"-o"});
  fail("vpl-eliminate", "a.vpl -o b.vpl", kExitUsage, {"--count"});
}

// Messages of the option library are replaced by messages for people.
TEST_F(Options, MistakesAreReportedInSentences) {
  const std::string out = " -o " + path("x.vpl");
  fail("vpl-place", scene_ + out + " -n 1 -n 2", kExitUsage, {"--count is given more than once"});
  fail("vpl-place", scene_ + " one two" + out, kExitUsage, {"'one', 'two' have no meaning here"});
  fail("vpl-place", scene_ + out + " --thread 3", kExitUsage,
       {"'--thread' is no option here; did you mean --threads?"});
  fail("vpl-place", scene_ + out + " --gather all", kExitUsage,
       {"'--gather', 'all' have no meaning here; check how the option is written"});
  fail("vpl-estimate", scene_ + " a.vpl --photns=5" + out, kExitUsage,
       {"'--photns' is no option here; did you mean --photons?"});
  fail("vpl-eliminate", "a.vpl --cuont 3" + out, kExitUsage,
       {"'--cuont' is no option here; did you mean --count?"});
  fail("vpl-render", "--hlep", kExitUsage, {"'--hlep' is no option here; did you mean --help?"});
  fail("vpl-inspect", "--hlep", kExitUsage, {"'--hlep' is no option here; did you mean --help?"});
  fail("vpl-inspect", "compare a.exr b.exr --max-relms 1", kExitUsage,
       {"did you mean --max-relmse? See vpl-inspect compare --help"});
  fail("vpl-render", scene_ + " a.vpl -o " + path("x.exr") + " --gather tilecut", kExitUsage,
       {"--gather: 'tilecut' is not a method; did you mean tilecuts? Use adaptive-tree, all, "});
  fail("vpl-render", scene_ + " a.vpl -o " + path("x.exr") + " --only direkt", kExitUsage,
       {"--only: 'direkt' is not one of its choices; did you mean direct?"});
  // Removed options name their replacement.
  fail("vpl-render", scene_ + " " + path("lit.vpl") + " --specks keep" + out, kExitUsage,
       {"--specks is --fireflies redistribute or keep today"});
  fail("vpl-place", scene_ + " -o", kExitUsage, {"--output needs a value: FILE"});
  fail("vpl-place", scene_ + out + " --camera 1 --view " + scene_, kExitUsage,
       {"--camera and --view cannot be given together"});
  fail("vpl-eliminate", "a.vpl -n 5 --define A=b" + out, kExitUsage,
       {"--define has an effect only with --scene"});
  fail("vpl-inspect", "", kExitUsage, {"a command is missing; use one of info, check, "});
  fail("vpl-inspect", "inform a.vpl", kExitUsage,
       {"'inform' is no command; did you mean info? Use one of info, "});
  fail("vpl-inspect", "compare a.exr b.exr --map flup --diff d.png", kExitUsage,
       {"--map: 'flup' is none of difference|flip|",
        "did you mean flip? See vpl-inspect compare --help"});
}

// VPLs are lit for any view. With --only direct nothing indirect is computed.
TEST_F(Options, WhatWouldHaveNoEffectIsRefused) {
  fail("vpl-estimate", scene_ + " a.vpl -o x.vpl --view " + scene_, kExitUsage, {"'--view'"});
  fail("vpl-estimate", scene_ + " a.vpl -o x.vpl --camera 1", kExitUsage, {"'--camera'"});
  for (const auto& [only, layer] : {std::pair{"direct", "indirect"}, {"indirect", "direct"}}) {
    fail("vpl-render", scene_ + " a.vpl -o x.exr --only " + only + " --layers N," + layer,
         kExitUsage, {layer, std::string("--only ") + only});
  }
  fail("vpl-eliminate", "a.vpl -o b.vpl -n 5 --area 1e39", kExitUsage, {"--area", "1e19"});
}

TEST_F(Options, VplsLargerThanTheSceneAreRefused) {
  const std::string vpls = path("vpls.vpl");
  succeed("vpl-place", scene_ + " -n 300 -o " + path("c.vpl"));
  succeed("vpl-eliminate", path("c.vpl") + " -n 30 --density uniform --area 1e10 -o " + vpls);
  const std::vector<std::string> told{"vpls.vpl: row 0: radius", "beyond the scene's size",
                                      "keep more with vpl-eliminate -n", "--area"};
  fail("vpl-estimate", scene_ + " " + vpls + " -o " + path("lit.vpl"), kExitInput, told);
  fail("vpl-inspect", "check " + vpls + " --scene " + scene_, kExitInput, told);
}

TEST_F(Options, UnknownChoices) {
  fail("vpl-place", scene_ + " -o x --method sideways", kExitUsage, {"--method", "sideways"});
  for (const char* option : {"--method", "--density"}) {
    fail("vpl-eliminate", std::string("a -o x -n 1 ") + option + " odd", kExitUsage,
         {option, "odd"});
  }
  fail("vpl-estimate", scene_ + " a -o x --method wild", kExitUsage, {"--method", "wild"});
  for (const char* option : {"--integrator", "--gather", "--only", "--pixels"}) {
    fail("vpl-render", scene_ + " a -o x " + option + " odd", kExitUsage, {option, "odd"});
  }
  fail("vpl-render", scene_ + " a -o x --layers direct,odd", kExitUsage, {"--layers", "odd"});
  fail("vpl-render",
       scene_ + " -o " + path("x.exr") + " --integrator path --spp 1 --png " + path("x.png") +
           " --exposure bright",
       kExitUsage, {"--exposure", "bright"});
  EXPECT_TRUE(listing().empty());
}

// An option without its value takes the next option for it.
TEST_F(Options, OptionsAreNoValues) {
  const std::string place = scene_ + " -n 9 ", c = path("c.vpl");
  const auto refused = [&](const std::string& name, const std::string& arguments,
                           const std::string& option, const std::string& value) {
    fail(name, arguments, kExitUsage,
         {option + " has no value", "'" + value + "' behind it is an option", "./" + value});
  };
  refused("vpl-place", place + "-o --quiet", "-o", "--quiet");
  refused("vpl-place", place + "--output -n", "--output", "-n");
  refused("vpl-place", place + "-o --seed=3", "-o", "--seed=3");
  refused("vpl-place", place + "-o --help", "-o", "--help");
  refused("vpl-place", place + "-o " + c + " --stats --quiet", "--stats", "--quiet");
  refused("vpl-place", scene_ + " -o " + c + " -n --checkpoint --checkpoint-replace", "-n",
          "--checkpoint");
  refused("vpl-place", place + "-o " + c + " --checkpoint --checkpoint-replace", "--checkpoint",
          "--checkpoint-replace");
  refused("vpl-place", place + "-o " + c + " --define --quiet", "--define", "--quiet");
  refused("vpl-render", scene_ + " a.vpl -o x.exr --png --spp 4", "--png", "--spp");
  refused("vpl-inspect", "export a.vpl -o --stats", "-o", "--stats");
  refused("vpl-inspect", "--stats --quiet info a.vpl", "--stats", "--quiet");
  EXPECT_TRUE(listing().empty());
  succeed("vpl-place", place + "--quiet -o " + c + " --stats=" + path("--quiet"));
  const Outcome meant = shell("sh -c 'cd \"" + at("").string() +
                              "\" && \"" BNVPL_BIN "/vpl-place\" \"" BNVPL_SOURCE
                              "/scenes/test/one-bounce.toml\" -n 9 --quiet -o ./--seed'");
  EXPECT_EQ(meant.code, kExitOk) << meant.err;
  EXPECT_EQ(listing(), (std::vector<std::string>{"--quiet", "--seed", "c.vpl"}));
}

// A script's unset variable gives an empty file name, which is refused before any work.
TEST_F(Options, EmptyFileNames) {
  const std::pair<const char*, std::string> lines[] = {
      {"vpl-place", "'' -o x"},
      {"vpl-place", scene_ + " -o ''"},
      {"vpl-place", scene_ + " -o x --stats ''"},
      {"vpl-place", scene_ + " -o x --depfile ''"},
      {"vpl-eliminate", "'' -n 1 -o x"},
      {"vpl-eliminate", "a -n 1 -o ''"},
      {"vpl-eliminate", "a -n 1 -o x --scene ''"},
      {"vpl-estimate", scene_ + " '' -o x"},
      {"vpl-estimate", scene_ + " a -o ''"},
      {"vpl-estimate", scene_ + " a -o x --checkpoint ''"},
      {"vpl-render", scene_ + " '' -o x"},
      {"vpl-render", scene_ + " a -o ''"},
      {"vpl-render", scene_ + " a -o x --png ''"},
      {"vpl-inspect", "info ''"},
      {"vpl-inspect", "check a ''"},
      {"vpl-inspect", "export a -o ''"},
      {"vpl-inspect", "plot a --scene s -o ''"},
      {"vpl-inspect", "compare a b --diff ''"},
      {"vpl-inspect", "compare a b --mask ''"}};
  for (const auto& [name, arguments] : lines) fail(name, arguments, kExitUsage, {"'' is empty"});
  fail("vpl-place", scene_ + " -o ''", kExitUsage, {"--output"});
  EXPECT_TRUE(listing().empty());
}

TEST_F(Options, BadCounts) {
  const std::pair<const char*, std::string> counts[] = {
      {"vpl-place", scene_ + " -o x -n "},
      {"vpl-eliminate", "a -o x -n "},
      {"vpl-estimate", scene_ + " a -o x --photons "},
      {"vpl-render", scene_ + " a -o x --spp "},
      {"vpl-render", scene_ + " a -o x --max-cut "}};
  for (const auto& [name, arguments] : counts) {
    for (const char* bad :
         {"3x", "-1", "1.5", "0", "''", "k", "1kk", "nan", "inf", "1e99", "'1 0'"}) {
      fail(name, arguments + bad, kExitUsage);
    }
  }
  fail("vpl-place", scene_ + " -o x -n 1.0005k", kExitUsage, {"not whole"});
}

TEST_F(Options, GoodCounts) {
  for (const auto& [text, count] : {std::pair{"12", "12"}, std::pair{"0.1k", "100"},
                                    std::pair{"1K", "1000"}, std::pair{"2.01k", "2010"}}) {
    const Outcome r = tool("vpl-place", scene_ + " -o " + path("c.vpl") + " -n " + text);
    EXPECT_EQ(r.code, kExitOk) << r.err;
    EXPECT_TRUE(contains(r.out, std::string("placed ") + count + " ")) << r.out;
  }
}

TEST_F(Options, NumbersOutOfRange) {
  fail("vpl-place", scene_ + " -o x --depth 1", kExitUsage, {"--depth"});
  fail("vpl-place", scene_ + " -o x --threads -1", kExitUsage, {"--threads"});
  fail("vpl-place", scene_ + " -o x --seed soon", kExitUsage, {"--seed"});
  fail("vpl-eliminate", "a -o x -n 1 --area -3", kExitUsage, {"--area"});
  fail("vpl-estimate", scene_ + " a -o x --radius 0", kExitUsage, {"--radius"});
  fail("vpl-estimate", scene_ + " a -o x --radius nan", kExitUsage, {"--radius"});
  fail("vpl-estimate", scene_ + " a -o x --max-bounces 0", kExitUsage, {"--max-bounces"});
  fail("vpl-render", scene_ + " a -o x --error 2", kExitUsage, {"--error"});
  fail("vpl-render", scene_ + " a -o x --clamp -1", kExitUsage, {"--clamp"});
  fail("vpl-render", scene_ + " a -o x --near-field-rays 0", kExitUsage, {"--near-field-rays"});
}

TEST_F(Options, VplsAndReferencesExcludeEachOther) {
  fail("vpl-render", scene_ + " -o x", kExitUsage, {"vpl-estimate"});
  fail("vpl-render", scene_ + " a.vpl -o x --integrator path", kExitUsage, {"a.vpl"});
  fail("vpl-render", scene_ + " a.vpl -o x --integrator light", kExitUsage, {"light", "a.vpl"});
}

// A script gives every stage the same seed; a method without random numbers ignores it.
TEST_F(Options, ASeedThatNothingDrawsByIsAccepted) {
  makeStages(scene_);
  const std::string keep = path("candidates.vpl") + " -n 60 -o ";
  succeed("vpl-eliminate", keep + path("seeded.vpl") + " --seed 7");
  EXPECT_EQ(readAll(at("seeded.vpl")), readAll(at("vpls.vpl")));
  fail("vpl-eliminate", keep + "x --seed soon", kExitUsage, {"--seed", "soon"});
  fail("vpl-eliminate", keep + "x --method random --alpha 4", kExitUsage, {"--alpha", "no effect"});
}

TEST_F(Options, ListsTakeOneWord) {
  makeStages(scene_);
  succeed("vpl-render",
          "--layers direct,Z " + scene_ + " " + path("lit.vpl") + " --spp 1 -o " + path("i.exr"));
}

// --define takes one word and leaves the scene's name alone wherever it stands.
TEST_F(Options, DefinesMayStandAnywhere) {
  fs::copy(BNVPL_SOURCE "/scenes/test", at("far"), fs::copy_options::recursive);
  std::string toml = readAll(at("far/one-bounce.toml"));
  const size_t where = toml.find("\"one-bounce.obj\"");
  ASSERT_NE(where, std::string::npos);
  write("near.toml", toml.replace(where, 16, "\"${DIR}/one-bounce.obj\""));
  const std::string define = "--define DIR=far ", end = " -o " + path("c.vpl") + " -n 10 ";
  succeed("vpl-place", path("near.toml") + end + define);
  succeed("vpl-place", define + path("near.toml") + end);
  for (const char* twice : {"--define DIR=nowhere ", "--define DIR=far "}) {
    fail("vpl-place", twice + define + path("near.toml") + end, kExitUsage,
         {"--define DIR is given more than once"});
  }
  fail("vpl-place", path("near.toml") + end, kExitInput,
       {"near.toml:", "${DIR} is not set", "--define DIR="});
  fail("vpl-place", path("near.toml") + end + "--define DIR", kExitUsage, {"NAME=VALUE"});
}

}  // namespace
}  // namespace bnvpl
