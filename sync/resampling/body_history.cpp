#include "sync/resampling/body_history.h"

#include <algorithm>
#include <tactus/body_state_t.hpp>

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

bool rests(const BodyPose& p) {
  return p.velocity == Eigen::Vector3d::Zero() && p.angular_velocity == Eigen::Vector3d::Zero();
}

SampleStatus past(Nanoseconds newest) {
  return newest <= BodyHistory::kMaxExtrapolation ? SampleStatus::kExtrapolated
         : newest <= BodyHistory::kStaleAfter      ? SampleStatus::kHeld
                                                   : SampleStatus::kStale;
}

}  // namespace

void BodyHistory::push(const world_state_t& page, HostTime arrival) {
  switch (clock_tracker_.track(page.header, page.clock, arrival)) {
    case TrackResult::kIgnore: return;
    case TrackResult::kRestart:
      bodies_.clear();
      sample_count_ = 0;
      newest_.reset();
      break;
    case TrackResult::kSame: break;
  }
  const SimTime time = sim_time(page.header.sim_time_ns), latest = clock_tracker_.latest_plausible();
  if (newest_ && *newest_ > latest) discard_after(latest);
  if (time > latest) {
    ++refused_;
    return;
  }
  if (!newest_ || time > *newest_) newest_ = time;
  const Nanoseconds period =
      page.rate_Hz > 1 ? from_seconds(1 / static_cast<double>(page.rate_Hz)) : Nanoseconds(0);
  for (const body_state_t& b : page.bodies) {
    if (b.body >= kMaxBodies) {
      ++refused_;
      continue;
    }
    Samples& samples = bodies_[b.body];
    if (!insert(samples, {time, page.header.seq, page.group == world_state_t::AHEAD, period, from_message(b)}))
      continue;
    if (samples.size() <= 2) continue;
    const bool recent = samples.size() <= kSamplesPerBody || samples.back().time - samples.front().time <= span_;
    if (recent && sample_count_ <= kMaxSamples) continue;
    samples.pop_front();
    --sample_count_;
  }
}

// Inserts a sample in order of time; pages may overtake each other. Returns true when it was inserted. Of several samples of
// one instant the first stays, but a sample of the current step replaces a predicted one.
bool BodyHistory::insert(Samples& samples, TimedPose sample) {
  const auto later = [&](const TimedPose& s) { return s.time <= sample.time; };
  auto at = std::find_if(samples.rbegin(), samples.rend(), later).base();
  if (sample.ahead) {
    // A sample of the present that is published later and for an earlier instant revokes this prediction. Predictions are
    // published in order of their times, so samples before a valid prediction need no check.
    for (auto s = at; s != samples.begin();) {
      if ((--s)->ahead && s->seq < sample.seq && s->time < sample.time) break;
      if (!s->ahead && s->seq > sample.seq && sample.time - s->time <= SimClockTracker::kMaxDeviation) return false;
    }
  } else {
    discard_predictions(samples, sample);
    at = std::find_if(samples.rbegin(), samples.rend(), later).base();
  }
  if (at != samples.begin() && std::prev(at)->time == sample.time) {
    TimedPose& previous = *std::prev(at);
    if (previous.ahead && !sample.ahead) previous = sample;
    return false;
  }
  samples.insert(at, std::move(sample));
  ++sample_count_;
  return true;
}

// A sample of the current step revokes all earlier predictions of that body. No prediction is valid beyond kMaxDeviation, so a
// corrupt page cannot revoke more.
void BodyHistory::discard_predictions(Samples& samples, const TimedPose& now) {
  const auto end =
      std::find_if(samples.rbegin(), samples.rend(), [&](const TimedPose& s) { return s.time <= now.time; }).base();
  const auto void_now = [&](const TimedPose& s) {
    return s.ahead && s.seq < now.seq && s.time - now.time <= SimClockTracker::kMaxDeviation;
  };
  const auto kept = std::remove_if(end, samples.end(), void_now);
  sample_count_ -= static_cast<std::size_t>(samples.end() - kept);
  samples.erase(kept, samples.end());
}

// Removes samples after `latest`: a sample may have been accepted only because its corrupt message was the first one.
void BodyHistory::discard_after(SimTime latest) {
  newest_.reset();
  for (auto& [body, samples] : bodies_) {
    for (; !samples.empty() && samples.back().time > latest; --sample_count_) samples.pop_back();
    if (!samples.empty() && (!newest_ || samples.back().time > *newest_)) newest_ = samples.back().time;
  }
}

SampleStatus BodyHistory::status(SimTime t) const {
  if (!newest_) return SampleStatus::kNone;
  return t <= *newest_ ? SampleStatus::kInterpolated : past(t - *newest_);
}

Sample<BodyPose> BodyHistory::pose(int body, SimTime t) const {
  const auto it = bodies_.find(body);
  if (it == bodies_.end() || it->second.empty()) return {};
  const auto& samples = it->second;
  const auto after = std::find_if(samples.begin(), samples.end(), [&](const TimedPose& s) { return s.time > t; });
  if (after == samples.begin()) return {after->pose, SampleStatus::kHeld};  // older than all stored samples
  const TimedPose& before = *std::prev(after);
  if (before.time == t) return {before.pose, SampleStatus::kExact};
  if (after != samples.end()) {
    SimTime begin = before.time;
    if (after->period > Nanoseconds(0) && rests(before.pose)) begin = std::max(begin, after->time - after->period);
    if (t <= begin) return {before.pose, SampleStatus::kInterpolated};
    const double span_s = to_seconds(after->time - begin), s = to_seconds(t - begin) / span_s;
    return {between(before.pose, after->pose, span_s, s), SampleStatus::kInterpolated};
  }
  const double dt_s = to_seconds(std::min(t - before.time, Nanoseconds(kMaxExtrapolation)));
  // A body at rest is left out of snapshots, so its pose is exact. A moving body without a sample is missing: its page was
  // lost.
  return {moved_on(before.pose, dt_s), rests(before.pose) ? status(t) : past(t - before.time)};
}

}  // namespace tactus::sync
