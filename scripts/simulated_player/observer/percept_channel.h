// One sense as a channel of time-stamped percepts. A renderer presents a stimulus at an instant; the percept
// reaches the player one natural latency later. The player receives no other time: the age of a percept is a
// belief (delay_belief.h). Pure.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

namespace tactus::observer {

// A measurement by a sense. The value already has the noise of the sense; sd is the standard deviation that the
// player knows.
struct SensedValue {
  double arrival_s = 0;  // when the player can use it
  Eigen::Vector3d value{0, 0, 0};
  double sd = 0;
};

class PerceptChannel {
 public:
  // latency_s: of the person, not of the display; not negative. At most `capacity` percepts wait; the oldest is
  // dropped first.
  explicit PerceptChannel(double latency_s, std::size_t capacity = 4096)
      : latency_s_(latency_s), capacity_(capacity) {}

  // A stimulus is presented at this instant. Instants that are not finite are ignored: the stimulus is never
  // presented.
  void present(double presented_s, const Eigen::Vector3d& value, double sd);
  // The next percept that has arrived at now_s, in the order of arrival; nullopt: none.
  std::optional<SensedValue> take(double now_s);
  double latency_s() const { return latency_s_; }

 private:
  double latency_s_;
  std::size_t capacity_;
  std::deque<SensedValue> waiting_;  // by time of arrival
};

}  // namespace tactus::observer
