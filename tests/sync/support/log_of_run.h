// A small recorded run as a list of events, to be mixed, stamped wrongly and written as a log.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>
#include <vector>

#include "lcmtypes/channels.h"
#include "sync/log/log_index.h"
#include "sync/log/log_writer.h"
#include "sync/log/timestamped_events.h"
#include "tests/sync/support/memory_sink.h"

namespace tactus::sync {

struct TestEvent {
  std::int64_t stamp_us;
  std::string channel;
  std::vector<std::uint8_t> data;
};
using TestEvents = std::vector<TestEvent>;

struct TestRun {
  std::int64_t run_id = 77, incarnation = 5;
  std::string scene = "one.sdf";
  int ticks = 1000;  // of 5 ms
  int nodes = 3;
  std::int64_t begin_ns = 5'000'000'000, offset_ns = 1'700'000'000'000'000'000;
  std::string text = "fine";  // in every message
};

// LOG_INFO, then in each tick a health of each node, with latencies up to 0.4 ms, in the order of arrival.
inline TestEvents events_of(const TestRun& run) {
  TestEvents events;
  std::mt19937 random(static_cast<unsigned>(run.incarnation));
  log_info_t info{};
  info.header = header_of("recorder", run.incarnation + 100, 0, run.begin_ns, run.run_id);
  info.header.clock = 4711;
  info.realtime_offset_ns = run.offset_ns;
  info.live_from_ns = run.begin_ns;
  info.scene = run.scene;
  events.push_back({(run.begin_ns + run.offset_ns) / 1000, channels::kLogInfo, encode(info)});
  std::int64_t newest_us = 0;
  for (int tick = 0; tick < run.ticks; ++tick)
    for (int node = 0; node < run.nodes; ++node) {
      const std::int64_t sent_ns = run.begin_ns + 5'000'000LL * tick + 1'000'000 * node;
      node_health_t m{};
      m.node = "node_" + std::to_string(node);
      m.header = header_of(m.node.c_str(), run.incarnation + node, tick, sent_ns, run.run_id);
      m.header.clock = 4711;
      m.status_text = run.text;
      newest_us = std::max(newest_us, (sent_ns + run.offset_ns) / 1000 + static_cast<std::int64_t>(random() % 400));
      events.push_back({newest_us, channels::kNodeHealth, encode(m)});
    }
  return events;
}

inline std::vector<std::uint8_t> log_bytes(const TestEvents& events) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < events.size(); ++i)
    append_event(bytes, static_cast<std::int64_t>(i), events[i].stamp_us, events[i].channel, events[i].data);
  return bytes;
}

inline TestEvents operator+(TestEvents a, const TestEvents& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The events that a reader of a run receives.
struct ReadRun {
  std::vector<std::vector<std::uint8_t>> data;
  std::vector<std::string> channels;
  std::vector<std::int64_t> us;
};

inline ReadRun read_run(const LogIndex& index, int number) {
  ReadRun read;
  TimestampedEvents events(index, number);
  HostTime at{};
  for (LogEvent e; events.next(e, at);) {
    read.data.emplace_back(e.data.begin(), e.data.end());
    read.channels.emplace_back(e.channel);
    read.us.push_back(e.timestamp_us);
  }
  return read;
}

}  // namespace tactus::sync
