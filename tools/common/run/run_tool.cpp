#include "tools/common/run/run_tool.h"

#include <tbb/global_control.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <sstream>
#include <utility>

#include "core/memory.h"
#include "formats/output_folder.h"
#include "tools/common/files/escape_text.h"
#include "tools/common/files/standard_streams.h"
#include "tools/common/options/cli_errors.h"
#include "tools/common/options/help.h"
#include "tools/common/process/clock.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/process/interrupt.h"
#include "tools/common/process/pin_functions.h"
#include "tools/common/run/build_id.h"
#include "tools/common/run/result_warning.h"

namespace bnvpl {

namespace {

std::string toolName;  // begins each line on stderr
std::vector<std::string> heldWarnings;
bool strict = false;  // --strict
bool resultWarned = false;
char** arguments = nullptr;

void tellWarnings(const std::string& tool, const std::vector<std::string>& warnings) {
  for (const std::string& w : warnings) ErrorLine().add(tool).add(": warning: ").add(w);
}

// Allocates no memory, since there may be none left.
int fail(int code, const char* what, const char* more = "") {
  ErrorLine().add(toolName).add(": ").add(what).add(more);
  return code;
}

int failForMemory() {
  return fail(kExitMemory,
              "out of memory; lower the counts or the film size, or raise the limit on memory");
}

// Prints one line for the exception that is being handled, and returns the exit code.
int report() {
  try {
    throw;
  } catch (const UsageError& e) {
    return fail(kExitUsage, e.what());
  } catch (const InputError& e) {
    std::erase(heldWarnings, e.what());
    tellWarnings(toolName, heldWarnings);
    return fail(kExitInput, e.what());
  } catch (const OutputError& e) {
    return fail(kExitOutput, e.what());
  } catch (const MemoryError& e) {
    return fail(kExitMemory, e.what());
  } catch (const std::bad_alloc&) {
    return failForMemory();
  } catch (const std::length_error&) {  // a container would exceed its max_size()
    return failForMemory();
  } catch (const std::exception& e) {
    if (std::strstr(e.what(), "pthread_create")) {  // oneTBB's message, which Embree passes on
      return fail(kExitMemory,
                  "out of memory for threads; lower --threads, or raise the limits on "
                  "memory and processes");
    }
    return fail(kExitInternal, "internal error: ", e.what());
  } catch (...) {
    return fail(kExitInternal, "internal error");
  }
}

// Handles exceptions that no catch can reach, such as oneTBB's failure to start a thread.
[[noreturn]] void onTerminate() {
  static std::atomic_flag ending;
  while (ending.test_and_set()) ::pause();  // another thread ends the process
  removePartialFiles();
  removePartialFolder();
  if (std::current_exception()) ::_exit(report());
  // When Embree runs out of memory, it throws a second exception while the first unwinds.
  ::_exit(std::uncaught_exceptions() > 0 ? failForMemory() : fail(kExitInternal, "internal error"));
}

// Refuses empty values, which usually come from an unset variable of a script.
void requireTexts(const CLI::App& cli) {
  for (const CLI::Option* option : cli.get_options()) {
    for (const std::string& text : option->results()) {
      if (text.empty()) throw UsageError(option->get_name() + ": '' is empty; give it a value");
    }
  }
  for (const CLI::App* command : cli.get_subcommands()) requireTexts(*command);
}

const CLI::Option* optionNamed(const CLI::App& cli, const std::string& name) {
  return name.size() > 1 && name.front() == '-' ? cli.get_option_no_throw(name) : nullptr;
}

// Refuses an option whose value is missing, so that the option behind it was taken for the value.
// One in the same word, as --png=--quiet, is meant.
void requireOwnValues(const CLI::App& cli, const std::vector<std::string>& words,
                      const CLI::App* above = nullptr) {
  for (size_t i = 1; i < words.size(); ++i) {
    const CLI::Option* option = optionNamed(cli, words[i - 1]);
    const std::string &text = words[i], name = text.substr(0, text.find('='));
    if (!option || std::ranges::find(option->results(), text) == option->results().end()) continue;
    if (!optionNamed(cli, name) && !(above && optionNamed(*above, name))) continue;
    throw UsageError(words[i - 1] + " has no value: '" + text +
                     "' behind it is an option; give it one (a file of that name is ./" + text +
                     ")");
  }
  for (const CLI::App* command : cli.get_subcommands()) requireOwnValues(*command, words, &cli);
}

// Returns false if --help or --version was answered.
bool parse(CLI::App& cli, int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    cli.parse(argc, argv);
    requireOwnValues(cli, words);
    requireTexts(cli);
    return true;
  } catch (const CLI::Success& e) {
    // CLI11 answers --help before it checks for unknown words, such as an unknown subcommand.
    if (cli.remaining_size(true) > 0)
      throw UsageError(describe(CLI::ExtrasError(cli.remaining(true)), cli, toolName));
    std::ostringstream text;
    cli.exit(e, text, text);
    print(text.str());
    return false;
  } catch (const CLI::ParseError& e) {
    requireOwnValues(cli, words);  // what was swallowed may be missing elsewhere
    throw UsageError(describe(e, cli, toolName));
  }
}

CLI::Validator named() {
  return CLI::Validator(
      [](std::string& text) {
        return text.empty() ? std::string("'' is empty; give a file name") : std::string();
      },
      "");
}

}  // namespace

