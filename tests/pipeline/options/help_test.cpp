// --help, --help-all and --help-json of every tool.
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"

namespace bnvpl {
namespace {

using HelpJson = nlohmann::json;

const std::vector<std::string> kTools{"vpl-place",  "vpl-eliminate", "vpl-estimate",
                                      "vpl-render", "vpl-merge",     "vpl-inspect"};

class Help : public PipelineTest {
 protected:
  HelpJson describedBy(const std::string& name) const {
    return HelpJson::parse(tool(name, "--help-json").out);
  }
};

std::vector<std::string> pageLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Options and arguments that a page shows: names at the margin of two blanks.
std::set<std::string> namesShown(const std::string& page) {
  std::set<std::string> names;
  bool options = false;
  for (const std::string& line : pageLines(page)) {
    if (!line.empty() && line.front() != ' ') options = line != "Examples:" && line != "Commands:";
    std::smatch match;
    if (options && std::regex_search(line, match, std::regex("^  (?:-\\w,)?(--)?([A-Za-z-]+)")))
      names.insert(match.str(2));
  }
  return names;
}

std::set<std::string> namesIn(const HelpJson& command) {
  std::set<std::string> names;
  for (const char* list : {"arguments", "options"}) {
    for (const HelpJson& o : command.at(list)) names.insert(o.at("name").get<std::string>());
  }
  return names;
}

TEST_F(Help, JsonHasTheOptionsOfHelpAll) {
  for (const std::string& name : kTools) {
    const HelpJson all = describedBy(name);
    std::set<std::string> expected = namesIn(all);
    for (const HelpJson& command : all.value("commands", HelpJson::array())) {
      const std::string sub = command.at("tool").get<std::string>().substr(name.size() + 1);
      EXPECT_EQ(namesShown(tool(name, sub + " --help-all").out), namesIn(command)) << sub;
      expected.merge(namesIn(command));
    }
    EXPECT_EQ(namesShown(tool(name, "--help-all").out), expected) << name;
    EXPECT_TRUE(expected.count("strict") && expected.count("help-json")) << name;
  }
}

TEST_F(Help, JsonTellsKindDefaultRangeAndNeeds) {
  const HelpJson render = describedBy("vpl-render");
  const auto option = [&](const std::string& name) {
    for (const HelpJson& o : render.at("options")) {
      if (o.at("name") == name) return o;
    }
    return HelpJson();
  };
  EXPECT_EQ(render.at("version"), BNVPL_VERSION);
  EXPECT_EQ(render.at("arguments").at(0).at("kind"), "file");
  EXPECT_TRUE(render.at("arguments").at(0).at("required"));
  EXPECT_FALSE(render.at("arguments").at(1).at("required"));
  EXPECT_EQ(option("output").at("letter"), "-o");
  EXPECT_EQ(option("spp").at("kind"), "count");
  EXPECT_EQ(option("spp").at("default"), "16");
  EXPECT_EQ(option("spp").at("min"), 1);
  EXPECT_EQ(option("spp").at("max"), 4294967295.0);
  EXPECT_EQ(option("clamp").at("unit"), "radii of the VPL");
  EXPECT_EQ(option("clamp").at("needs"), "--only all or indirect");
  for (const HelpJson& slot : render.at("slots"))
    EXPECT_EQ(option(slot.at("name")).at("choices").size(), slot.at("methods").size());
  EXPECT_EQ(option("only").at("choices"), HelpJson({"all", "direct", "indirect"}));
  EXPECT_EQ(option("allocate").at("choices"), HelpJson({"on", "off"}));
  EXPECT_EQ(
      option("error").at("methods").at("gather"),
      HelpJson({"illumination-cut", "lightcuts", "multidimensional", "paquette", "tilecuts"}));
  EXPECT_EQ(option("quiet").at("kind"), "flag");
  EXPECT_EQ(option("json").at("needs"), "--estimate");
  EXPECT_EQ(option("view").at("excludes"), "--camera");
  EXPECT_TRUE(option("define").at("repeat"));
  EXPECT_EQ(option("threads").at("group"), "Speed and time");
}

TEST_F(Help, MethodsAreListedWithOptionsAndNeeds) {
  for (const char* name : {"vpl-place", "vpl-eliminate", "vpl-estimate", "vpl-render"}) {
    const HelpJson listed = HelpJson::parse(tool(name, "--methods --json").out);
    EXPECT_EQ(listed.at("slots"), describedBy(name).at("slots")) << name;
    const std::string lines = tool(name, "--methods").out;
    for (const HelpJson& slot : listed.at("slots")) {
      for (const HelpJson& method : slot.at("methods")) {
        EXPECT_TRUE(contains(lines, "  " + std::string(method.at("name")) + "  ")) << name;
        EXPECT_TRUE(contains(lines, method.at("summary"))) << name;
      }
    }
  }
  const auto needsOf = [&](const std::string& name, const std::string& method) {
    const HelpJson described = describedBy(name);
    for (const HelpJson& slot : described.at("slots")) {
      for (const HelpJson& m : slot.at("methods"))
        if (m.at("name") == method) return m.at("needs");
    }
    return HelpJson();
  };
  EXPECT_EQ(needsOf("vpl-eliminate", "rejection"), HelpJson({"scene"}));
  EXPECT_EQ(needsOf("vpl-render", "vpl"), HelpJson({"lit"}));
  EXPECT_EQ(needsOf("vpl-render", "path"), HelpJson::array());
}

// OpenVDB takes some 35 ms to load, more than all other libraries together.
TEST_F(Help, StartsWithoutOpenVdbUnlessItEliminates) {
  for (const std::string& name : kTools) {
    const std::string libraries = shell("ldd '" BNVPL_BIN "/" + name + "'").out;
    EXPECT_TRUE(contains(libraries, "libembree")) << name << libraries;
    EXPECT_EQ(contains(libraries, "libopenvdb"), name == "vpl-eliminate") << name;
  }
}

TEST_F(Help, FitsAPageAndHasExamples) {
  for (const std::string& name : kTools) {
    const std::string page = tool(name, "--help").out;
    const std::vector<std::string> lines = pageLines(page);
    EXPECT_LE(lines.size(), 60u) << page;
    for (const std::string& line : pageLines(page + tool(name, "--help-all").out)) {
      EXPECT_TRUE(line.size() <= 80 || line.find("  ", 4) == std::string::npos) << line;
    }
    EXPECT_TRUE(contains(page, "\nExamples:\n")) << name;
    EXPECT_TRUE(contains(page, "--help-all shows every option")) << name;
    EXPECT_EQ(describedBy(name).at("examples").size(), 3u) << name;
  }
  EXPECT_FALSE(contains(tool("vpl-render", "--help").out, "--visibility-tests"));
}

// Only their files are missing.
TEST_F(Help, ExamplesAreValidCommands) {
  for (const std::string& name : kTools) {
    const HelpJson all = describedBy(name);
    std::vector<HelpJson> examples = all.at("examples");
    for (const HelpJson& command : all.value("commands", HelpJson::array()))
      examples.insert(examples.end(), command.at("examples").begin(), command.at("examples").end());
    for (const HelpJson& example : examples) {
      const std::string line = example.at("command");
      ASSERT_TRUE(line.starts_with(name + " ")) << line;
      std::string arguments = line.substr(name.size() + 1);
      arguments = std::regex_replace(arguments, std::regex("scenes/cornell/"), "");
      const Outcome outcome =
          shell("env --chdir=" + path("") + " '" BNVPL_BIN "/" + name + "' " + arguments);
      EXPECT_EQ(outcome.code, kExitInput) << line << outcome.err;
    }
  }
}

}  // namespace
}  // namespace bnvpl
