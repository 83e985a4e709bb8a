#include "scripts/trial_runner/observations.h"

#include <cmath>
#include <string_view>
#include <tactus/contact_event_t.hpp>
#include <tactus/header_t.hpp>
#include <tactus/hole_state_t.hpp>
#include <tactus/presentation_t.hpp>
#include <utility>

namespace tactus::trial_runner {
namespace {

using nlohmann::json;

constexpr const char* kKinds[]{"begin", "hit", "end"};
constexpr const char* kParts[]{"whole", "constraint", "transient"};
constexpr const char* kOutcomes[]{"presented", "late", "dropped_late", "dropped_by_profile", "inaudible"};
constexpr const char* kReasons[]{"start", "periodic", "underflow"};

// RFC 4648, section 4.
std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? bytes[i + k] : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? letters[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace

bool Observations::is_first(std::set<std::vector<std::int64_t>>& known, std::vector<std::int64_t> key) {
  if (!known.insert(std::move(key)).second) return false;
  if (known.size() > kMaxStoredIds) known.erase(known.begin());  // the smallest id: the oldest of an incarnation
  return true;
}

sync::SenderClock* Observations::clock_of(const header_t& header, sync::HostTime arrival) {
  if (clocks_.size() >= kMaxSenders && !clocks_.contains(header.source)) return nullptr;
  sync::SenderClock& clock = clocks_.try_emplace(header.source, own_).first->second;
  clock.observe(header, arrival);
  return &clock;
}

std::vector<json> Observations::push(const contact_events_t& m) {
  std::vector<json> lines;
  for (const contact_event_t& e : m.events)
    if (is_first(events_, {e.event_id}))
      lines.push_back({{"event", std::to_string(e.event_id)},
                      {"kind", kKinds[e.kind]},
                      {"tool", e.tool},
                      {"sim_ns", e.time_ns},
                      {"speed_m_s", e.approach_speed_m_s}});
  return lines;
}

std::vector<json> Observations::push(const presented_t& m, sync::HostTime arrival) {
  std::vector<json> lines;
  const sync::SenderClock* clock = clock_of(m.header, arrival);
  if (!clock) return lines;
  for (const presentation_t& p : m.reports) {
    if (!is_first(reports_, {p.event_id, m.header.source, p.part})) continue;
    json line{{"presented", std::to_string(p.event_id)},
              {"modality", m.modality},
              {"part", kParts[p.part]},
              {"outcome", kOutcomes[p.outcome]},
              {"at_ns", nullptr},
              {"scheduled_ns", nullptr},
              {"uncertainty_ns", nullptr}};
    const auto read = [&](std::int64_t ns) { return clock->read(ns, arrival); };
    if (const auto at = read(p.presented_ns); p.presented_ns >= 0 && at.uncertainty.count() >= 0) {
      line["at_ns"] = sync::to_ns(at.time);
      line["uncertainty_ns"] = at.uncertainty.count() + p.uncertainty_ns;
    }
    if (p.scheduled_ns >= 0) line["scheduled_ns"] = sync::to_ns(read(p.scheduled_ns).time);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::optional<json> Observations::push(const media_clock_t& m, sync::HostTime arrival) {
  const sync::SenderClock* clock = clock_of(m.header, arrival);
  if (!clock) return std::nullopt;
  return json{{"medium", m.medium},
              {"index", m.index},
              {"at_ns", sync::to_ns(clock->to_host(m.host_time_ns, arrival))},
              {"reason", kReasons[m.reason]}};
}

std::optional<json> Observations::push(const game_state_t& m) {
  int filled = 0, wrong = 0;
  for (const hole_state_t& h : m.holes) filled += h.filled, wrong += h.inside >= 0 && !h.filled;
  json line{
      {"game",
       {{"won", m.won == 1}, {"won_sim_ns", m.won_ns}, {"filled", filled}, {"wrong", wrong}, {"holes", m.count}}}};
  if (std::string text = line.dump(); text == std::exchange(game_, text)) return std::nullopt;
  line["game"]["sim_ns"] = m.header.sim_time_ns;
  return line;
}

std::optional<json> Observations::push(const picture_chunk_t& m, sync::HostTime arrival) {
  const sync::SenderClock* clock = clock_of(m.header, arrival);
  auto picture = pictures_.push(m);
  if (!clock || !picture) return std::nullopt;
  json line{{"picture", picture->picture}, {"sim_ns", picture->sim_time_ns}, {"at_ns", nullptr}};
  if (picture->presented_ns >= 0) line["at_ns"] = sync::to_ns(clock->to_host(picture->presented_ns, arrival));
  line["jpeg"] = base64(picture->jpeg);
  return line;
}

std::optional<json> Observations::push(const tool_state_t& m, sync::HostTime arrival) {
  const sync::SenderClock* clock = clock_of(m.header, arrival);
  if (!clock) return std::nullopt;
  const double force_N = std::hypot(m.transient_N.x, m.transient_N.y, m.transient_N.z);
  if (std::exchange(vibrates_[m.header.source], force_N > 0) || force_N == 0) return std::nullopt;
  return json{{"pulse",
               {{"tool", m.tool},
                {"at_ns", sync::to_ns(clock->to_host(m.header.publish_time_ns, arrival))},
                {"force_N", force_N}}}};
}

}  // namespace tactus::trial_runner
