// export_csv: exports the haptic and thermal output of a run from its log as CSV tables.
//
//   in   LOG...
//   out  DIR/haptic.csv, DIR/thermal.csv
//
// Intact parts of a damaged log are read.
#include <fstream>
#include <iostream>
#include <tactus/thermal_state_t.hpp>
#include <tactus/tool_state_t.hpp>

#include "sync/bus/decode.h"
#include "sync/log/export_csv.h"
#include "sync/log/log_reader.h"
#include "sync/log/mapped_log.h"
#include "sync/node/node_options.h"

using namespace tactus;

namespace {

class Table {
 public:
  Table(std::string path, const std::string& names) : path_(std::move(path)), file_(path_, std::ios::binary) {
    file_ << names;
  }
  template <class Message>
  void add(const sync::LogEvent& e) {
    if (const auto m = sync::decode<Message>(e.data.data(), e.data.size())) file_ << sync::csv_row(*m), ++rows_;
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
  std::vector<std::string> logs;
  std::string out = ".";
  app.add_option("LOG", logs, "logs of one run, in order, or its folder: all parts").required().existing_path();
  app.add_option("--out", out, "folder for the tables").existing_folder().show_default();
  sync::parse_or_exit(app, "export_csv", argc, argv);

  Table haptic(out + "/haptic.csv", sync::haptic_csv_names());
  Table thermal(out + "/thermal.csv", sync::thermal_csv_names());
  for (const std::string& path : logs) {
    const sync::MappedLog file(path);
    sync::LogScanner scanner(file.bytes());
    for (sync::LogEvent event; scanner.next(event);) {
      if (event.channel == channels::kToolState) haptic.add<tool_state_t>(event);
      if (event.channel == channels::kThermalState) thermal.add<thermal_state_t>(event);
    }
  }
  haptic.close();
  thermal.close();
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("export_csv", e);
}
