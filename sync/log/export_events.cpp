#include "sync/log/export_events.h"

#include <array>
#include <sstream>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/sim_clock_t.hpp>

#include "sync/text/csv.h"
#include "sync/time/time.h"

namespace tactus::sync {
namespace {

template <std::size_t N>
const char* name_of(const std::array<const char*, N>& names, int value) {
  return value >= 0 && static_cast<std::size_t>(value) < N ? names[static_cast<std::size_t>(value)] : "unknown";
}

constexpr std::array kKinds{"begin", "hit", "end"};
constexpr std::array kParts{"whole", "constraint", "transient"};
constexpr std::array kOutcomes{"presented", "late", "dropped_late", "dropped_by_profile", "inaudible"};
constexpr std::array kReasons{"start", "periodic", "underflow"};
constexpr std::array kStages{"ready", "shown"};

// A text is one cell; numbers and names of kinds are written as they are.
std::string escaped_cell(const std::string& text) { return csv_cell(text); }
template <class Other>
const Other& escaped_cell(const Other& value) {
  return value;
}

template <class First, class... Rest>
std::string row(const First& first, const Rest&... rest) {
  std::ostringstream line;
  line << escaped_cell(first);
  ((line << ',' << escaped_cell(rest)), ...);
  line << '\n';
  return line.str();
}

}  // namespace

std::string events_csv_names() {
  return "event_id,contact_id,kind,sim_ns,host_ns,body_a,body_b,material_a,material_b,tool,x_m,y_m,z_m,"
         "approach_speed_m_s,effective_mass_kg,run\n";
}

std::string csv_row(const contact_event_t& e, const sim_clock_t& clock, int run) {
  const TimeMap map{sim_time(clock.sim_ns), host_time(clock.host_ns), clock.rate};
  return row(e.event_id, e.contact_id, name_of(kKinds, e.kind), e.time_ns, to_ns(map.to_host(sim_time(e.time_ns))), e.body_a,
             e.body_b, e.material_a, e.material_b, e.tool, e.point_m.x, e.point_m.y, e.point_m.z, e.approach_speed_m_s,
             e.effective_mass_kg, run);
}

std::string presented_csv_names() { return "modality,event_id,part,scheduled_ns,presented_ns,uncertainty_ns,outcome,run\n"; }

std::string csv_row(const std::string& modality, const presentation_t& p, int run) {
  return row(modality, p.event_id, name_of(kParts, p.part), p.scheduled_ns, p.presented_ns, p.uncertainty_ns,
             name_of(kOutcomes, p.outcome), run);
}

std::string media_clock_csv_names() { return "medium,index,host_ns,reason,run\n"; }

std::string csv_row(const media_clock_t& m, int run) {
  return row(m.medium, m.index, m.host_time_ns, name_of(kReasons, m.reason), run);
}

std::string clock_map_csv_names() {
  return "of_clock,to_clock,at_ns,offset_ns,drift,uncertainty_ns,uncertainty_drift,epoch,round_trip_ns,replies,run\n";
}

std::string csv_row(const clock_map_t& m, int run) {
  return row(m.of_clock, m.to_clock, m.at_ns, m.offset_ns, m.drift, m.uncertainty_ns, m.uncertainty_drift, m.epoch,
             m.round_trip_ns, m.replies, run);
}

std::string frame_shown_csv_names() { return "node,incarnation,clock,stage,frame,due_ns,sim_ns,head_ns,publish_ns,run\n"; }

std::string csv_row(const std::string& name, const frame_shown_t& m, int run) {
  return row(name, m.header.incarnation, m.header.clock, name_of(kStages, m.stage), m.frame, m.due_ns, m.header.sim_time_ns,
             m.head_ns, m.header.publish_time_ns, run);
}

}  // namespace tactus::sync
