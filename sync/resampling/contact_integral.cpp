// Integrals of contact over a tick, for slow modalities.
#include <algorithm>
#include <map>
#include <tactus/contact_t.hpp>

#include "sync/resampling/contact_stream.h"

namespace tactus::sync {
namespace {

struct Interval {
  SimTime begin, end;
};

// Length of the union of the intervals.
Nanoseconds covered(std::vector<Interval> intervals) {
  std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  Nanoseconds sum{0};
  SimTime reached = SimTime::min();
  for (const Interval& i : intervals) {
    const SimTime begin = std::max(i.begin, reached);
    if (i.end > begin) sum += i.end - begin;
    reached = std::max(reached, i.end);
  }
  return sum;
}

struct Sum {
  Nanoseconds time{0};
  std::int32_t body = -1, material = -1;
};

// The sums of one body, over all its contacts.
struct PartSum {
  std::vector<Interval> touching;
  double force_N = 0, area_m2 = 0;
};
using Parts = std::map<std::pair<std::int32_t, std::int32_t>, PartSum>;

std::vector<ContactPart> finished(Parts& parts) {
  std::vector<ContactPart> result;
  for (auto& [key, part] : parts)
    result.push_back({key.first, key.second, covered(std::move(part.touching)), part.force_N, part.area_m2});
  return result;
}

// The body and material of the side that is not the tool. Without the tool's body id: side a, since tools are the last bodies
// of a scene.
template <class Contact>
std::pair<std::int32_t, std::int32_t> other_side(const Contact& c, int tool_body) {
  return c.body_a == tool_body ? std::pair{c.body_b, c.material_b} : std::pair{c.body_a, c.material_a};
}

}  // namespace

ContactIntegral ContactStream::integral(SimTime t0, SimTime t1, int tool, int tool_body) {
  follow_events();
  ContactIntegral result;
  if (t1 <= t0) return result;
  const auto& group = snapshots_[0];
  result.status = status(group, t1 - Nanoseconds(1));
  const double length_s = to_seconds(t1 - t0);
  std::vector<Interval> touching;
  std::map<std::int64_t, Sum> sums;
  Parts parts;

  const auto add = [&](const contact_t& c, SimTime begin, SimTime end) {
    const ContactSpan* span = events_.span_of(c.contact_id);
    if (span && span->begin) begin = std::max(begin, sim_time(span->begin->time_ns));
    if (span && span->end) end = std::min(end, *span->end);
    begin = std::max(begin, t0);
    end = std::min(end, t1);
    if (c.tool != tool || end <= begin) return;
    const double force_N = c.normal_force_N * to_seconds(end - begin) / length_s;
    const double area_m2 = c.area_m2 * to_seconds(end - begin) / length_s;
    result.force_N += force_N;
    result.area_m2 += area_m2;
    touching.push_back({begin, end});
    Sum& sum = sums[c.contact_id];
    sum.time += end - begin;
    std::tie(sum.body, sum.material) = other_side(c, tool_body);
    PartSum& part = parts[{sum.body, sum.material}];
    part.force_N += force_N;
    part.area_m2 += area_m2;
    part.touching.push_back({begin, end});
  };

  // Starts at the last snapshot before the interval; snapshots after the interval are not needed.
  const auto first = std::upper_bound(group.begin(), group.end(), t0, [](SimTime t, const auto& s) { return t < s.time; });
  for (std::size_t i = first == group.begin() ? 0 : static_cast<std::size_t>(first - group.begin()) - 1;
       i < group.size() && group[i].time < t1; ++i) {
    const bool last = i + 1 == group.size();
    const SimTime until = last ? group[i].time + kStaleAfter : group[i + 1].time;
    for (const contact_t& c : group[i].contacts) add(c, group[i].time, until);
    if (last) break;
    // A contact that appears first in the next snapshot began in between.
    for (const contact_t& c : group[i + 1].contacts) {
      const auto& now = group[i].contacts;
      const bool was_there = std::any_of(now.begin(), now.end(), [&](const contact_t& x) { return x.contact_id == c.contact_id; });
      const ContactSpan* span = events_.span_of(c.contact_id);
      if (!was_there && span && span->begin) add(c, group[i].time, group[i + 1].time);
    }
  }

  // Contacts that began and ended between two snapshots are known from their events alone. Their force follows from the
  // momentum that a plastic impact exchanges, m v, spread over the tick; their area is not known.
  for (const auto& [id, span] : events_.spans()) {
    if (!span.begin || !span.end || span.begin->tool != tool || sums.contains(id)) continue;
    const SimTime begin = std::max(t0, sim_time(span.begin->time_ns)), end = std::min(t1, *span.end);
    if (end <= begin) continue;
    const bool began_in_tick = sim_time(span.begin->time_ns) >= t0;
    const double force_N = began_in_tick ? span.begin->effective_mass_kg * span.begin->approach_speed_m_s / length_s : 0;
    result.force_N += force_N;
    touching.push_back({begin, end});
    Sum& sum = sums[id];
    sum.time = end - begin;
    std::tie(sum.body, sum.material) = other_side(*span.begin, tool_body);
    PartSum& part = parts[{sum.body, sum.material}];
    part.force_N += force_N;
    part.touching.push_back({begin, end});
  }

  result.contact_time = covered(std::move(touching));
  result.parts = finished(parts);
  const auto longest = std::max_element(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.second.time < b.second.time; });
  if (longest != sums.end()) {
    result.body = longest->second.body;
    result.material = longest->second.material;
  }
  return result;
}

}  // namespace tactus::sync
