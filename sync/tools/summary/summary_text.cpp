#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <tactus/game_state_t.hpp>
#include <tactus/hole_state_t.hpp>

#include "sync/text/printable.h"
#include "sync/tools/summary/summary.h"
#include "sync/presentation/thresholds.h"

namespace tactus::sync {
namespace {

__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return printable(text) + "\n";
}

double us(Nanoseconds t) { return static_cast<double>(t.count()) * 1e-3; }
double ms(Nanoseconds t) { return static_cast<double>(t.count()) * 1e-6; }

// "24 of the missed in the first second of the world, 3 in the second, 2 in the third": a start that costs pictures differs from a machine that is too slow.
std::string missed_at_begin(const std::vector<std::int64_t>& by_second) {
  constexpr std::array kNames{"first second of the world", "second", "third"};
  std::string text;
  for (std::size_t i = 0; i < std::min(by_second.size(), kNames.size()); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(by_second[i]) + (i == 0 ? " of the missed in the " : " in the ") + kNames[i];
  return text;
}

std::string nodes(const RunSummary& s) {
  std::string out = line("%-14s %9s %9s %7s  %8s %8s %8s  %8s %8s %8s %s", "node", "rate/Hz", "ticks", "missed",
                         "tick p50", "p99", "max/us", "wake p50", "p99", "max/us", "restarts");
  for (const auto& [name, n] : s.nodes()) {
    out += line("%-14s %9.2f %9lld %7lld  %8.0f %8.0f %8.0f  %8.0f %8.0f %8.0f %8lld%s", name.c_str(), n.rate_Hz,
                static_cast<long long>(n.ticks), static_cast<long long>(n.missed_ticks), us(n.tick.quantile(0.5)),
                us(n.tick.quantile(0.99)), us(n.tick.max()), us(n.wake.quantile(0.5)), us(n.wake.quantile(0.99)),
                us(n.wake.max()), static_cast<long long>(n.restarts), n.alive_at_end ? "" : "  gone");
    out += line("  %.180s", n.scheduling.c_str());
    if (!n.missed_by_second.empty() && n.missed_by_second.front() > 0)
      out += line("  %s", missed_at_begin(n.missed_by_second).c_str());
    if (!n.profile_effect.empty()) out += line("  profile effect: %.180s", n.profile_effect.c_str());
  }
  return out;
}

std::string game(const RunSummary& s) {
  if (!s.game()) return "";
  const game_state_t& g = *s.game();
  const auto filled = std::count_if(g.holes.begin(), g.holes.end(), [](const hole_state_t& h) { return h.filled != 0; });
  if (!g.won) return line("game: %d of %d holes filled", static_cast<int>(filled), g.count);
  return line("game: all %d holes filled, at %.2f s of simulated time", g.count,
              static_cast<double>(g.won_ns) * 1e-9);
}

std::string contacts(const PresentationMatcher& m) {
  std::string out = line("contacts: %lld begin, %lld hit, %lld end", static_cast<long long>(m.begins()),
                         static_cast<long long>(m.hits()), static_cast<long long>(m.ends()));
  if (m.overflow() > 0)
    out += line("%lld events or senses exceed the limits of the matching", static_cast<long long>(m.overflow()));
  if (m.modalities().empty()) return out;
  out += line("%-14s %9s %9s %10s %7s %7s %7s %10s %12s", "modality", "expected", "presented", "of it late", "lost",
              "stalled", "dead", "by profile", "dropped late");
  for (const auto& [name, t] : m.modalities())
    out +=
        line("%-14s %9lld %9lld %10lld %7lld %7lld %7lld %10lld %12lld", name.c_str(),
             static_cast<long long>(t.expected), static_cast<long long>(t.presented), static_cast<long long>(t.late),
             static_cast<long long>(t.lost), static_cast<long long>(t.stalled), static_cast<long long>(t.dead),
             static_cast<long long>(t.dropped_by_profile), static_cast<long long>(t.dropped_late));
  return out;
}

std::string absent(const RunSummary& s) {
  std::string names;
  for (const std::string& name : s.absent()) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "" : line("absent: %s", names.c_str());
}

std::string asynchrony(const PresentationMatcher& m) {
  std::string out = line("%-22s %7s %8s %8s %8s %8s  %s", "asynchrony/ms", "n", "p05", "p50", "p95", "+-",
                         "beyond thresholds: least, all");
  for (const auto& [names, soa] : m.pairs()) {
    const BeyondThresholds beyond = count_beyond_thresholds(names.first, names.second, soa);
    const auto count = [](std::int64_t n) { return n < 0 ? std::string("-") : std::to_string(n); };
    out += line("%-22s %7lld %8.2f %8.2f %8.2f %8.3f  %24s, %3s", (names.first + " to " + names.second).c_str(),
                static_cast<long long>(soa.count()), ms(soa.quantile(0.05)), ms(soa.quantile(0.5)),
                ms(soa.quantile(0.95)), ms(soa.uncertainty()), count(beyond.least).c_str(), count(beyond.all).c_str());
  }
  return m.pairs().empty() ? "" : out;
}

std::string bus(const RunSummary& s) {
  std::string out = line("%-18s %10s %12s %7s", "channel", "messages", "bytes", "gaps");
  for (const auto& [name, c] : s.channels())
    out += line("%-18s %10lld %12lld %7lld%s", name.c_str(), static_cast<long long>(c.messages),
                static_cast<long long>(c.bytes), static_cast<long long>(c.gaps),
                c.bad > 0 ? ("  " + std::to_string(c.bad) + " bad").c_str() : "");
  return out;
}

}  // namespace

std::string to_text(const RunSummary& s) {
  std::string out =
      line("%s: %.1f s recorded, real-time factor %.4f, seed %lld%s%s",
           s.scene().empty() ? "scene not said" : s.scene().c_str(), s.recorded_seconds(), s.realtime_factor(),
           static_cast<long long>(s.seed()), s.git().empty() ? "" : ", git ", s.git().c_str());
  if (s.holes_seconds() > 0)
    out +=
        line("the log has a hole of %.1f s; nodes may falsely appear stalled or dead there", s.holes_seconds());
  if (s.damaged_regions() > 0)
    out += line("the log is damaged in %lld places, which are not counted", static_cast<long long>(s.damaged_regions()));
  for (const std::string& warning : s.warnings()) out += line("%.380s", warning.c_str());
  return out + "\n" + nodes(s) + "\n" + game(s) + contacts(s.matcher()) + absent(s) + "\n" + asynchrony(s.matcher()) + "\n" +
         bus(s);
}

}  // namespace tactus::sync
