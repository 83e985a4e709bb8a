#include "sync/tools/watch_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <tactus/input_health_t.hpp>
#include <tactus/modality_report_t.hpp>
#include <tactus/pair_report_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/utf8.h"
#include "sync/degradation/measured_effect.h"
#include "sync/text/printable.h"

namespace tactus::sync {
namespace {

// False for channels with sporadic messages, which may be old without harm.
bool flows(const std::string& channel) {
  static constexpr std::array<const char*, 10> sporadic = {
      channels::kContactEvents, channels::kPresented,  channels::kSceneManifest, channels::kAssetRequest,
      channels::kAssetChunk,    channels::kMediaClock, channels::kLogInfo,
      channels::kClockMap,      channels::kPlayout,    channels::kDegradation};
  return std::find(sporadic.begin(), sporadic.end(), channel) == sporadic.end();
}

std::string state_name(std::int8_t state) {
  switch (state) {
    case node_health_t::WAITING: return "waiting";
    case node_health_t::RUNNING: return "running";
    case node_health_t::STALE: return "stale";
    case node_health_t::INPUT_LOST: return "input lost";
    case node_health_t::OUTPUT_LOST: return "output lost";
    case node_health_t::READY: return "ready";
    default: return "?";
  }
}

std::string duration(Nanoseconds t) {
  if (t < Nanoseconds(0)) return "-";
  char text[32];
  const double ms = static_cast<double>(t.count()) * 1e-6;
  std::snprintf(text, sizeof text, ms < 10 ? "%.1f ms" : ms < 1000 ? "%.0f ms" : "%.3g s", ms < 1000 ? ms : ms * 1e-3);
  return text;
}

// Never rounded down.
std::string uncertainty(Nanoseconds t) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f ms", std::ceil(static_cast<double>(t.count()) * 1e-4) * 1e-2);
  return text;
}

// One line for the terminal, without control characters.
std::string cut(const std::string& raw, std::size_t width) {
  std::string text = printable(raw);
  text = std::string(first_characters(text, width));
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text + "\n";
}

// Note for a modality that renders at reduced quality.
std::string quality_text(const node_health_t& h) {
  return h.quality > 0 ? "quality step " + std::to_string(h.quality) + " of " + std::to_string(h.qualities - 1) + "; " : "";
}

}  // namespace

void WatchTable::observe(const node_health_t& m, HostTime arrival) {
  if (nodes_.size() < 64 || nodes_.contains(m.node)) nodes_[m.node] = {m, arrival};
}

std::vector<WatchTable::Row> WatchTable::rows(HostTime now) const {
  std::vector<Row> out;
  for (const auto& [name, node] : nodes_) {
    const node_health_t& h = node.health;
    const Nanoseconds silence = now - node.arrival;
    const bool lost = silence > kLostAfter;
    Row row{name, lost ? "LOST" : state_name(h.state), lost ? 0 : h.rate_Hz, h.missed_ticks, Nanoseconds(-1), "",
            h.contacts_rendered, lost ? "silent for " + duration(silence) : quality_text(h) + without_effect(h.status_text),
            lost ? "" : effect_in(h.status_text)};
    for (const input_health_t& in : h.inputs) {
      if (!flows(in.channel) || Nanoseconds(in.age_ns) <= row.input_age) continue;
      row.input_age = Nanoseconds(in.age_ns);
      row.oldest_input = in.channel;
    }
    out.push_back(std::move(row));
  }
  return out;
}

std::string WatchTable::to_text(HostTime now, std::size_t width) const {
  char text[512];
  std::snprintf(text, sizeof text, "%-14s %-11s %9s %8s %-22s %8s  %s", "node", "state", "rate/Hz", "missed",
                "oldest input", "contacts", "note");
  std::string out = cut(text, width);
  for (const Row& r : rows(now)) {
    const std::string age = duration(r.input_age) + (r.oldest_input.empty() ? "" : " " + r.oldest_input);
    std::snprintf(text, sizeof text, "%-14.14s %-11s %9.1f %8lld %-22.22s %8lld  %.150s", r.node.c_str(),
                  r.state.c_str(), r.rate_Hz, static_cast<long long>(r.missed_ticks), age.c_str(),
                  static_cast<long long>(r.rendered), r.status_text.c_str());
    out += cut(text, width);
    if (!r.profile_effect.empty()) out += cut("  profile effect: " + r.profile_effect, width);
  }
  if (nodes_.empty()) out += "no node has reported yet\n";
  if (report_) {
    std::string line = "events " + std::to_string(report_->begins) + " begin " + std::to_string(report_->hits) + " hit " +
                       std::to_string(report_->ends) + " end";
    for (const modality_report_t& m : report_->modalities)
      line += " | " + m.modality + " " + std::to_string(m.presented) + "/" + std::to_string(m.expected) +
              (m.lost > 0 ? " LOST " + std::to_string(m.lost) : "");
    for (const pair_report_t& p : report_->pairs)
      line += " | " + p.a + " to " + p.b + (p.p50_ns < 0 ? " -" : " ") + duration(Nanoseconds(std::abs(p.p50_ns))) +
              " +-" + uncertainty(Nanoseconds(p.uncertainty_ns));
    out += cut(line, 2 * width);
  }
  return out;
}

std::string WatchTable::to_json(HostTime now) const {
  using Json = nlohmann::ordered_json;
  Json nodes = Json::object(), modalities = Json::object(), pairs = Json::object();
  for (const Row& r : rows(now))
    nodes[r.node] = {{"state", r.state}, {"rate_hz", r.rate_Hz}, {"missed_ticks", r.missed_ticks},
                     {"input_age_ms", r.input_age < Nanoseconds(0) ? Json() : Json(static_cast<double>(r.input_age.count()) * 1e-6)},
                     {"oldest_input", r.oldest_input}, {"contacts_rendered", r.rendered}, {"note", r.status_text},
                     {"profile_effect", r.profile_effect}};
  Json out = {{"host_s", to_seconds(now.time_since_epoch())}, {"nodes", nodes}};
  if (report_) {
    for (const modality_report_t& m : report_->modalities)
      modalities[m.modality] = {{"expected", m.expected}, {"presented", m.presented}, {"lost", m.lost}, {"stalled", m.stalled},
                                {"dead", m.dead}, {"dropped_by_profile", m.dropped_by_profile},
                                {"dropped_late", m.dropped_late}};
    for (const pair_report_t& p : report_->pairs)
      pairs[p.a + "_" + p.b] = {{"n", p.n}, {"p05_ms", static_cast<double>(p.p05_ns) * 1e-6},
                                {"p50_ms", static_cast<double>(p.p50_ns) * 1e-6},
                                {"p95_ms", static_cast<double>(p.p95_ns) * 1e-6},
                                {"uncertainty_ms", static_cast<double>(p.uncertainty_ns) * 1e-6}};
    out["begin"] = report_->begins;
    out["hit"] = report_->hits;
    out["end"] = report_->ends;
    out["modalities"] = modalities;
    out["asynchrony"] = pairs;
  }
  return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tactus::sync
