// The sense of wind: bodies and hits in, the speed of a fan and reports of presentation out. Pure.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <vector>

#include "sync/resampling/body_history.h"
#include "sync/resampling/contact_stream.h"
#include "sync/presentation/late.h"
#include "wind_node/settings.gen.h"

namespace tactus::wind {

struct FanState {
  double wind_m_s = 0;  // of the air that the bodies move past the head
  double gust = 0;      // of the hits, 0 .. 1
  double share = 0;     // of the fan's full speed, 0 .. 1
};

class Fan {
 public:
  // When an event that happened then is to be presented.
  using Schedule = std::function<sync::HostTime(std::int64_t event_id, sync::HostTime happened)>;

  Fan(const Settings& settings, const scene_t& scene, sync::OwnClock own);

  void push(const world_state_t& m, sync::HostTime arrival) { bodies_.push(m, arrival); }
  void push(const contact_events_t& m, sync::HostTime arrival) { contacts_.push(m, arrival); }

  // The command of the tick that begins now. delay: what blows happened so long ago; response_s: time constant of
  // a fan that is made slow on purpose.
  FanState step(sync::HostTime now, sync::Nanoseconds delay, double response_s, const Schedule& schedule);
  // What became of the hits that were due in the last step, each exactly once.
  const std::vector<presentation_t>& reports() const { return reports_; }

 private:
  void blow(const contact_event_t& hit, sync::HostTime scheduled, sync::HostTime now);
  double wind_m_s(sync::SimTime t) const;

  Settings settings_;
  sync::LatePolicy late_;
  Eigen::Vector3d head_;
  std::map<int, double> radius_m_;  // of the bodies that move
  sync::BodyHistory bodies_;
  sync::ContactStream contacts_;
  std::multimap<sync::HostTime, contact_event_t> scheduled_;
  std::optional<sync::HostTime> last_;
  double gust_ = 0, share_ = 0;
  std::vector<presentation_t> reports_;
};

}  // namespace tactus::wind
