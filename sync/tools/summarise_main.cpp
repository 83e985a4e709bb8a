// summarise: summarises a run from its log, and checks that every expected event has an outcome.
//
//   in   LOG...
//   out  the summary on stdout, and as JSON in a file
//
// Intact parts of a damaged log are read.
#include <fstream>
#include <iostream>

#include "sync/log/mapped_log.h"
#include "sync/log/timestamped_events.h"
#include "sync/node/node_options.h"
#include "sync/text/printable.h"
#include "sync/tools/summary/summary.h"

using namespace tactus;

namespace {

std::map<std::string, std::int64_t> parse_restarts(const std::vector<std::string>& pairs) {
  std::map<std::string, std::int64_t> out;
  for (const std::string& pair : pairs) {
    const auto equals = pair.find('=');
    const std::string count = equals == std::string::npos ? "" : pair.substr(equals + 1);
    if (count.empty() || count.size() > 9 || count.find_first_not_of("0123456789") != std::string::npos)
      throw std::runtime_error("--restarts " + pair + " is not NODE=COUNT");
    out[pair.substr(0, equals)] = std::stoll(count);
  }
  return out;
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  if (!file) throw std::runtime_error("cannot write " + path + "; give --out a file in a writable folder");
}

// Throws std::runtime_error with one sentence.
void add_run(sync::RunSummary& summary, const sync::LogIndex& index, const std::string& path, int run) try {
  for (const std::string& sentence : index.warnings(run)) std::cerr << "summarise: " << sync::printable(path) << ": " << sentence << "\n";
  sync::TimestampedEvents events(index, run);
  sync::HostTime at{};
  for (sync::LogEvent event; events.next(event, at);) summary.add(event);
  summary.end_of_log(index.damaged_regions());
} catch (const std::runtime_error& e) {
  throw std::runtime_error(sync::printable(path) + " " + e.what());
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Summarises a run from its log."};
  sync::SummaryOptions options;
  std::vector<std::string> logs, restarts;
  std::string out;
  app.add_option("LOG", logs, "logs of one run, in order, or its folder: all parts").required().existing_path();
  int run = 1;
  app.add_option("--run", run, "number of the run, of logs with several").range(1, 1'000'000).show_default();
  app.add_option("--out", out, "file for the summary as JSON");
  app.add_option("--nodes", options.nodes, "nodes that must be alive at the end: a,b,c").delimiter(',');
  app.add_option("--seconds", options.seconds, "length of the run");
  app.add_option("--scene", options.scene, "scene of the run");
  app.add_option("--seed", options.seed, "seed of the run");
  app.add_option("--git", options.git, "commit of the run");
  app.add_option("--restarts", restarts, "NODE=COUNT of the supervisor; may be repeated");
  app.add_option("--warning", options.warnings, "sentence about a missing resource; may be repeated");
  sync::parse_or_exit(app, "summarise", argc, argv);
  options.restarts = parse_restarts(restarts);

  sync::RunSummary summary(options);
  for (const std::string& path : logs) {
    const sync::MappedLog file(path);
    sync::LogIndex index(file.bytes());
    index.read_all();
    add_run(summary, index, path, run);
  }
  if (!out.empty()) write_file(out, sync::to_json(summary));
  std::cout << sync::to_text(summary) << std::flush;
  const std::string failure = summary.failure();
  if (failure.empty()) return 0;
  throw std::runtime_error(failure);
} catch (const std::exception& e) {
  return tactus::sync::fail("summarise", e);
}
