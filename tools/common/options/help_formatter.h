// Lays out --help and --help-all, and keeps what they say of each option.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "tools/common/options/help_entry.h"

namespace bnvpl {

// One object serves a command line and all its sub-commands.
class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* cli, std::string name,
                        CLI::AppFormatMode mode) const override;

  HelpEntry entryFor(const CLI::Option& option) const;
  // The option's heading: that of CLI11, where a tool has set it.
  static std::string groupOf(const CLI::Option& option);
  std::vector<Example> examplesOf(const CLI::App& cli) const;

  std::map<const CLI::Option*, HelpEntry> entries;
  std::map<const CLI::App*, std::vector<Example>> examples;
  const StageSpec* spec = nullptr;

 private:
  struct Page {
    std::string text;
    size_t width;  // columns
    bool all;      // --help-all
  };
  void addUsage(const CLI::App& cli, const std::string& name, Page& page) const;
  void addGroup(const std::string& heading, const std::vector<const CLI::Option*>& options,
                Page& page) const;
  void addOptions(const CLI::App& cli, Page& page) const;
  void addCommands(const CLI::App& cli, const std::string& name, Page& page) const;
  void addEnd(const CLI::App& cli, const std::string& name, Page& page) const;
};

}  // namespace bnvpl
