// export_events: exports the contact events, the presentation reports, and the clocks of sound and picture as CSV tables.
//
//   in   LOG...
//   out  DIR/events.csv, DIR/presented.csv, DIR/media_clock.csv, DIR/clock_map.csv, DIR/frame_shown.csv
//
// Intact parts of a damaged log are read. Each event and each report is listed once, although it is sent repeatedly.
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/frame_shown_t.hpp>
#include <tactus/media_clock_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/presented_t.hpp>
#include <tuple>

#include "sync/bus/decode.h"
#include "sync/log/export_events.h"
#include "sync/log/timestamped_events.h"
#include "sync/tools/exported_logs.h"

using namespace tactus;

namespace {

template <class Message>
std::optional<Message> message_of(const sync::LogEvent& e) {
  return sync::decode<Message>(e.data.data(), e.data.size());
}

class Tables {
 public:
  Tables(const std::string& out, const sync::LogInterval& interval)
      : interval_(interval), events_(out + "/events.csv"), presented_(out + "/presented.csv"), clocks_(out + "/media_clock.csv"), maps_(out + "/clock_map.csv"),
        frames_(out + "/frame_shown.csv") {
    events_ << sync::events_csv_names();
    presented_ << sync::presented_csv_names();
    clocks_ << sync::media_clock_csv_names();
    maps_ << sync::clock_map_csv_names();
    frames_ << sync::frame_shown_csv_names();
  }

  void add_run(const sync::LogIndex& index, int run) {
    names_.clear(), seen_.clear(), reported_.clear();
    sync::TimestampedEvents events(index, run);
    sync::HostTime at{};
    for (sync::LogEvent e; events.next(e, at);) add(e, run, interval_.contains(events.origin(), at));
  }

  // Throws std::runtime_error with one sentence when the tables cannot be written.
  void close(const std::string& out) {
    for (std::ofstream* table : {&events_, &presented_, &clocks_, &maps_, &frames_}) {
      table->close();
      if (!*table) throw std::runtime_error("cannot write the tables to " + out + "; give --out a writable folder");
    }
    std::cout << event_count_ << " events, " << report_count_ << " presentations\n";
  }

 private:
  // inside: it arrived in the interval. An event or report belongs to its first message; repetitions do not move it into the interval.
  void add(const sync::LogEvent& e, int run, bool inside) {
    if (e.channel == channels::kContactEvents)
      if (const auto m = message_of<contact_events_t>(e))
        for (const contact_event_t& event : m->events)
          if (seen_.insert(event.event_id).second && inside) ++event_count_, events_ << sync::csv_row(event, m->clock, run);
    if (e.channel == channels::kPresented)
      if (const auto m = message_of<presented_t>(e))
        for (const presentation_t& p : m->reports)
          if (reported_.insert({m->header.source, p.event_id, p.part}).second && inside) ++report_count_, presented_ << sync::csv_row(m->modality, p, run);
    if (e.channel == channels::kNodeHealth)
      if (const auto m = message_of<node_health_t>(e)) names_[m->header.source] = m->node;
    if (!inside) return;
    if (e.channel == channels::kMediaClock)
      if (const auto m = message_of<media_clock_t>(e)) clocks_ << sync::csv_row(*m, run);
    if (e.channel == channels::kClockMap)
      if (const auto m = message_of<clock_map_t>(e)) maps_ << sync::csv_row(*m, run);
    if (e.channel == channels::kFrameShown)
      if (const auto m = message_of<frame_shown_t>(e)) {
        const auto name = names_.find(m->header.source);
        frames_ << sync::csv_row(name == names_.end() ? std::to_string(m->header.source) : name->second, *m, run);
      }
  }

  sync::LogInterval interval_;
  std::ofstream events_, presented_, clocks_, maps_, frames_;
  std::map<std::int32_t, std::string> names_;  // of processes, by header.source
  std::set<std::int64_t> seen_;
  std::set<std::tuple<std::int32_t, std::int64_t, std::int8_t>> reported_;
  std::size_t event_count_ = 0, report_count_ = 0;
};

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Makes tables of contact events, presentations, media clocks and clock maps from the log of a run."};
  sync::ExportedLogOptions options;
  std::string out = ".";
  options.add_to(app);
  app.add_option("--out", out, "folder for the tables").existing_folder().show_default();
  sync::parse_or_exit(app, "export_events", argc, argv);

  const sync::ExportedLogs logs(options, "export_events");
  Tables tables(out, options.interval);
  for (const int run : logs.runs()) tables.add_run(logs.index(), run);
  tables.close(out);
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("export_events", e);
}
