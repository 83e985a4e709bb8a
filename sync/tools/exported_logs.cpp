#include "sync/tools/exported_logs.h"

#include <iostream>
#include <stdexcept>

#include "sync/text/printable.h"

namespace tactus::sync {

void ExportedLogOptions::add_to(Arguments& app) {
  app.add_option("LOG", logs, "logs of one run, in order, or its folder: all parts").required().existing_path();
  app.add_option("--run", run, "number of one run of a log with several; default: all, with their number in the column run").range(1, 1'000'000);
  app.add_option("--since", interval.since_s, "from this second of the log");
  app.add_option("--until", interval.until_s, "up to this second of the log");
  app.add_flag("--quiet", quiet, "without warnings about the log");
}

ExportedLogs::ExportedLogs(const ExportedLogOptions& options, const std::string& program)
    : run_(options.run), file_(options.logs), index_(file_.bytes()) {
  if (!(options.interval.since_s <= options.interval.until_s))
    throw std::runtime_error("--since is after --until; give the earlier second of the log with --since");
  index_.read_all();
  try {
    const std::vector<std::string> warnings = index_.warnings(run_);
    if (!options.quiet)
      for (const std::string& sentence : warnings) std::cerr << program << ": " << sentence << "\n";
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(printable(options.logs.front()) + " " + e.what());
  }
}

std::vector<int> ExportedLogs::runs() const {
  if (run_ > 0) return {run_};
  std::vector<int> all;
  for (std::size_t i = 0; i < index_.runs().size(); ++i) all.push_back(static_cast<int>(i) + 1);
  return all;
}

}  // namespace tactus::sync
