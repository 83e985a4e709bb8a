// export_csv: exports the haptic and thermal output of a run from its log as CSV tables.
//
//   in   LOG...
//   out  DIR/haptic.csv, DIR/thermal.csv
//
// Intact parts of a damaged log are read. Each message has one row, in the order of time, also when it is in the log twice.
#include <fstream>
#include <iostream>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/bus/decode.h"
#include "sync/log/export_csv.h"
#include "sync/log/timestamped_events.h"
#include "sync/tools/exported_logs.h"

using namespace tactus;

namespace {

class Table {
 public:
  Table(std::string path, const std::string& names) : path_(std::move(path)), file_(path_, std::ios::binary) {
    file_ << names;
  }
  template <class Message>
  void add(const sync::LogEvent& e, int run) {
    if (const auto m = sync::decode<Message>(e.data.data(), e.data.size())) file_ << sync::csv_row(*m, run), ++rows_;
  }
  void close() {
    file_.close();
    if (!file_) throw std::runtime_error("cannot write " + path_ + "; give --out a writable folder");
    std::cout << path_ << ": " << rows_ << " rows\n";
  }

 private:
  std::string path_;
  std::ofstream file_;
  std::int64_t rows_ = 0;
};

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Writes tables of forces and skin temperatures from the log of a run."};
  sync::ExportedLogOptions options;
  std::string out = ".";
  options.add_to(app);
  app.add_option("--out", out, "folder for the tables").existing_folder().show_default();
  sync::parse_or_exit(app, "export_csv", argc, argv);

  const sync::ExportedLogs logs(options, "export_csv");
  Table haptic(out + "/haptic.csv", sync::haptic_csv_names());
  Table thermal(out + "/thermal.csv", sync::thermal_csv_names());
  for (const int run : logs.runs()) {
    sync::TimestampedEvents events(logs.index(), run);
    sync::HostTime at{};
    for (sync::LogEvent event; events.next(event, at);) {
      if (!options.interval.contains(events.origin(), at)) continue;
      if (event.channel == channels::kToolState) haptic.add<tool_state_t>(event, run);
      if (event.channel == channels::kThermalState) thermal.add<thermal_state_t>(event, run);
    }
  }
  haptic.close();
  thermal.close();
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("export_csv", e);
}
