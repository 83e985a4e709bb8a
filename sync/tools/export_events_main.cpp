// export_events: exports the contact events, the presentation reports, and the clocks of sound and picture as CSV tables.
//
//   in   LOG...
//   out  DIR/events.csv, DIR/presented.csv, DIR/media_clock.csv, DIR/clock_map.csv, DIR/frame_shown.csv
//
// Intact parts of a damaged log are read. Each event and each report is listed once, although it is sent repeatedly.
#include <fstream>
#include <iostream>
#include <map>
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
#include "sync/log/log_reader.h"
#include "sync/log/mapped_log.h"
#include "sync/node/node_options.h"

using namespace tactus;

int main(int argc, char** argv) try {
  sync::Arguments app{"Makes tables of contact events, presentations, media clocks and clock maps from the log of a run."};
  std::vector<std::string> logs;
  std::string out = ".";
  app.add_option("LOG", logs, "logs of one run, in order, or its folder: all parts").required().existing_path();
  app.add_option("--out", out, "folder for the tables").existing_folder().show_default();
  sync::parse_or_exit(app, "export_events", argc, argv);

  std::ofstream events(out + "/events.csv"), presented(out + "/presented.csv"), clocks(out + "/media_clock.csv"),
      maps(out + "/clock_map.csv"), frames(out + "/frame_shown.csv");
  events << sync::events_csv_names();
  presented << sync::presented_csv_names();
  clocks << sync::media_clock_csv_names();
  maps << sync::clock_map_csv_names();
  frames << sync::frame_shown_csv_names();
  std::map<std::int32_t, std::string> names;  // of processes, by header.source
  std::set<std::int64_t> seen;
  std::set<std::tuple<std::int32_t, std::int64_t, std::int8_t>> reported;
  for (const std::string& path : logs) {
    const sync::MappedLog file(path);
    sync::LogScanner scanner(file.bytes());
    for (sync::LogEvent e; scanner.next(e);) {
      if (e.channel == channels::kContactEvents)
        if (const auto m = sync::decode<contact_events_t>(e.data.data(), e.data.size()))
          for (const contact_event_t& event : m->events)
            if (seen.insert(event.event_id).second) events << sync::csv_row(event, m->clock);
      if (e.channel == channels::kPresented)
        if (const auto m = sync::decode<presented_t>(e.data.data(), e.data.size()))
          for (const presentation_t& p : m->reports)
            if (reported.insert({m->header.source, p.event_id, p.part}).second)
              presented << sync::csv_row(m->modality, p);
      if (e.channel == channels::kMediaClock)
        if (const auto m = sync::decode<media_clock_t>(e.data.data(), e.data.size())) clocks << sync::csv_row(*m);
      if (e.channel == channels::kClockMap)
        if (const auto m = sync::decode<clock_map_t>(e.data.data(), e.data.size())) maps << sync::csv_row(*m);
      if (e.channel == channels::kNodeHealth)
        if (const auto m = sync::decode<node_health_t>(e.data.data(), e.data.size())) names[m->header.source] = m->node;
      if (e.channel == channels::kFrameShown)
        if (const auto m = sync::decode<frame_shown_t>(e.data.data(), e.data.size())) {
          const auto name = names.find(m->header.source);
          frames << sync::csv_row(name == names.end() ? std::to_string(m->header.source) : name->second, *m);
        }
    }
  }
  events.close(), presented.close(), clocks.close(), maps.close(), frames.close();
  if (!events || !presented || !clocks || !maps || !frames)
    throw std::runtime_error("cannot write the tables to " + out + "; give --out a writable folder");
  std::cout << seen.size() << " events, " << reported.size() << " presentations\n";
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("export_events", e);
}
