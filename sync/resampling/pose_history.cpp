#include "sync/resampling/pose_history.h"

#include <algorithm>

#include "lcmtypes/vectors.h"

namespace tactus::sync {
namespace {

Eigen::Quaterniond rotated(const Eigen::Quaterniond& from, const Eigen::Vector3d& spin_rad_s, double s) {
  const double angle = spin_rad_s.norm() * s;
  if (angle == 0) return from;
  return (Eigen::AngleAxisd(angle, spin_rad_s.normalized()) * from).normalized();
}

}  // namespace

void PoseHistory::push(const tool_state_t& m, HostTime arrival) {
  const SenderStatus status = followed_.on_page(m.header, arrival);
  if (!accepted(status)) return;
  if (status == SenderStatus::kFirst) {  // another process controls the tool now; earlier reports are void
    sender_ = SenderClock(own_);
    samples_.clear();
  }
  sender_.observe(m.header, arrival);
  // The device was read before the report arrived.
  const HostTime time = std::min(sender_.to_host(m.header.publish_time_ns, arrival), arrival);
  // A log that is replayed from its start begins before the stored reports: they are void.
  if (!samples_.empty() && time < samples_.back().time - kSpan) samples_.clear();
  if (!samples_.empty() && time <= samples_.back().time) return;
  samples_.push_back({time,
                      {to_eigen(m.device.position_m), to_eigen(m.device.orientation).normalized(),
                       to_eigen(m.device_velocity_m_s), to_eigen(m.device_spin_rad_s)}});
  const std::size_t max_samples = kMaxSamples * static_cast<std::size_t>(1 + span_ / kSpan);
  while (samples_.size() > max_samples || samples_.front().time < time - span_) samples_.pop_front();
}

Sample<BodyPose> PoseHistory::at(HostTime t) const {
  if (samples_.empty()) return {};
  const TimedPose& newest = samples_.back();
  if (t >= newest.time) {
    BodyPose pose = newest.pose;
    const Nanoseconds past = t - newest.time;
    if (past > kStaleAfter) return {pose, SampleStatus::kStale};
    const double s = to_seconds(std::min(past, kMaxExtrapolation));
    pose.position += s * pose.velocity;
    pose.orientation = rotated(pose.orientation, pose.angular_velocity, s);
    return {pose, past == Nanoseconds(0)      ? SampleStatus::kExact
                  : past > kMaxExtrapolation ? SampleStatus::kHeld
                                              : SampleStatus::kExtrapolated};
  }
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), t,
                                      [](HostTime time, const TimedPose& s) { return time < s.time; });
  if (after == samples_.begin()) return {samples_.front().pose, SampleStatus::kHeld};
  const TimedPose &a = *std::prev(after), &b = *after;
  if (a.time == t) return {a.pose, SampleStatus::kExact};
  const double s = to_seconds(t - a.time) / to_seconds(b.time - a.time);
  return {
      {a.pose.position + s * (b.pose.position - a.pose.position), a.pose.orientation.slerp(s, b.pose.orientation),
       a.pose.velocity + s * (b.pose.velocity - a.pose.velocity),
       a.pose.angular_velocity + s * (b.pose.angular_velocity - a.pose.angular_velocity)},
      SampleStatus::kInterpolated};
}

}  // namespace tactus::sync
