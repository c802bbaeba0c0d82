#include "tools/common/options/help_formatter.h"

#include <algorithm>

#include "tools/common/files/standard_streams.h"
#include "tools/common/options/help.h"

namespace bnvpl {
namespace {

constexpr size_t kMinWidth = 40, kMaxWidth = 120;  // longer lines are hard to read
constexpr size_t kNameColumns = 26;

// Appends paragraphs whose lines begin at column `from`. A paragraph keeps its own indentation.
void addParagraphs(const std::string& text, size_t from, size_t width, std::string& page) {
  size_t begin = 0;
  for (bool first = true; begin <= text.size(); first = false) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const size_t own = std::min(line.find_first_not_of(' '), line.size());
    for (const std::string& part :
         wrapped(line.substr(own), width - from - own, own > 0 || !first ? 2 : 0)) {
      page += (page.empty() || page.back() == '\n' ? std::string(from, ' ') : "") +
              std::string(own, ' ') + part + "\n";
    }
    begin = end + 1;
  }
}

std::string nameAndType(const CLI::Option& o, const std::string& defaultText, bool all) {
  std::string text = o.get_positional() ? o.get_name(true) : o.get_name(false, true);
  if (o.get_items_expected_max() > 0) {
    text += " " + o.get_type_name();
    if (!defaultText.empty()) text += "=" + defaultText;
  }
  if (o.get_items_expected_max() > 1) text += " ...";
  // Otherwise the usage tells.
  return text + (all && o.get_required() ? " (required)" : "");
}

// What CLI11 checks of other options.
std::string relationsOf(const CLI::Option& o) {
  std::string text;
  const auto add = [&](const char* how, const std::set<CLI::Option*>& others) {
    std::set<std::string> names;
    for (const CLI::Option* other : others) {
      if (!other->get_positional()) names.insert(other->get_lnames().front());
    }
    for (const std::string& name : names)
      text += (text.empty() ? "" : ", ") + std::string(how) + "--" + name;
  };
  add("with ", o.get_needs());
  add("not with ", o.get_excludes());
  return text.empty() ? "" : " (" + text + ")";
}

std::string usageOf(const CLI::Option& o) {
  if (!o.get_positional()) {
    const std::string name =
        o.get_snames().empty() ? "--" + o.get_lnames().front() : "-" + o.get_snames().front();
    return name + " " + o.get_type_name();
  }
  const std::string text = o.get_name(true) + (o.get_items_expected_max() > 1 ? "..." : "");
  return o.get_required() ? text : "[" + text + "]";
}

bool isExpert(const std::string& group) {
  return group == headingOf(Topic::Expert) || group.starts_with("With --");
}

}  // namespace

std::vector<std::string> wrapped(const std::string& text, size_t width, size_t indent) {
  std::vector<std::string> lines;
  std::string line;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const bool empty = line.find_first_not_of(' ') == std::string::npos;
    if (!empty && line.size() + 1 + word.size() > width) {
      lines.push_back(line);
      line = std::string(indent, ' ') + word;
    } else {
      line += (empty ? "" : " ") + word;
    }
    begin = end + 1;
  }
  lines.push_back(line);
  return lines;
}

HelpEntry HelpFormatter::entryFor(const CLI::Option& option) const {
  const auto found = entries.find(&option);
  if (found != entries.end()) return found->second;
  const std::string kind = option.get_items_expected_max() == 0 ? "flag"
                           : option.get_type_name() == "FILE"   ? "file"
                                                                : "text";
  return entryOf(kind, option.get_description());
}

std::string HelpFormatter::groupOf(const CLI::Option& option) {
  const bool unset = option.get_positional() || option.get_group() == "Options";
  return unset ? std::string(headingOf(Topic::Main)) : option.get_group();
}

std::vector<Example> HelpFormatter::examplesOf(const CLI::App& cli) const {
  const auto found = examples.find(&cli);
  return found == examples.end() ? std::vector<Example>() : found->second;
}

void HelpFormatter::addUsage(const CLI::App& cli, const std::string& name, Page& page) const {
  addParagraphs(cli.get_description(), 0, page.width, page.text);
  std::string usage = "Usage: " + name;
  if (!cli.get_subcommands([](const CLI::App*) { return true; }).empty()) usage += " COMMAND";
  for (const bool positional : {true, false}) {
    for (const CLI::Option* o : cli.get_options()) {
      if (o->get_positional() == positional && (positional || o->get_required()))
        usage += " " + usageOf(*o);
    }
  }
  page.text += "\n";
  addParagraphs(usage + " [OPTION ...]", 0, page.width, page.text);
}

