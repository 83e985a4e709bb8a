// watch: shows the state of every node of the running cluster, once a second.
//
//   in   NODE_HEALTH, SYNC_REPORT
//   out  a table on stdout, redrawn in place on a terminal; or one line of JSON
//
// A node that falls silent is shown as LOST; without sync_node the line about the events is missing.
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <iostream>
#include <tactus/node_health_t.hpp>
#include <tactus/sync_report_t.hpp>

#include "sync/bus/bus_arguments.h"
#include "sync/bus/bus.h"
#include "sync/bus/receive_buffer.h"
#include "sync/node/node_options.h"
#include "sync/tools/watch_table.h"

using namespace tactus;

namespace {

std::atomic<bool> stop{false};

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= 40 ? size.ws_col : 110;
}

void show(const sync::WatchTable& table, sync::HostTime now, bool json, bool in_place) {
  if (json)
    std::cout << table.to_json(now) << std::flush;
  else  // moves to the corner, prints the table, and clears the rest
    std::cout << (in_place ? "\033[H\033[2J" : "") << table.to_text(now, terminal_width()) << (in_place ? "" : "\n")
              << std::flush;
}

}  // namespace

int main(int argc, char** argv) try {
  sync::Arguments app{"Shows the state of every node of the running cluster once a second."};
  sync::BusOptions bus_options;
  bool once = false, json = false;
  std::int64_t run_id = 0;
  double period_s = 1;
  sync::add_bus_options(app, bus_options);
  app.add_option("--run-id", run_id, "only nodes of this cluster run; 0: of all").environment("TACTUS_RUN_ID");
  app.add_flag("--once", once, "show one table and end; status 1 when no node was received");
  app.add_flag("--json", json, "one line of JSON each time instead of the table");
  app.add_option("--period", period_s, "seconds from one table to the next; health is published ten times a second")
      .range(0.05, 3600.0)
      .show_default();
  sync::parse_or_exit(app, "watch", argc, argv);
  for (int s : {SIGINT, SIGTERM}) signal(s, [](int) { stop = true; });

  sync::Bus bus(sync::Identity::fresh("watch", std::max<std::int64_t>(1, run_id)), bus_options);
  sync::drop_receive_buffer_right();
  auto& health = bus.queue<node_health_t>(channels::kNodeHealth, 1024);
  auto& report = bus.queue<sync_report_t>(channels::kSyncReport, 256);
  const bool in_place = !once && !json && isatty(STDOUT_FILENO) == 1;
  sync::WatchTable table;
  const sync::Nanoseconds period = sync::from_seconds(period_s);
  sync::HostTime next = sync::host_now() + period;
  while (!stop && std::cout) {
    bus.wait(std::min(period, sync::Nanoseconds(1'000'000'000)) / 20);
    const sync::HostTime now = sync::host_now();
    bus.drain(now);
    while (const auto m = health.pop())
      if (run_id == 0 || m->message.header.run_id == run_id) table.observe(m->message, m->arrival);
    while (const auto m = report.pop())
      if (run_id == 0 || m->message.header.run_id == run_id) table.observe(m->message);
    if (now < next) continue;
    next += period;
    show(table, now, json, in_place);
    if (once && table.empty())
      throw std::runtime_error("received no node on port " + std::to_string(bus_options.port) +
                               " in one second; start watch with tactus attach, or give its --port");
    if (once) break;
  }
  return 0;
} catch (const std::exception& e) {
  return tactus::sync::fail("watch", e);
}
