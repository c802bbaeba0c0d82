#include "tools/common/run_tool.h"

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <new>
#include <sstream>

#include "formats/atomic_file.h"

namespace bnvpl {

namespace {

double nowS() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double peakMemoryMiB() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts in KiB
}

}  // namespace

void addToolOptions(CLI::App& cli, ToolOptions& options) {
  cli.add_option("--threads", options.threads, "worker threads; 0 takes every core")
      ->capture_default_str();
  cli.add_flag("--quiet", options.quiet, "no progress and no summary; errors and warnings stay");
  cli.add_option("--stats", options.stats, "also write the summary to this file, as JSON");
  cli.set_version_flag("--version", cli.get_name() + " " + BNVPL_VERSION);
  cli.get_formatter()->column_width(34);
}

void addDepfileOption(CLI::App& cli, ToolOptions& options) {
  cli.add_option("--depfile", options.depfile,
                 "write the files that were read, in Make syntax, for make and ninja");
}

uint64_t parseCount(const std::string& text) {
  const auto fail = [&](const char* why) -> UsageError {
    return UsageError("'" + text + "' " + why + "; write a whole number such as 3000, 3k or 10M");
  };
  size_t used = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    throw fail("is not a count");
  }
  const std::string suffix = text.substr(used);
  if (suffix == "k" || suffix == "K")
    value *= 1e3;
  else if (suffix == "m" || suffix == "M")
    value *= 1e6;
  else if (suffix == "g" || suffix == "G")
    value *= 1e9;
  else if (!suffix.empty())
    throw fail("has an unknown suffix");
  if (!(value >= 1.0) || value > 0x1p53) throw fail("is out of range");
  if (value != std::floor(value)) throw fail("is not whole");
  return static_cast<uint64_t>(value);
}

CLI::Option* addCount(CLI::App& cli, const std::string& flags, uint64_t& value,
                      const std::string& help) {
  return cli
      .add_option_function<std::string>(
          flags,
          [&value](const std::string& text) {
            try {
              value = parseCount(text);
            } catch (const UsageError& e) {
              throw CLI::ValidationError(e.what());
            }
          },
          help)
      ->type_name("COUNT")
      ->default_str(std::to_string(value));
}

int runTool(CLI::App& cli, const ToolOptions& options, int argc, char** argv,
            const std::function<int()>& work) {
  const std::string name = cli.get_name();
  const auto fail = [&](int code, const std::string& what) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), what.c_str());
    return code;
  };
  try {
    cli.parse(argc, argv);
    tbb::global_control limit(
        tbb::global_control::max_allowed_parallelism,
        options.threads > 0
            ? options.threads
            : tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
    return work();
  } catch (const CLI::Success& e) {  // --help, --version
    return cli.exit(e, std::cout, std::cerr);
  } catch (const CLI::ParseError& e) {
    return fail(kExitUsage, std::string(e.what()) + "; see " + name + " --help");
  } catch (const UsageError& e) {
    return fail(kExitUsage, e.what());
  } catch (const InputError& e) {
    return fail(kExitInput, e.what());
  } catch (const OutputError& e) {
    return fail(kExitOutput, e.what());
  } catch (const std::bad_alloc&) {
    return fail(kExitInput, "out of memory; lower the counts or the film size");
  } catch (const std::exception& e) {
    return fail(kExitInternal, std::string("internal error: ") + e.what());
  }
}

void requireWritable(const std::vector<fs::path>& outputs) {
  for (const fs::path& output : outputs) {
    if (!output.empty()) AtomicFile probe(output);  // throws; leaves nothing behind
  }
}

CLI::Validator inRange(double least, double most) {
  std::ostringstream range;
  range << "in [" << least << ", " << most << "]";
  return CLI::Validator(
      [=](std::string& text) {
        double value = 0.0;
        const bool valid =
            CLI::detail::lexical_cast(text, value) && value >= least && value <= most;
        return valid ? std::string()
                     : "'" + text + "' is not a number from " + std::to_string(least) + " to " +
                           std::to_string(most);
      },
      range.str());
}

std::string hashText(uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::string extendProvenance(const std::string& earlier, const std::string& tool,
                             const Json& options, const Json& inputs) {
  Json chain = earlier.empty() ? Json::array() : Json::parse(earlier);
  chain.push_back(
      {{"tool", tool}, {"version", BNVPL_VERSION}, {"options", options}, {"inputs", inputs}});
  return chain.dump();
}

Summary::Summary(std::string tool) : tool_(std::move(tool)), startS_(nowS()) {
  values_["tool"] = tool_;
  values_["version"] = BNVPL_VERSION;
}

void Summary::add(const std::string& key, Json value, const std::string& text) {
  values_[key] = std::move(value);
  if (!text.empty()) lines_.push_back(text);
}

void Summary::finish(const ToolOptions& options) const {
  Json values = values_;
  values["time_s"] = nowS() - startS_;
  values["peak_memory_MiB"] = peakMemoryMiB();
  if (!options.stats.empty()) writeFileAtomically(options.stats, values.dump(2) + "\n");
  if (options.quiet) return;
  for (const std::string& line : lines_) std::printf("%s: %s\n", tool_.c_str(), line.c_str());
  std::printf("%s: %.2f s, peak memory %.0f MiB\n", tool_.c_str(), values["time_s"].get<double>(),
              values["peak_memory_MiB"].get<double>());
  std::fflush(stdout);
}

void printWarnings(const std::string& tool, const std::vector<std::string>& warnings) {
  for (const std::string& w : warnings) {
    std::fprintf(stderr, "%s: warning: %s\n", tool.c_str(), w.c_str());
  }
}

void writeDepfile(const fs::path& depfile, const fs::path& target,
                  const std::vector<fs::path>& files) {
  if (depfile.empty()) return;
  const auto escape = [](const fs::path& path) {  // what both Make and ninja understand
    std::string out;
    for (const char c : path.string()) {
      if (c == ' ' || c == '#' || c == '\\') out += '\\';
      if (c == '$') out += '$';
      out += c;
    }
    return out;
  };
  std::string text = escape(target) + ":";
  for (const fs::path& f : files) text += " \\\n  " + escape(f);
  writeFileAtomically(depfile, text + "\n");
}

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
