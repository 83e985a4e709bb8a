// upgrade_log: converts a recording to the message types of this release.
//
//   in   OLD: a log, or the folder of a run: all parts of its recording
//   out  NEW: one log
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "sync/log/log_writer.h"
#include "sync/log/mapped_log.h"
#include "sync/log/upgrade_log.h"
#include "sync/node/node_options.h"

using namespace tactus;

int main(int argc, char** argv) try {
  sync::Arguments app{"Converts a recording to the message types of this release."};
  std::string from, to;
  app.add_option("OLD", from, "log, or folder of a run: all parts of its recording").existing_path();
  app.add_option("NEW", to, "new log; must not exist");
  sync::parse_or_exit(app, "upgrade_log", argc, argv);

  if (from.empty() || to.empty()) throw std::runtime_error("give the log and the name of the new log; see upgrade_log --help");
  const sync::MappedLog file(from, sync::LogTypes::kAny);
  auto sink = std::make_unique<sync::FileSink>(to);
  try {
    const sync::UpgradeCounts counts = sync::upgrade_log(file.bytes(), std::move(sink));
    std::printf("%s: %lld messages, %lld of them converted", to.c_str(), static_cast<long long>(counts.events),
                static_cast<long long>(counts.converted));
    if (counts.damaged_regions > 0)
      std::printf("; %lld damaged places left out", static_cast<long long>(counts.damaged_regions));
    std::printf("\n");
  } catch (const std::runtime_error& e) {
    std::filesystem::remove(to);
    throw std::runtime_error(from + " " + e.what());
  }
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("upgrade_log", e);
}
