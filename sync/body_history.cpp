#include "sync/body_history.h"

#include <algorithm>

#include "lcmtypes/vectors.h"

namespace tactus::sync {
namespace {

// Cubic Hermite between two samples with their velocities; SLERP for the orientation, short way round.
BodyPose between(const BodyPose& a, const BodyPose& b, double span_s, double s) {
  const double s2 = s * s, s3 = s2 * s;
  BodyPose p;
  p.position = (2 * s3 - 3 * s2 + 1) * a.position + (s3 - 2 * s2 + s) * span_s * a.velocity +
               (3 * s2 - 2 * s3) * b.position + (s3 - s2) * span_s * b.velocity;
  p.orientation = a.orientation.slerp(s, b.orientation);
  p.velocity = (1 - s) * a.velocity + s * b.velocity;
  p.angular_velocity = (1 - s) * a.angular_velocity + s * b.angular_velocity;
  return p;
}

BodyPose moved_on(BodyPose p, double dt_s) {
  p.position += p.velocity * dt_s;
  const double angle = p.angular_velocity.norm() * dt_s;
  if (angle > 0) p.orientation = Eigen::AngleAxisd(angle, p.angular_velocity.normalized()) * p.orientation;
  return p;
}

BodyPose from_message(const body_state_t& b) {
  return {to_eigen(b.position_m), to_eigen(b.orientation).normalized(), to_eigen(b.velocity_m_s),
          to_eigen(b.angular_velocity_rad_s)};
}

How past(Nanoseconds newest) {
  return newest <= BodyHistory::kExtrapolateAtMost ? How::kExtrapolated
         : newest <= BodyHistory::kStaleAfter      ? How::kHeld
                                                   : How::kStale;
}

}  // namespace

void BodyHistory::push(const world_state_t& page, HostTime arrival) {
  switch (follower_.follow(page.header, page.clock, arrival)) {
    case Follow::kIgnore: return;
    case Follow::kRestart:
      bodies_.clear();
      samples_kept_ = 0;
      newest_.reset();
      break;
    case Follow::kSame: break;
  }
  const SimTime time = sim_time(page.header.sim_time_ns), latest = follower_.latest_credible();
  if (newest_ && *newest_ > latest) forget_after(latest);
  if (time > latest) {
    ++refused_;
    return;
  }
  if (!newest_ || time > *newest_) newest_ = time;
  for (const body_state_t& b : page.bodies) {
    if (b.body >= kMaxBodies) {
      ++refused_;
      continue;
    }
    auto& samples = bodies_[b.body];
    // Pages may overtake each other: keep the samples in order of time, one per instant.
    auto at =
        std::find_if(samples.rbegin(), samples.rend(), [&](const Stamped& s) { return s.time <= time; }).base();
    if (at != samples.begin() && std::prev(at)->time == time) continue;
    samples.insert(at, {time, from_message(b)});
    ++samples_kept_;
    if (samples.size() <= 2) continue;
    const bool young = samples.size() <= kSamplesPerBody || samples.back().time - samples.front().time <= span_;
    if (young && samples_kept_ <= kMaxSamples) continue;
    samples.pop_front();
    --samples_kept_;
  }
}

// What was credible once need not be any more: its message may have been the first of all, and false.
void BodyHistory::forget_after(SimTime latest) {
  newest_.reset();
  for (auto& [body, samples] : bodies_) {
    for (; !samples.empty() && samples.back().time > latest; --samples_kept_) samples.pop_back();
    if (!samples.empty() && (!newest_ || samples.back().time > *newest_)) newest_ = samples.back().time;
  }
}

How BodyHistory::how(SimTime t) const {
  if (!newest_) return How::kNone;
  return t <= *newest_ ? How::kInterpolated : past(t - *newest_);
}

Sample<BodyPose> BodyHistory::pose(int body, SimTime t) const {
  const auto it = bodies_.find(body);
  if (it == bodies_.end() || it->second.empty()) return {};
  const auto& samples = it->second;
  const auto after = std::find_if(samples.begin(), samples.end(), [&](const Stamped& s) { return s.time > t; });
  if (after == samples.begin()) return {after->pose, How::kHeld};  // older than all that is kept
  const Stamped& before = *std::prev(after);
  if (before.time == t) return {before.pose, How::kExact};
  if (after != samples.end()) {
    const double span_s = to_seconds(after->time - before.time), s = to_seconds(t - before.time) / span_s;
    return {between(before.pose, after->pose, span_s, s), How::kInterpolated};
  }
  const double dt_s = to_seconds(std::min(t - before.time, Nanoseconds(kExtrapolateAtMost)));
  // At rest it is left out, and well known. One that was moving is missing: its page was lost.
  const bool rests =
      before.pose.velocity == Eigen::Vector3d::Zero() && before.pose.angular_velocity == Eigen::Vector3d::Zero();
  return {moved_on(before.pose, dt_s), rests ? how(t) : past(t - before.time)};
}

}  // namespace tactus::sync
