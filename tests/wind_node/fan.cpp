#include "tests/wind_node/fan.h"

#include <algorithm>
#include <cmath>

#include "lcmtypes/vectors.h"
#include "tests/wind_node/air.h"

namespace tactus::wind {

Fan::Fan(const Settings& settings, const scene_t& scene, sync::OwnClock own)
    : settings_(settings),
      late_{sync::Late::kShowNewest, sync::from_seconds(settings.late_after_s),
            sync::from_seconds(settings.drop_after_s)},
      head_(to_eigen(scene.listener.position_m)),
      bodies_(own),
      contacts_(own) {
  for (const shape_def_t& shape : scene.shapes) {
    const auto body = static_cast<std::size_t>(shape.body);
    if (body >= scene.bodies.size() || scene.bodies[body].is_static) continue;
    double& radius_m = radius_m_[shape.body];
    radius_m = std::max(radius_m, equivalent_radius_m(shape, settings.mesh_radius_m));
  }
}

double Fan::wind_m_s(sync::SimTime t) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [body, radius_m] : radius_m_) {
    const auto pose = bodies_.pose(body, t);
    if (pose.status == sync::SampleStatus::kNone || pose.status == sync::SampleStatus::kStale) continue;
    sum += air_velocity_m_s(head_, pose.value.position, radius_m, pose.value.velocity);
  }
  return sum.norm();
}

void Fan::blow(const contact_event_t& hit, sync::HostTime scheduled, sync::HostTime now) {
  presentation_t r{};
  r.event_id = hit.event_id;
  r.part = presentation_t::WHOLE;
  r.scheduled_ns = sync::to_ns(scheduled);
  r.outcome = late_.outcome(now - scheduled);
  r.presented_ns = r.outcome == presentation_t::DROPPED_LATE ? -1 : sync::to_ns(now);
  // The fan takes the command at some instant of the tick.
  r.uncertainty_ns = sync::from_seconds(0.5 / settings_.rate_Hz).count();
  reports_.push_back(r);
  if (r.outcome != presentation_t::DROPPED_LATE)
    gust_ = std::min(1.0, gust_ + hit.approach_speed_m_s / settings_.full_hit_m_s);
}

FanState Fan::step(sync::HostTime now, sync::Nanoseconds delay, double response_s, const Schedule& schedule) {
  reports_.clear();
  const double dt_s = last_ ? std::max(0.0, sync::to_seconds(now - *last_)) : 0;
  last_ = now;
  gust_ *= std::exp(-dt_s / settings_.gust_time_s);
  FanState out;
  if (const auto map = contacts_.map(now)) {
    for (const contact_event_t& e : contacts_.take_events(sync::SimTime::max()))
      if (e.kind == contact_event_t::HIT)
        scheduled_.emplace(schedule(e.event_id, map->to_host(sync::sim_time(e.time_ns))), e);
    while (!scheduled_.empty() && scheduled_.begin()->first <= now) {
      blow(scheduled_.begin()->second, scheduled_.begin()->first, now);
      scheduled_.erase(scheduled_.begin());
    }
  }
  if (const auto map = bodies_.map(now)) out.wind_m_s = wind_m_s(map->to_sim(now - delay));
  out.gust = gust_;
  const double wanted = std::min(1.0, out.wind_m_s / settings_.full_wind_m_s + gust_);
  share_ += (response_s > 0 ? 1 - std::exp(-dt_s / response_s) : 1) * (wanted - share_);
  out.share = share_;
  return out;
}

}  // namespace tactus::wind
