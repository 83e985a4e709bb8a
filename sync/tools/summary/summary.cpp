#include "sync/tools/summary/summary.h"

#include <algorithm>
#include <cmath>
#include <tactus/clock_map_t.hpp>
#include <tactus/contact_events_t.hpp>
#include <tactus/degraded_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/playout_t.hpp>
#include <tactus/presented_t.hpp>
#include <tactus/world_state_t.hpp>

#include "sync/bus/decode.h"
#include "sync/degradation/known_modalities.h"
#include "sync/degradation/measured_effect.h"
#include "sync/log/log_header.h"
#include "sync/log/log_origin.h"
#include "sync/text/printable.h"

namespace tactus::sync {

void RunSummary::observe(const log_info_t& m) {
  // The first LOG_INFO of a log is its own; others crossed the bus while another log was replayed. Of several logs of a run,
  // the first contains the intended parameters.
  if (time_known_) return;
  time_known_ = true;
  realtime_offset_ns_ = m.realtime_offset_ns;
  live_from_ns_ = m.live_from_ns;
  if (info_) return;
  info_ = m;
  maps_ = std::make_unique<ClockMaps>(m.header.run_id);
  matcher_ = PresentationMatcher(OwnClock(m.header.run_id, m.header.clock, maps_.get()));
}

void RunSummary::observe(const node_health_t& m, HostTime now) {
  auto [it, first] = incarnations_[m.node].try_emplace(m.header.incarnation);
  Incarnation& incarnation_health = it->second;
  warnings_.observe(m, now);
  // A node waits at another rate than it runs at: its rate is counted from the beginning of its current state.
  const bool began_to_run = m.state == node_health_t::RUNNING && (incarnation_health.first.state == node_health_t::WAITING ||
                                                                  incarnation_health.first.state == node_health_t::READY);
  if (first || began_to_run || m.nominal_rate_Hz != incarnation_health.first.nominal_rate_Hz) incarnation_health.first = m;
  incarnation_health.last = m;
  incarnation_health.last_received = now;
  if (m.qualities > 0) {
    auto& steps = quality_[m.node];
    steps.resize(std::max(steps.size(), static_cast<std::size_t>(std::max<int>(m.qualities, m.quality + 1))));
    ++steps[static_cast<std::size_t>(m.quality)];
  }
  auto& ages = input_age_[m.node];
  for (const input_health_t& input : m.inputs)
    if (input.age_ns >= 0 && (ages.contains(input.channel) || ages.size() < kMaxInputs))
      ages[input.channel].add(Nanoseconds(input.age_ns));
  if (!sim_progress_.contains(m.header.incarnation)) return;
  for (auto& [name, incarnations] : incarnations_)
    for (auto& [incarnation, other] : incarnations) other.status_text = other.last.status_text;
}

void RunSummary::observe_sim_progress(const header_t& h) {
  if (h.sim_time_ns < 0) return;
  const auto [it, first] = sim_progress_.try_emplace(
      h.incarnation, SimProgress{h.sim_time_ns, h.publish_time_ns, h.sim_time_ns, h.publish_time_ns});
  it->second.last_sim_ns = h.sim_time_ns;
  it->second.last_host_ns = h.publish_time_ns;
}

void RunSummary::observe_silence(HostTime now) {
  if (!begin_ || now - now_ <= kHole) return;
  silence_ = now - now_;
  silence_end_ = now;
}

void RunSummary::observe_gap() {
  if (now_ - silence_end_ <= kHoleDetectedWithin) holes_ += silence_;
  silence_ = Nanoseconds(0);
}

void RunSummary::add(const LogEvent& e) {
  auto channel = channels_.find(e.channel);
  if (channel == channels_.end()) channel = channels_.emplace(std::string(e.channel), Channel{}).first;

  if (e.channel == channels::kLogInfo) {
    if (const auto m = decode<log_info_t>(e.data.data(), e.data.size())) observe(*m);
  }
  const auto header = peek_header(e.data.data(), e.data.size());
  if (!time_known_ && header) {  // a log of the stock lcm-logger: the first message is assumed to have no latency
    time_known_ = true;
    realtime_offset_ns_ = bounded_us(e.timestamp_us) * 1000 - header->publish_time_ns;
  }
  const HostTime now = clock_.observe(time_of_stamp(e.timestamp_us, realtime_offset_ns_));
  // Messages at the head were written by the recorder and did not cross the bus. The log counts in microseconds.
  if (to_ns(now) / 1000 < live_from_ns_ / 1000) return;
  observe_silence(now);
  now_ = now;
  if (!begin_) begin_ = now;

  ChannelSummary& summary = channel->second.summary;
  ++summary.messages;
  summary.bytes += static_cast<std::int64_t>(e.data.size());
  if (header) {
    SequenceTracker& sequence = channel->second.sequence;
    const std::int64_t gaps = sequence.gaps();
    sequence.observe(*header);
    if (sequence.gaps() > gaps) observe_gap();
  }

  const auto feed = [&]<class Message>(const char* name, auto use) {
    if (e.channel != name) return;
    if (const auto m = decode<Message>(e.data.data(), e.data.size()))
      use(*m);
    else
      ++summary.bad;
  };
  const auto match = [&](const auto& m) { matcher_.observe(m, now); };
  feed.template operator()<node_health_t>(channels::kNodeHealth, [&](const node_health_t& m) {
    match(m);
    if (!info_ || m.header.run_id == info_->header.run_id) observe(m, now);
  });
  feed.template operator()<clock_map_t>(channels::kClockMap,
                                        [&](const clock_map_t& m) { maps_->observe(m, now); });
  feed.template operator()<contact_events_t>(channels::kContactEvents, match);
  feed.template operator()<presented_t>(channels::kPresented, match);
  feed.template operator()<playout_t>(channels::kPlayout, match);
  feed.template operator()<game_state_t>(channels::kGameState, [&](const game_state_t& m) {
    if (!info_ || m.header.run_id == info_->header.run_id) game_ = m;
  });
  feed.template operator()<degraded_t>(channels::kDegraded, match);
  feed.template operator()<world_state_t>(channels::kWorldState, [&](const world_state_t& m) {
    if (m.group != world_state_t::NOW) return;  // predicted states have future times
    observe_sim_progress(m.header);
    if (!info_ || m.header.run_id == info_->header.run_id) warnings_.observe_world(m.header.sim_time_ns, now);
  });
  matcher_.advance(now);
}

void RunSummary::end_of_log(std::int64_t damaged_regions) {
  damaged_regions_ += damaged_regions;
  if (begin_) {
    matcher_.finish(now_);
    recorded_ += now_ - *begin_;
  }
  begin_.reset();
  silence_ = Nanoseconds(0);
  clock_ = {};
  time_known_ = false;
  live_from_ns_ = 0;
}

double RunSummary::recorded_seconds() const { return to_seconds(recorded_); }

double RunSummary::seconds() const {
  if (options_.seconds) return *options_.seconds;
  return info_ && info_->seconds > 0 ? info_->seconds : recorded_seconds();
}

double RunSummary::realtime_factor() const {
  std::int64_t sim_ns = 0, host_ns = 0;
  for (const auto& [incarnation, c] : sim_progress_) {
    sim_ns += c.last_sim_ns - c.first_sim_ns;
    host_ns += c.last_host_ns - c.first_host_ns;
  }
  return host_ns > 0 ? static_cast<double>(sim_ns) / static_cast<double>(host_ns) : 0;
}

std::map<std::string, NodeSummary> RunSummary::nodes() const {
  std::map<std::string, NodeSummary> out;
  for (const auto& [name, incarnations] : incarnations_) {
    NodeSummary& node = out[name];
    std::int64_t ticks = 0, ns = 0;
    HostTime newest{};
    for (const auto& [incarnation, incarnation_health] : incarnations) {
      node.ticks += incarnation_health.last.ticks;
      node.missed_ticks += incarnation_health.last.missed_ticks;
      node.stale_ticks += incarnation_health.last.stale_ticks;
      node.tick.merge(Histogram::from_message(incarnation_health.last.tick));
      node.wake.merge(Histogram::from_message(incarnation_health.last.wake));
      ticks += incarnation_health.last.ticks - incarnation_health.first.ticks;
      ns += incarnation_health.last.header.publish_time_ns - incarnation_health.first.header.publish_time_ns;
      if (incarnation_health.last_received >= newest) {
        const std::string& at_end = incarnation_health.last.status_text;
        const std::string& text = incarnation_health.status_text.empty() ? at_end : incarnation_health.status_text;
        node.scheduling = without_effect(text);
        node.profile_effect = effect_in(text);
      }
      newest = std::max(newest, incarnation_health.last_received);
    }
    node.rate_Hz = ns > 0 ? static_cast<double>(ticks) / (static_cast<double>(ns) * 1e-9) : 0;
    node.restarts = static_cast<std::int64_t>(incarnations.size()) - 1;
    if (const auto ages = input_age_.find(name); ages != input_age_.end()) node.input_age = ages->second;
    if (const auto steps = quality_.find(name); steps != quality_.end()) node.quality = steps->second;
    node.alive_at_end = now_ - newest <= kAliveWithin;
  }
  for (const auto& [name, missed] : warnings_.missed_by_second())
    if (out.contains(name)) out[name].missed_by_second = missed;
  for (const auto& [name, restarts] : options_.restarts)
    if (out.contains(name)) out[name].restarts = std::max(out[name].restarts, restarts);
  return out;
}

std::vector<std::string> RunSummary::absent() const {
  std::vector<std::string> out;
  for (const KnownModality& m : known_modalities())
    if (!matcher_.modalities().contains(m.name)) out.push_back(m.name);
  return out;
}

std::vector<std::string> RunSummary::warnings() const {
  std::vector<std::string> out = options_.warnings;
  for (std::string& sentence : warnings_.sentences(matcher_)) out.push_back(printable(sentence));
  for (std::string& sentence : damage()) out.push_back(std::move(sentence));
  return out;
}

std::vector<std::string> RunSummary::damage() const {
  std::vector<std::string> out;
  for (const auto& [name, channel] : channels_)
    if (channel.summary.bad > 0)
      out.push_back(std::to_string(channel.summary.bad) + " of " + std::to_string(channel.summary.messages) + " messages of " + printable(name) +
                    " are incomplete or damaged and are left out");
  return out;
}

std::map<std::string, ChannelSummary> RunSummary::channels() const {
  std::map<std::string, ChannelSummary> out;
  for (const auto& [name, channel] : channels_) {
    if (channel.summary.messages == 0) continue;
    out[name] = channel.summary;
    out[name].gaps = channel.sequence.gaps();
  }
  return out;
}

std::string RunSummary::failure() const {
  std::string reason;
  const auto also = [&](const std::string& text) { reason += (reason.empty() ? "" : "; ") + text; };
  const auto present = nodes();
  for (const std::string& name : options_.nodes) {
    const auto it = present.find(name);
    if (it == present.end())
      also(name + " never reported");
    else if (!it->second.alive_at_end)
      also(name + " was not alive at the end");
  }
  for (const auto& [modality, tally] : matcher_.modalities())
    if (tally.lost > 0)
      also(modality + " lost " + std::to_string(tally.lost) + " of " + std::to_string(tally.expected) +
           " expected contact events");
  if (holes_ > Nanoseconds(0))
    also("the log has a hole of " + std::to_string(std::llround(holes_seconds())) +
         " s: the recorder was stopped");
  if (matcher_.overflow() > 0)
    also(std::to_string(matcher_.overflow()) + " events or senses exceed the limits of the matching");
  return reason;
}

}  // namespace tactus::sync