CLI::Option* addFile(CLI::App& cli, const std::string& name, fs::path& file,
                     const std::string& help) {
  return cli.add_option(name, file, help)->type_name("FILE")->check(named());
}
CLI::Option* addFile(CLI::App& cli, const std::string& name, std::vector<fs::path>& files,
                     const std::string& help) {
  return cli.add_option(name, files, help)->type_name("FILE")->check(named());
}

void addToolOptions(CLI::App& cli, ToolOptions& options) {
  addHelpOptions(cli);
  addOption(cli,
            inTopic(Topic::Speed,
                    wholeOption("threads", "0", 0, 65536, "", "worker threads; 0 uses every core")),
            [&options](const Value& value) {
              options.threads = static_cast<unsigned>(std::get<uint64_t>(value));
            });
  inTopic(Topic::Expert, cli.add_flag("--quiet", options.quiet,
                                      "no progress and no summary; errors and warnings stay"));
  inTopic(Topic::Expert, cli.add_flag("--strict", options.strict,
                                      "a warning fails the run: of inputs, before the work"));
  inTopic(Topic::Files, cli.add_flag("--no-clobber", options.noClobber,
                                     "refuse outputs that exist, before the work"));
  addOption(cli,
            choiceOption("progress", "text", "text|json",
                         "text: for people; json: one JSON object a line on stderr, also with "
                         "--quiet"),
            [&options](const Value& value) {
              options.jsonProgress = std::get<std::string>(value) == "json";
            });
  inTopic(Topic::Files,
          addFile(cli, "--stats", options.stats, "also write the summary to this file, as JSON"));
  inTopic(Topic::Expert,
          cli.set_version_flag(
              "--version", cli.get_name() + " " + buildId() + " (Embree " + embreeVersion() + ")",
              "show the version and exit"));
}

void addDepfileOption(CLI::App& cli, ToolOptions& options) {
  inTopic(Topic::Expert,
          addFile(cli, "--depfile", options.depfile,
                  "write the list of files that were read, as a rule for make and ninja"));
}

void addProcessorOption(CLI::App& cli, ToolOptions& options) {
  addOption(cli,
            choiceOption("processor", "this", "this|any",
                         "this: use the fastest code for this processor; any: give the same bytes "
                         "on every processor, which is slower"),
            [&options](const Value& value) {
              const bool any = std::get<std::string>(value) == "any";
              options.processor = any ? Processor::Any : Processor::This;
            });
}

