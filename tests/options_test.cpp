// Options and methods: one table each, from which everything else is derived.
#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/support/pipeline.h"
#include "tools/common/files/escape_text.h"
#include "tools/common/options/option.h"
#include "tools/common/options/stage_cli.h"
#include "tools/common/stage/method.h"

namespace bnvpl::test {
namespace {

constexpr auto kCountOption = letterFor("-n", countOption("count", "", 100, "VPLs", "how many"));
constexpr auto kStage = optionTable(kCountOption, kSeedOption);
constexpr auto kDensityOption = choiceOption("density", "local", "uniform|local", "help");
constexpr auto kA = optionTable(
    kDensityOption,
    neededBy({Condition{"density", "local"}}, realOption("share", "0.2", 0, 1, "", "help")));
constexpr auto kErrorOption = realOption("error", "0.1", 0, 1, "", "of b");
constexpr auto kB = optionTable(kErrorOption);
constexpr auto kC = optionTable(realOption("error", "0.5", 0, 1, "", "of c"));

StageSpec spec() {
  return {"vpl-x",
          kStage,
          {{"method", "a", "help", {{"a", "first", kA}, {"b", "second", kB}, {"c", "third", kC}}},
           {"inner", "d", "help", {{"d", "only", {}}}, {Condition{"method", "b|c"}}}}};
}

std::string refusal(const Given& given) {
  try {
    resolve(spec(), given);
  } catch (const UsageError& e) {
    return e.what();
  }
  return "";
}

TEST(Options, DefaultsAreThoseOfTheMethodInUse) {
  const Values a = resolve(spec(), {{"count", "7"}});
  EXPECT_EQ(a[kCountOption], 7u);
  EXPECT_EQ(a[kMethodSlot], "a");
  EXPECT_EQ(a[OptionKey<double>{"share"}], 0.2);
  EXPECT_EQ(a.find("error"), nullptr);
  EXPECT_EQ(a.find("inner"), nullptr);
  EXPECT_EQ(resolve(spec(), {{"count", "7"}, {"method", "b"}})[kErrorOption], 0.1);
  EXPECT_EQ(resolve(spec(), {{"count", "7"}, {"method", "c"}})[kErrorOption], 0.5);
}

TEST(Options, WithoutEffectAreRefusedWithWhatTheyNeed) {
  EXPECT_EQ(refusal({{"count", "1"}, {"error", "0.2"}}),
            "--error has no effect with --method a; it needs --method b or c");
  EXPECT_EQ(refusal({{"count", "1"}, {"density", "uniform"}, {"share", "0.5"}}),
            "--share has no effect with --density uniform; it needs --density local");
  EXPECT_EQ(refusal({{"count", "1"}, {"inner", "d"}}),
            "--inner has no effect with --method a; it needs --method b or c");
  EXPECT_EQ(refusal({{"count", "1"}, {"colour", "red"}}), "--colour is not an option of vpl-x");
  EXPECT_EQ(refusal({{"count", "1"}, {"method", "e"}}),
            "--method: 'e' is not a method; use a, b or c");
  EXPECT_EQ(refusal({}), "--count is required");
}

// "-1", 2^64, empty text, octal and hexadecimal digits are refused or read literally.
TEST(Options, WholeNumbersAreWhatIsTyped) {
  const auto seed = [](const std::string& text) {
    return resolve(spec(), {{"count", "1"}, {"seed", text}})[kSeedOption];
  };
  EXPECT_EQ(seed("010"), 10u);
  EXPECT_EQ(seed("18446744073709551615"), UINT64_MAX);
  EXPECT_EQ(refusal({{"count", "1"}, {"seed", "18446744073709551616"}}),
            "--seed: '18446744073709551616' is out of range: from 0 to 2^64 - 1");
  for (const char* text : {"-1", "", " 1", "1 ", "0x10", "1e3", "+1", "1.0"}) {
    EXPECT_EQ(refusal({{"count", "1"}, {"seed", text}}),
              "--seed: '" + std::string(text) + "' is not a whole number from 0 to 2^64 - 1");
  }
}

TEST(Options, CountsNameTheirOption) {
  EXPECT_EQ(resolve(spec(), {{"count", "0.1k"}})[kCountOption], 100u);
  EXPECT_EQ(refusal({{"count", "101"}}), "--count: '101' is out of range: from 1 to 100");
  EXPECT_EQ(refusal({{"count", "3x"}}),
            "--count: '3x' has an unknown suffix; write a whole number such as 3000, 3k or 10M");
  EXPECT_EQ(refusal({{"count", "-3"}}), "--count: '-3' is out of range: from 1 to 100");
}

TEST(Options, RealsAreFiniteAndInRange) {
  for (const char* text : {"nan", "inf", "1,5", "", "0.5 ", "1e999"})
    EXPECT_NE(refusal({{"count", "1"}, {"share", text}}), "") << text;
  EXPECT_EQ(refusal({{"count", "1"}, {"share", "1.01"}}),
            "--share: '1.01' is out of range: from 0 to 1");
  EXPECT_EQ(refusal({{"count", "1"}, {"share", "1"}}), "");
  EXPECT_EQ(refusal({{"count", "1"}, {"share", "1e999"}}),
            "--share: '1e999' is out of range: from 0 to 1");
  EXPECT_EQ(refusal({{"count", "1"}, {"share", "0x1"}}),
            "--share: '0x1' is not a number from 0 to 1");
}

TEST(Options, DurationsAreSeconds) {
  constexpr auto kOptions =
      optionTable(optional(durationOption("time", "help")),
                  neededBy({Condition{"time"}}, realOption("k", "1", 0, 9, "", "help")));
  const StageSpec timed{"vpl-z", kOptions, {}};
  const auto seconds = [&](const std::string& text) {
    return resolve(timed, {{"time", text}})[OptionKey<double>{"time"}];
  };
  EXPECT_EQ(seconds("60s"), 60.0);
  EXPECT_EQ(seconds("2m"), 120.0);
  EXPECT_EQ(seconds("1.5h"), 5400.0);
  for (const char* text : {"60", "", "m", "1d", "0s", "-1s", "1 s", "infs", "1s2"}) {
    EXPECT_THROW(seconds(text), UsageError) << text;
  }
  for (const char* text : {"0.0000001s", "1e10s", "0s"}) {
    try {
      seconds(text);
      ADD_FAILURE() << text;
    } catch (const UsageError& e) {
      EXPECT_NE(std::string(e.what()).find("from 0.001s to 1e9s"), std::string::npos) << e.what();
    }
  }
  EXPECT_EQ(seconds("0.001s"), 0.001);
  // The option has no value unless it is given, and neither has an option that needs it.
  EXPECT_EQ(resolve(timed).find("time"), nullptr);
  EXPECT_EQ(resolve(timed).find("k"), nullptr);
  EXPECT_NE(resolve(timed, {{"time", "1s"}}).find("k"), nullptr);
  EXPECT_THROW(resolve(timed, {{"k", "2"}}), UsageError);
}

TEST(Options, NeedsCombine) {
  constexpr auto kOptions = optionTable(choiceOption("only", "all", "all|direct", "help"),
                                        realOption("area", "0", 0, 9, "", "help"),
                                        neededBy({Condition{"only", "all"}, Condition{"area", "0"}},
                                                 realOption("k", "1", 0, 9, "", "help")));
  const StageSpec both{
      "vpl-y",
      kOptions,
      {{"method", "a", "help", {{"a", "first", {}}, {"b", "second", {}}}},
       {"inner", "d", "help", {{"d", "only", {}}}, {AllOf{{"method", "a"}, {"only", "all"}}}}}};
  const auto refused = [&](const Given& given) -> std::string {
    try {
      resolve(both, given);
    } catch (const UsageError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refused({{"k", "2"}, {"only", "direct"}}), "");
  EXPECT_EQ(refused({{"k", "2"}, {"area", "0.5"}}), "");
  EXPECT_EQ(refused({{"k", "2"}, {"only", "direct"}, {"area", "-0"}}), "");
  EXPECT_EQ(refused({{"k", "2"}, {"only", "direct"}, {"area", "0.5"}}),
            "--k has no effect with --only direct and --area 0.5; it needs --only all or --area 0");
  EXPECT_EQ(refused({{"inner", "d"}}), "");
  EXPECT_EQ(refused({{"inner", "d"}, {"only", "direct"}}),
            "--inner has no effect with --only direct; it needs --only all");
  EXPECT_EQ(refused({{"inner", "d"}, {"method", "b"}}),
            "--inner has no effect with --method b; it needs --method a");
  EXPECT_EQ(needText({Condition{"only", "all"}, Condition{"area", "0"}}), "--only all or --area 0");
  EXPECT_EQ(needText({AllOf{{"method", "a|b"}, {"only", "all"}}}),
            "--method a or b and --only all");
}

TEST(Options, TheRecordHoldsAllThatHasAnEffect) {
  const Json record = recordOf(spec(), resolve(spec(), {{"count", "5"}, {"density", "uniform"}}));
  EXPECT_EQ(record.dump(), R"({"method":"a","count":5,"seed":1,"density":"uniform"})");
}

TEST(Options, EveryStageIsSound) {
  for (const StageSpec* stage : {&placeSpec(), &eliminateSpec(), &estimateSpec(), &renderSpec()}) {
    EXPECT_NO_THROW(requireSound(*stage)) << stage->tool;
    for (const MethodSlot& slot : stage->slots) {
      for (const MethodEntry& m : slot.methods) EXPECT_FALSE(m.summary.empty()) << m.name;
    }
  }
  StageSpec twice = spec();
  twice.slots[0].methods[0].options = kStage;
  EXPECT_THROW(requireSound(twice), std::logic_error);
}

TEST(EscapedText, KeepsWhatIsReadAndSpellsOutWhatActs) {
  const std::pair<const char*, const char*> texts[] = {
      {"plain \xc3\xa4\xe6\xb0\xb4\xf0\x9f\x92\xa1", "plain \xc3\xa4\xe6\xb0\xb4\xf0\x9f\x92\xa1"},
      {"\x1b]0;title\a\x1b[31m", "\\x1b]0;title\\x07\\x1b[31m"},
      {"\x7f\r", "\\u007f\\x0d"},
      {"\xc2\x9b", "\\u009b"},      // C1 control: CSI in one character
      {"\xe2\x80\xae", "\\u202e"},  // right-to-left override
      {"\xef\xbb\xbf", "\\ufeff"},
      {"\x9b\xff", "\\x9b\\xff"},           // not UTF-8
      {"\xc0\xaf", "\\xc0\\xaf"},           // overlong
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},  // surrogate
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},
      {"\xe2\x80", "\\xe2\\x80"},  // cut short
      {"", ""}};
  for (const auto& [text, safe] : texts) {
    EXPECT_EQ(escapedLine(text), safe);
    EXPECT_EQ(escapedText(text), safe);
  }
  EXPECT_EQ(escapedText("a\n\tb"), "a\n\tb");
  EXPECT_EQ(escapedLine("a\n\tb"), "a\\n\\tb");
}

}  // namespace
}  // namespace bnvpl::test
