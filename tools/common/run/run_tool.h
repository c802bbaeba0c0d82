// What the mains of all tools share: options, exit codes, summary and provenance records.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/processor.h"
#include "formats/atomic_file.h"
#include "tools/common/options/cli_option.h"
#include "tools/common/options/stage_cli.h"
#include "tools/common/run/progress_meter.h"

namespace bnvpl {

// Options of all tools. They do not change the result and never enter a provenance record, except
// --processor, which does.
struct ToolOptions {
  Processor processor = Processor::This;
  unsigned threads = 0;  // 0: all cores
  bool quiet = false;
  bool strict = false;     // the first warning ends the tool, as bad input does
  bool noClobber = false;  // existing outputs are refused
  bool jsonProgress = false;
  fs::path stats;    // JSON summary, empty: none
  fs::path depfile;  // Make/ninja dependencies, empty: none
};

// Adds an option, or an argument if `name` has no dashes, that takes one or several file names.
// Empty names are refused: they usually come from an unset variable of a script.
CLI::Option* addFile(CLI::App& cli, const std::string& name, fs::path& file,
                     const std::string& help);
CLI::Option* addFile(CLI::App& cli, const std::string& name, std::vector<fs::path>& files,
                     const std::string& help);

// Adds --threads, --quiet, --strict, --no-clobber, --progress, --stats, --version and the forms of
// --help. addDepfileOption() is for tools that read more files than the command line names.
void addToolOptions(CLI::App& cli, ToolOptions& options);
void addDepfileOption(CLI::App& cli, ToolOptions& options);
// Adds --processor, for tools that compute.
void addProcessorOption(CLI::App& cli, ToolOptions& options);

// Parses argv, restarts the tool if --processor requires it (pin_functions.h), limits oneTBB to
// --threads, calls `work`, and turns exceptions into one line on stderr and the documented exit
// code. It is the only try/catch of a tool. interrupt.h describes signals.
int runTool(CLI::App& cli, const ToolOptions& options, int argc, char** argv,
            const std::function<int()>& work);

inline ProgressStyle progressStyle(const ToolOptions& options) {
  if (options.jsonProgress) return ProgressStyle::JsonLines;
  return options.quiet ? ProgressStyle::Silent : ProgressStyle::Lines;
}

// Number of worker threads that the work of runTool() may use.
unsigned threadsInUse();

// Does what runTool() does for --processor, for a tool whose inputs name the processor. Call it
// before any thread or output exists.
void computeFor(Processor processor);

// The name of the tool that runTool() runs, which begins each line on stderr.
const std::string& runningTool();

// Throws OutputError unless a file can be written beside each output. Empty paths are skipped. See
// also run_files.h.
void requireWritable(const std::vector<fs::path>& outputs);

// The value under a key of JSON that was read. Throws InputError if it is missing or of another
// type.
template <typename T>
T fieldOf(const Json& json, const char* key) {
  try {
    return json.at(key).get<T>();
  } catch (const Json::exception&) {
    throw InputError("'" + std::string(key) +
                     "' of a record is missing or of another type; make the file again");
  }
}

// stageRecord() describes one run of a stage. extendProvenance() appends it to the history of the
// input, which is empty for the first stage.
//   {"tool": "vpl-place", "version": "0.3.0+<build>", "options": {...}, "inputs": {"scene":
//   "<hash>"}}
// It also has "processor": "any" if that was requested.
Json stageRecord(const std::string& tool, const Json& options, const Json& inputs,
                 Processor processor = Processor::This);
Processor processorOf(const Json& record);
std::string extendProvenance(const std::string& earlier, const Json& record);

// Collects the figures of a run. finish() writes them to --stats, with time and peak memory,
// commits all output files together, and prints the lines for people to stdout unless --quiet is
// given.
class Summary {
 public:
  explicit Summary(std::string tool);
  double startS() const { return startS_; }  // by nowS(): when it was made
  // `text` is for people, `value` for the JSON file. Keys carry their units: "time_s".
  void add(const std::string& key, Json value, const std::string& text = "");
  // Adds "non_finite_samples", the number of samples that became NaN or infinite and count as zero,
  // and prints one warning if there are any. `what` names them in the plural.
  void addNonFinite(uint64_t count, const std::string& what);
  // Puts the outputs in place, calls `committed`, and prints the summary.
  void finish(const ToolOptions& options, OutputSet& files,
              const std::function<void()>& committed = {}) const;
  // The same without lines for people, for commands that print their answer to stdout.
  void save(const ToolOptions& options, OutputSet& files) const { close(options, files); }

 private:
  struct Cost {
    double timeS, memoryMiB;
  };
  Cost close(const ToolOptions& options, OutputSet& files) const;

  std::string tool_;
  double startS_;
  Json values_ = Json::object();
  std::vector<std::string> lines_;
};

// Prints each warning as one line on stderr. --quiet does not silence warnings. Throws InputError
// after them with --strict.
void printWarnings(const std::string& tool, const std::vector<std::string>& warnings);
// Prints a warning of what an option asks for, which --strict allows.
void warnAsAsked(const std::string& text);

// Holds a warning about an input back until printHeldWarnings(). If an InputError ends the tool,
// runTool() prints the held warnings before it, except one that the error repeats; if the tool
// succeeds, they are never printed. Only the thread of runTool() may call these.
void holdWarning(const std::string& text);
void printHeldWarnings();

std::string formatSi(double value);  // 12345678 -> "12.3M"

}  // namespace bnvpl
