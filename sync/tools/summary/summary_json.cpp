#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <tactus/game_state_t.hpp>
#include <tactus/hole_state_t.hpp>

#include "sync/degradation/known_modalities.h"
#include "sync/tools/summary/summary.h"
#include "sync/presentation/thresholds.h"

namespace tactus::sync {
namespace {

using Json = nlohmann::ordered_json;

// Rounds figures to their significant digits.
double rounded(double x, double per_unit) { return std::round(x * per_unit) / per_unit; }
double rounded_us(Nanoseconds t) { return rounded(static_cast<double>(t.count()) * 1e-3, 10); }
double rounded_ms(Nanoseconds t) { return rounded(static_cast<double>(t.count()) * 1e-6, 100); }

// An uncertainty is never rounded down.
double ms_up(Nanoseconds t) { return std::ceil(static_cast<double>(t.count()) * 1e-4) * 1e-2; }

Json quantiles(const Histogram& h) {
  return {{"p50", rounded_us(h.quantile(0.5))},
          {"p99", rounded_us(h.quantile(0.99))},
          {"p999", rounded_us(h.quantile(0.999))},
          {"max", rounded_us(h.max())}};
}

Json json_of_nodes(const RunSummary& s) {
  Json out = Json::object();
  for (const auto& [name, n] : s.nodes()) {
    Json ages = Json::object();
    for (const auto& [channel, age] : n.input_age) ages[channel] = {{"p50", rounded_ms(age.quantile(0.5))}, {"p99", rounded_ms(age.quantile(0.99))}};
    Json quality = nullptr;
    if (!n.quality.empty()) {
      const auto reports = static_cast<double>(std::accumulate(n.quality.begin(), n.quality.end(), std::int64_t{0}));
      quality = Json::array();
      for (const std::int64_t at : n.quality) quality.push_back(rounded(static_cast<double>(at) / reports, 1000));
    }
    out[name] = {{"rate_hz", rounded(n.rate_Hz, 1000)},
                 {"ticks", n.ticks},
                 {"missed_ticks", n.missed_ticks},
                 {"missed_first_second", n.missed_by_second.empty() ? Json(nullptr) : Json(n.missed_by_second.front())},
                 {"missed_by_second", n.missed_by_second},
                 {"stale_ticks", n.stale_ticks},
                 {"tick_us", quantiles(n.tick)},
                 {"wake_us", quantiles(n.wake)},
                 {"input_age_ms", ages},
                 {"quality", quality},
                 {"restarts", n.restarts},
                 {"scheduling", n.scheduling},
                 {"profile_effect", n.profile_effect}};
  }
  return out;
}

// The known modalities are always present, so that a reader of the file does not have to check.
std::vector<std::string> senses(const PresentationMatcher& m) {
  std::set<std::string> names;
  for (const KnownModality& known : known_modalities()) names.insert(known.name);
  for (const auto& [name, tally] : m.modalities()) names.insert(name);
  std::vector<std::string> out(names.begin(), names.end());
  std::sort(out.begin(), out.end(), named_before);
  return out;
}

Json json_of_game(const RunSummary& s) {
  if (!s.game()) return nullptr;
  const game_state_t& g = *s.game();
  const auto filled = std::count_if(g.holes.begin(), g.holes.end(), [](const hole_state_t& h) { return h.filled != 0; });
  Json won_at = nullptr;
  if (g.won) won_at = rounded(static_cast<double>(g.won_ns) * 1e-9, 1000);
  return {{"holes", g.count}, {"filled", filled}, {"won_at_s", won_at}};
}

Json json_of_contacts(const PresentationMatcher& m) {
  Json presented = Json::object(), by_modality = Json::object();
  OutcomeCounts sum;
  for (const std::string& name : senses(m)) {
    const auto it = m.modalities().find(name);
    const OutcomeCounts t = it == m.modalities().end() ? OutcomeCounts{} : it->second;
    presented[name] = t.presented;
    by_modality[name] = {{"expected", t.expected},
                         {"presented", t.presented},
                         {"late", t.late},
                         {"lost", t.lost},
                         {"stalled", t.stalled},
                         {"dead", t.dead},
                         {"dropped_by_profile", t.dropped_by_profile},
                         {"dropped_late", t.dropped_late}};
    sum.late += t.late;
    sum.lost += t.lost;
    sum.stalled += t.stalled;
    sum.dead += t.dead;
    sum.dropped_by_profile += t.dropped_by_profile;
    sum.dropped_late += t.dropped_late;
  }
  return {{"begin", m.begins()},
          {"hit", m.hits()},
          {"end", m.ends()},
          {"presented", presented},
          {"late", sum.late},
          {"lost", sum.lost},
          {"overflow", m.overflow()},
          {"stalled", sum.stalled},
          {"dropped_by_profile", sum.dropped_by_profile},
          {"dead", sum.dead},
          {"dropped_late", sum.dropped_late},
          {"by_modality", by_modality}};
}

Json json_of_asynchrony(const PresentationMatcher& m) {
  const Json none = {{"n", 0}, {"p05", nullptr}, {"p50", nullptr}, {"p95", nullptr}, {"uncertainty", nullptr},
                     {"beyond_least_threshold", nullptr}, {"beyond_all_thresholds", nullptr}};
  // Pairs of known modalities that are not slow are always present.
  Json out = Json::object();
  const auto& known = known_modalities();
  for (auto a = known.begin(); a != known.end(); ++a)
    for (auto b = a + 1; b != known.end(); ++b)
      if (a->kind != PlayoutKind::kSlow && b->kind != PlayoutKind::kSlow) out[a->name + "_" + b->name] = none;
  for (const auto& [names, soa] : m.pairs()) {
    const BeyondThresholds beyond = count_beyond_thresholds(names.first, names.second, soa);
    const auto count = [](std::int64_t n) { return n < 0 ? Json(nullptr) : Json(n); };
    out[names.first + "_" + names.second] = {{"n", soa.count()},
                                             {"p05", rounded_ms(soa.quantile(0.05))},
                                             {"p50", rounded_ms(soa.quantile(0.5))},
                                             {"p95", rounded_ms(soa.quantile(0.95))},
                                             {"uncertainty", ms_up(soa.uncertainty())},
                                             {"beyond_least_threshold", count(beyond.least)},
                                             {"beyond_all_thresholds", count(beyond.all)}};
  }
  return out;
}

}  // namespace

std::string to_json(const RunSummary& s) {
  Json bus = Json::object();
  for (const auto& [name, c] : s.channels())
    bus[name] = {{"messages", c.messages}, {"bytes", c.bytes}, {"gaps", c.gaps}};
  const Json out = {{"scene", s.scene()},
                    {"seconds", rounded(s.seconds(), 1000)},
                    {"recorded_seconds", rounded(s.recorded_seconds(), 1000)},
                    {"log_holes_seconds", rounded(s.holes_seconds(), 1000)},
                    {"seed", s.seed()},
                    {"git", s.git()},
                    {"realtime_factor", rounded(s.realtime_factor(), 1e6)},
                    {"warnings", s.warnings()},
                    {"damage", s.damage()},
                    {"absent", s.absent()},
                    {"nodes", json_of_nodes(s)},
                    {"game", json_of_game(s)},
                    {"contacts", json_of_contacts(s.matcher())},
                    {"asynchrony_ms", json_of_asynchrony(s.matcher())},
                    {"bus", bus}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tactus::sync
