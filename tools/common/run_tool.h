// What every stage's main shares: options of all tools, exit codes, summary, provenance records.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/processor.h"
#include "formats/atomic_file.h"
#include "tools/common/cli_option.h"
#include "tools/common/stage_cli.h"

namespace bnvpl {

// Options that do not change what is computed, and therefore never enter a provenance record; and
// --processor, which does.
struct ToolOptions {
  Processor processor = Processor::This;
  unsigned threads = 0;  // 0: all cores
  bool quiet = false;
  fs::path stats;    // JSON summary, empty: none
  fs::path depfile;  // Make/ninja dependencies, empty: none
};

// An option, or without dashes an argument, that names a file, or several. An empty name, as of an
// unset variable of a script, is refused.
CLI::Option* addFile(CLI::App& cli, const std::string& name, fs::path& file,
                     const std::string& help);
CLI::Option* addFile(CLI::App& cli, const std::string& name, std::vector<fs::path>& files,
                     const std::string& help);

// --threads --quiet --stats --version, and --depfile where the stage reads more than it is named.
void addToolOptions(CLI::App& cli, ToolOptions& options);
void addDepfileOption(CLI::App& cli, ToolOptions& options);
// --processor, of tools that compute.
void addProcessorOption(CLI::App& cli, ToolOptions& options);

// Parses argv, starts the tool anew where --processor asks for it (pin_functions.h), limits oneTBB
// to --threads, calls `work`, and turns exceptions into one line on stderr and the documented exit
// code. The only try/catch of a tool. Signals: interrupt.h.
int runTool(CLI::App& cli, const ToolOptions& options, int argc, char** argv,
            const std::function<int()>& work);

// Worker threads that the work of runTool() may take.
unsigned threadsInUse();

// For a tool that finds out whose bits to compute by what it reads: what runTool() does for
// --processor. Before there is any thread or output.
void computeFor(Processor processor);

// The name of the tool that runTool() runs, which begins each line on stderr.
const std::string& runningTool();

// Tries to write beside each output; see also run_files.h. Empty paths are not asked for.
void requireWritable(const std::vector<fs::path>& outputs);

// What a file from elsewhere says under a key. Throws InputError where it does not, in that type.
template <typename T>
T fieldOf(const Json& json, const char* key) {
  try {
    return json.at(key).get<T>();
  } catch (const Json::exception&) {
    throw InputError("'" + std::string(key) +
                     "' of a record is missing or of another type; make the file again");
  }
}

// What a stage did, and that record behind those of its input (empty for the first stage).
//   {"tool": "vpl-place", "version": "0.2.0+<build>", "options": {...}, "inputs": {"scene":
//   "<hash>"}}
// and "processor": "any" in it where that was asked for.
Json stageRecord(const std::string& tool, const Json& options, const Json& inputs,
                 Processor processor = Processor::This);
Processor processorOf(const Json& record);
std::string extendProvenance(const std::string& earlier, const Json& record);
std::string hashText(uint64_t hash);  // 16 hexadecimal digits

// Ends a tool's work: the figures go to --stats, with time and peak memory; then all files that the
// run made are replaced together, and the lines for people are printed to stdout unless quiet.
class Summary {
 public:
  explicit Summary(std::string tool);
  // `text` is for people, `value` for the JSON file. Keys carry their units: "time_s".
  void add(const std::string& key, Json value, const std::string& text = "");
  // Samples that became NaN or infinite and count as zero: "non_finite_samples", and one warning
  // where there are any. `what` names them in the plural.
  void addNonFinite(uint64_t count, const std::string& what);
  void finish(const ToolOptions& options, OutputSet& files) const;
  // The same without lines for people, where stdout is for what was asked.
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

// Prints each warning once, by name, to stderr. Warnings are not silenced by --quiet.
void printWarnings(const std::string& tool, const std::vector<std::string>& warnings);

// A warning about an input, which waits: for printHeldWarnings(), or for an InputError, which
// runTool() prints behind all that wait. One that the error repeats is left out; those that wait
// when the tool ends well are never printed. Called by the thread of runTool() alone.
void holdWarning(const std::string& text);
void printHeldWarnings();

std::string formatSi(double value);  // 12345678 -> "12.3M"

}  // namespace bnvpl