int runTool(CLI::App& cli, const ToolOptions& options, int argc, char** argv,
            const std::function<int()>& work) {
  toolName = cli.get_name();
  arguments = argv;
  occupyClosedStreams();
  catchInterrupts(toolName);
  std::set_terminate(onTerminate);
  try {
    if (!parse(cli, argc, argv)) return kExitOk;
    strict = options.strict;
    computeFor(options.processor);
    // Never destroyed: its destructor would let oneTBB start the threads that were held back, and a
    // failure to do so would end the process, with all outputs already in place.
    alignas(tbb::global_control) static std::byte forever[sizeof(tbb::global_control)];
    new (forever) tbb::global_control(
        tbb::global_control::max_allowed_parallelism,
        options.threads > 0
            ? options.threads
            : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    const int code = work();
    if (code == kExitOk && strict && resultWarned)
      return fail(kExitInput, "a warning is an error with --strict; the outputs are written");
    return code;
  } catch (const Interrupted& e) {
    endInterrupted(e);
  } catch (...) {
    return report();
  }
}

unsigned threadsInUse() {
  return static_cast<unsigned>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}
void computeFor(Processor processor) { pinFunctions(processor, arguments); }
const std::string& runningTool() { return toolName; }

void requireWritable(const std::vector<fs::path>& outputs) {
  for (const fs::path& output : outputs) {
    if (!output.empty()) AtomicFile(output).withdraw();
  }
}

Json stageRecord(const std::string& tool, const Json& options, const Json& inputs,
                 Processor processor) {
  Json record{{"tool", tool},
              {"version", buildId()},
              {"embree", embreeVersion()},
              {"options", options},
              {"inputs", inputs}};
  if (processor == Processor::Any) record["processor"] = "any";
  return record;
}

Processor processorOf(const Json& record) {
  const auto named = record.find("processor");
  return named != record.end() && *named == "any" ? Processor::Any : Processor::This;
}

std::string extendProvenance(const std::string& earlier, const Json& record) {
  Json chain = earlier.empty() ? Json::array() : parseJson(earlier);
  chain.push_back(record);
  return jsonText(chain);
}

Summary::Summary(std::string tool) : tool_(std::move(tool)), startS_(nowS()) {
  values_["tool"] = tool_;
  values_["version"] = buildId();
  values_["embree"] = embreeVersion();
}

void Summary::add(const std::string& key, Json value, const std::string& text) {
  values_[key] = std::move(value);
  if (!text.empty()) lines_.push_back(text);
}

void Summary::addNonFinite(uint64_t count, const std::string& what) {
  add("non_finite_samples", count);
  if (count == 0) return;
  warnOfResult(std::to_string(count) + " " + what +
               " were not finite and count as zero; look for values of absurd size in the scene");
}

Summary::Cost Summary::close(const ToolOptions& options, OutputSet& files) const {
  Json values = values_;
  const Cost cost{nowS() - startS_, static_cast<double>(peakMemory()) / 0x1p20};
  values["time_s"] = cost.timeS;
  values["peak_memory_MiB"] = cost.memoryMiB;
  if (!options.stats.empty()) files.add(options.stats).write(jsonText(values, 2) + "\n");
  files.commit();
  return cost;
}

void Summary::finish(const ToolOptions& options, OutputSet& files,
                     const std::function<void()>& committed) const {
  const Cost cost = close(options, files);
  if (committed) committed();
  if (options.quiet) return;
  std::string text;
  for (const std::string& line : lines_) text += tool_ + ": " + escapedLine(line) + "\n";
  char last[64];
  std::snprintf(last, sizeof last, ": %.2f s, peak memory %.0f MiB\n", cost.timeS, cost.memoryMiB);
  // The outputs are complete: Make must not delete them because a log is full.
  if (!tryPrint(text + tool_ + last)) {
    tellWarnings(tool_, {std::string("the summary cannot be printed: ") + std::strerror(errno)});
  }
}

void printWarnings(const std::string& tool, const std::vector<std::string>& warnings) {
  tellWarnings(tool, warnings);
  if (strict && !warnings.empty())
    throw InputError("a warning is an error with --strict; nothing is written");
}

void warnAsAsked(const std::string& text) { tellWarnings(toolName, {text}); }

void warnOfResult(const std::string& text) {
  resultWarned = true;
  tellWarnings(toolName, {text});
}

void holdWarning(const std::string& text) { heldWarnings.push_back(text); }

void printHeldWarnings() { printWarnings(toolName, std::exchange(heldWarnings, {})); }

std::string formatSi(double value) {
  const char* const suffixes[] = {"", "k", "M", "G", "T"};
  int step = 0;
  while (std::fabs(value) >= 999.5 && step < 4) {
    value /= 1000.0;
    ++step;
  }
  char text[32];
  std::snprintf(text, sizeof text, step == 0 ? "%.4g%s" : "%.3g%s", value, suffixes[step]);
  return text;
}

}  // namespace bnvpl
