#include "visual_node/frame/head_samples.h"

#include <algorithm>

#include "lcmtypes/vectors.h"
#include "sync/resampling/pose_history.h"

namespace tactus::visual {

void HeadSamples::push(const tool_state_t& m, RoomTime sent, sync::HostTime arrival) {
  const sync::SenderStatus status = followed_.on_page(m.header, arrival);
  if (!sync::accepted(status)) return;
  if (status == sync::SenderStatus::kFirst) samples_.clear();  // another process controls the head now
  if (!samples_.empty() && sent < samples_.back().sent - kSpan) samples_.clear();  // its clock was put back
  // Messages may overtake each other.
  auto at = samples_.end();
  while (at != samples_.begin() && std::prev(at)->sent > sent) --at;
  if (at != samples_.begin() && std::prev(at)->sent == sent) return;
  samples_.insert(at, {sent,
                       m.header.publish_time_ns,
                       m.header.seq,
                       {to_eigen(m.device.position_m), to_eigen(m.device.orientation).normalized(),
                        to_eigen(m.device_velocity_m_s), to_eigen(m.device_spin_rad_s)}});
  const std::size_t max = kMax * static_cast<std::size_t>((span_ + kSpan - sync::Nanoseconds(1)) / kSpan);
  while (samples_.size() > max || samples_.front().sent < samples_.back().sent - span_) samples_.pop_front();
}

std::optional<HeadSample> HeadSamples::published_by(RoomTime t) const {
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), t,
                                      [](RoomTime x, const HeadSample& s) { return x < s.sent; });
  if (after == samples_.begin()) return std::nullopt;
  return *std::prev(after);
}

sync::Sample<sync::BodyPose> extrapolate(const HeadSample& sample, RoomTime t) {
  sync::BodyPose pose = sample.pose;
  const sync::Nanoseconds past = std::max(t - sample.sent, sync::Nanoseconds(0));
  if (past > sync::PoseHistory::kStaleAfter) return {pose, sync::SampleStatus::kStale};
  const double s = sync::to_seconds(std::min(past, kMaxHeadExtrapolation));
  pose.position += s * pose.velocity;
  if (const double angle = pose.angular_velocity.norm() * s; angle > 0)
    pose.orientation =
        (Eigen::AngleAxisd(angle, pose.angular_velocity.normalized()) * pose.orientation).normalized();
  return {pose, past == sync::Nanoseconds(0) ? sync::SampleStatus::kExact
                : past > kMaxHeadExtrapolation        ? sync::SampleStatus::kHeld
                                             : sync::SampleStatus::kExtrapolated};
}

}  // namespace tactus::visual
