#include "sync/degradation/measured_effect.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tactus::sync {
namespace {

std::string formatted(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

double percent(std::int64_t part, std::int64_t all) {
  return all > 0 ? 100 * static_cast<double>(part) / static_cast<double>(all) : 0;
}

std::string text_of(const EffectFigures& f, const char* what, bool with_rate) {
  if (f.items == 0) return "";
  std::string text = what;
  if (f.delivered == 0) text += " none delivered";
  if (f.delivered > 0) text += formatted(" %+.1f ms", f.mean_delay_s * 1e3) + formatted(" (sd %.1f)", f.sd_delay_s * 1e3);
  if (f.lost > 0) text += formatted(", %.1f %% lost", percent(f.lost, f.items)) + formatted(" in bursts of %.1f", f.mean_burst());
  if (f.overtaken > 0) text += formatted(", %.1f %% overtaken", percent(f.overtaken, f.items));
  if (f.repeated > 0) text += formatted(", %.1f %% twice", percent(f.repeated, f.items));
  if (f.suppressed > 0) text += ", " + std::to_string(f.sent()) + " of " + std::to_string(f.items) + " sent";
  if (with_rate && f.rate_Hz > 0) text += formatted(", %.1f/s", f.rate_Hz);
  return text;
}

}  // namespace

std::string without_effect(const std::string& status_text) { return status_text.substr(0, status_text.find(kEffectPrefix)); }

std::string effect_in(const std::string& status_text) {
  const std::size_t at = status_text.find(kEffectPrefix);
  return at == std::string::npos ? "" : status_text.substr(at + kEffectPrefix.size());
}

void MeasuredEffect::add(const DecisionRecord& record, Nanoseconds presentation_delay) {
  const std::uint64_t id = record.is_event ? 0 : record.stream;
  if (!record.decision.evaluated && presentation_delay == Nanoseconds(0)) return;
  if (streams_.size() >= kMaxStreams && !streams_.contains(id)) return;
  const auto [at, is_new] = streams_.try_emplace(id);
  Stream& s = at->second;
  const Decision& d = record.decision;
  const double delay_s = to_seconds(d.release - record.arrival + d.shift + presentation_delay);
  if (is_new) s.reference_s = delay_s, s.first = record.arrival;
  const double x = delay_s - s.reference_s;
  if (d.why == DropReason::kOvertaken) {  // counted as delivered when it was decided
    ++s.counts.overtaken, --s.counts.delivered;
    s.sum_s -= x, s.sum_square_s2 -= x * x;
    return;
  }
  s.last = std::max(s.last, record.arrival);
  ++s.counts.items;
  const bool lost = d.why == DropReason::kLoss;
  s.counts.lost += lost;
  s.counts.bursts += lost && !s.in_burst;
  // An item that a rate or a deadband drops before the loss does not end a burst.
  if (lost || d.why == DropReason::kKept) s.in_burst = lost;
  s.counts.thinned += d.why == DropReason::kRate || d.why == DropReason::kDeadband;
  s.counts.suppressed += d.why == DropReason::kDeadband;
  s.counts.off += d.why == DropReason::kOff || d.why == DropReason::kFreeze;
  if (d.dropped()) return;
  ++s.counts.delivered;
  s.counts.repeated += d.duplicated;
  s.sum_s += x, s.sum_square_s2 += x * x;
}

EffectFigures MeasuredEffect::figures(bool events) const {
  EffectFigures all;
  double sum_s = 0, square_s2 = 0;
  for (const auto& [id, s] : streams_) {
    if ((id == 0) != events) continue;
    const EffectFigures& c = s.counts;
    all.items += c.items, all.delivered += c.delivered, all.lost += c.lost, all.bursts += c.bursts;
    all.thinned += c.thinned, all.suppressed += c.suppressed, all.off += c.off, all.overtaken += c.overtaken, all.repeated += c.repeated;
    const double n = static_cast<double>(c.delivered);
    sum_s += s.sum_s + n * s.reference_s;
    square_s2 += s.sum_square_s2 + 2 * s.reference_s * s.sum_s + n * s.reference_s * s.reference_s;
    if (c.items > 1 && s.last > s.first)
      all.rate_Hz = std::max(all.rate_Hz, n * (1 - 1 / static_cast<double>(c.items)) / to_seconds(s.last - s.first));
  }
  if (all.delivered > 0) {
    all.mean_delay_s = sum_s / static_cast<double>(all.delivered);
    all.sd_delay_s = std::sqrt(std::max(0.0, square_s2 / static_cast<double>(all.delivered) - all.mean_delay_s * all.mean_delay_s));
  }
  return all;
}

std::string MeasuredEffect::text() const {
  std::string text = text_of(events(), "events", false);
  const std::string state = text_of(snapshots(), "state", true);
  if (!text.empty() && !state.empty()) text += "; ";
  text += state;
  if (wire_messages_ > 0)
    text += (text.empty() ? "" : "; ") + formatted("%.1f %% of the messages lost on the wire", percent(wire_lost_, wire_messages_));
  if (text.size() > kMaxText) text.replace(kMaxText - 3, std::string::npos, "...");
  return text;
}

}  // namespace tactus::sync