void HelpFormatter::addGroup(const std::string& heading,
                             const std::vector<const CLI::Option*>& options, Page& page) const {
  if (options.empty()) return;
  page.text += "\n" + heading + ":\n";
  for (const CLI::Option* o : options) {
    const HelpEntry entry = entryFor(*o);
    const bool brief = !page.all && !entry.briefDefault.empty();
    const std::string name =
        "  " + nameAndType(*o, brief ? entry.briefDefault : o->get_default_str(), page.all);
    page.text += name;
    if (name.size() + 2 > kNameColumns)
      page.text += "\n";
    else
      page.text += std::string(kNameColumns - name.size(), ' ');
    addParagraphs(page.all ? entry.full + relationsOf(*o) : entry.brief, kNameColumns, page.width,
                  page.text);
  }
}

void HelpFormatter::addOptions(const CLI::App& cli, Page& page) const {
  const bool command = cli.get_parent() != nullptr;  // few options, under one heading
  std::vector<std::string> headings;
  for (const Topic t : {Topic::Main, Topic::Quality, Topic::Speed, Topic::Files, Topic::Expert})
    headings.emplace_back(headingOf(t));
  for (const CLI::Option* o : cli.get_options()) {
    const std::string group = groupOf(*o);
    if (std::ranges::find(headings, group) == headings.end()) headings.push_back(group);
  }
  const auto headingFor = [&](const CLI::Option& o) {
    return command ? headings.front() : groupOf(o);
  };
  for (const std::string& heading : headings) {
    if (!page.all && !command && isExpert(heading)) continue;
    std::vector<const CLI::Option*> options;
    for (const bool positional : {true, false}) {
      for (const CLI::Option* o : cli.get_options()) {
        if (o->get_positional() == positional && headingFor(*o) == heading) options.push_back(o);
      }
    }
    addGroup(command ? "Options" : heading, options, page);
  }
}

void HelpFormatter::addCommands(const CLI::App& cli, const std::string& name, Page& page) const {
  const auto commands = cli.get_subcommands([](const CLI::App*) { return true; });
  if (commands.empty()) return;
  page.text += "\nCommands:\n";
  for (const CLI::App* sub : commands) {
    const std::string summary = sub->get_description();
    std::string title = "  " + sub->get_name();
    title.resize(std::max(kNameColumns / 2, title.size() + 1), ' ');
    page.text += title;
    addParagraphs(summary.substr(0, summary.find('\n')), title.size(), page.width, page.text);
  }
  if (!page.all) return;
  for (const CLI::App* sub : commands) {
    page.text += "\n" + name + " " + sub->get_name() + ":\n";
    addUsage(*sub, name + " " + sub->get_name(), page);
    addOptions(*sub, page);
  }
}

void HelpFormatter::addEnd(const CLI::App& cli, const std::string& name, Page& page) const {
  const std::vector<Example> list = examplesOf(cli);
  if (!list.empty()) page.text += "\nExamples:\n";
  for (const Example& e : list) {
    addParagraphs(std::string(e.purpose) + ":", 2, page.width, page.text);
    page.text += "    " + std::string(e.command) + "\n";  // in one piece, to be copied
  }
  if (page.all || cli.get_parent() != nullptr) return;
  const std::string command = cli.get_subcommands([](const CLI::App*) { return true; }).empty()
                                  ? ""
                                  : ", a command's by " + name + " COMMAND --help";
  page.text += "\n";
  addParagraphs("--help-all shows every option" + command + ".", 0, page.width, page.text);
}

std::string HelpFormatter::make_help(const CLI::App* cli, std::string name,
                                     CLI::AppFormatMode mode) const {
  Page page{"", std::clamp(outputColumns(), kMinWidth, kMaxWidth),
            mode != CLI::AppFormatMode::Normal};
  addUsage(*cli, name, page);
  addCommands(*cli, name, page);
  addOptions(*cli, page);
  addEnd(*cli, name, page);
  return page.text;
}

}  // namespace bnvpl
