// A log in memory, and messages for it.
#pragma once

#include <memory>
#include <string>
#include <tactus/header_t.hpp>
#include <utility>
#include <vector>

#include "sync/bus/decode.h"
#include "sync/bus/identity.h"
#include "sync/log/log_reader.h"
#include "sync/log/log_writer.h"

namespace tactus::sync {

// Refuses all writes while `trouble` is not empty.
struct MemorySink : LogSink {
  struct State {
    std::vector<std::uint8_t> bytes;
    std::string trouble;
  };
  explicit MemorySink(std::shared_ptr<State> s) : state(std::move(s)) {}
  std::string append(std::span<const std::uint8_t> bytes) override {
    if (!state->trouble.empty()) return state->trouble;
    state->bytes.insert(state->bytes.end(), bytes.begin(), bytes.end());
    return "";
  }
  std::shared_ptr<State> state;
};

inline std::vector<LogEvent> read_all(std::span<const std::uint8_t> bytes) {
  LogScanner scanner(bytes);
  std::vector<LogEvent> events;
  for (LogEvent e; scanner.next(e);) events.push_back(e);
  return events;
}

inline header_t header_of(const std::string& node, std::int64_t incarnation, std::int64_t seq, std::int64_t publish_ns,
                          std::int64_t run_id = 7) {
  header_t h{};
  h.sim_time_ns = -1;
  h.publish_time_ns = publish_ns;
  h.run_id = run_id;
  h.source = static_cast<std::int32_t>(fnv1a_32(node));
  h.incarnation = incarnation;
  h.seq = seq;
  return h;
}

}  // namespace tactus::sync
