// A log of a run, built in a test.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/node_health_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/tools/recorder/recorder.h"
#include "sync/tools/summary/summary.h"
#include "tests/sync/presentation/presentation_matcher_fixture.h"

namespace tactus::sync {

inline constexpr std::int64_t kOffsetNs = 1'700'000'000'123'456'000;

// A log of a run as the recorder writes it; times are ms as in MatcherFixture.
struct RunLog {
  std::shared_ptr<MemorySink::State> state = std::make_shared<MemorySink::State>();
  LogWriter writer{std::make_unique<MemorySink>(state)};
  std::map<std::string, std::int64_t> seq;
  std::string status_text = "SCHED_FIFO 60, memory locked";  // in every health message

  explicit RunLog(bool with_info = true) {
    if (!with_info) return;
    log_info_t info{};
    info.header = header_of("recorder", 1, 0, MatcherFixture::kBase);
    info.scene = "room.sdf";
    info.git = "abc";
    info.seed = 42;
    info.seconds = 10;
    info.realtime_offset_ns = kOffsetNs;
    info.live_from_ns = MatcherFixture::kBase;
    write(channels::kLogInfo, info, -1);
  }
  template <class Message>
  void write(const char* channel, const Message& m, double ms) {
    writer.write((to_ns(MatcherFixture::at(ms)) + kOffsetNs) / 1000, channel, encode(m));
    writer.flush();
  }
  std::int8_t quality = 0, qualities = 0;
  std::vector<input_health_t> inputs;
  template <class Message>
  void send(const char* channel, Message m, double ms) {
    m.header.seq = seq[channel + std::to_string(m.header.source)]++;
    write(channel, m, ms);
  }
  void health(const std::string& node, const std::string& modality, double ms, double rate_Hz,
              std::int64_t incarnation = 1, std::int8_t state_ = node_health_t::RUNNING, std::int64_t missed = 0) {
    node_health_t m = MatcherFixture::health_message(
        node, modality, modality.empty() ? 0 : node_health_t::EXPECTS_HIT, ms, incarnation, state_);
    m.nominal_rate_Hz = rate_Hz;
    m.ticks = static_cast<std::int64_t>(ms * 1e-3 * rate_Hz);
    m.missed_ticks = missed;
    m.stale_ticks = 4;
    m.status_text = status_text;
    Histogram h;
    h.add(Nanoseconds(static_cast<std::int64_t>(incarnation) * 100'000));
    m.tick = m.wake = h.to_message();
    m.quality = quality, m.qualities = qualities;
    m.inputs = inputs;
    m.input_count = static_cast<std::int32_t>(inputs.size());
    send(channels::kNodeHealth, m, ms);
  }
  RunSummary summary(SummaryOptions options = {}) const {
    RunSummary s(std::move(options));
    LogScanner scanner(state->bytes);
    for (LogEvent e; scanner.next(e);) s.add(e);
    s.end_of_log(scanner.damaged_regions());
    return s;
  }
};

inline void ordinary_run(RunLog& log) {
  for (int ms = 0; ms <= 10000; ms += 20) {
    if (ms % 100 == 0) {
      log.health("audio_node", "audio", ms, 750);
      log.health("visual_node", "visual", ms, 60);
    }
    world_state_t world{};
    world.header = header_of("sim_node", 100, 0, to_ns(MatcherFixture::at(ms)));
    world.header.sim_time_ns = std::int64_t{ms} * 990'000;  // one per cent slow
    world.pages = 1;
    log.send(channels::kWorldState, world, ms);
    if (ms < 1000 || ms > 9000 || ms % 100 != 20) continue;
    const int id = ms;
    log.send(channels::kContactEvents, MatcherFixture::event_message(id, ms - 1, contact_event_t::HIT, 100), ms);
    log.send(channels::kPresented, MatcherFixture::presented_message("audio_node", "audio", id, ms + 19), ms + 1);
    log.send(channels::kPresented, MatcherFixture::presented_message("visual_node", "visual", id, ms + 12),
             ms + 2);
  }
}

}  // namespace tactus::sync
