#include "audio_node/mixer/renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace tactus::audio {
namespace {

// Decaying sound ends in denormal numbers, which cost a hundred times as much as normal ones: they count as 0
// while this exists.
class FlushToZero {
 public:
#if defined(__SSE__)
  FlushToZero() { _mm_setcsr(saved_ | 0x8040); }  // FTZ | DAZ, Intel SDM vol. 1, section 10.2.3
  ~FlushToZero() { _mm_setcsr(saved_); }

 private:
  unsigned saved_ = _mm_getcsr();
#endif
};

// The clock of the device corrects the place of each block, so a strike at a block border may miss its sample by
// one without being late. Two samples, and the half by which every onset is rounded.
constexpr double kSlack_samples = 2.5;

// Share of the duration of a block for its rendering: the rest covers late wake-ups and the work of the card.
// Design.
constexpr double kBudget = 0.5;
// Rate of the means that the ladder receives. Design, as for pictures: at the rate of blocks the ladder would
// react to every moment in which another process has the processor; fewer modes do not help there.
constexpr double kMeans_Hz = 60;
constexpr double kCalm_s = 2;  // design: spare time required before a better step

// The onset of a sound is lost when a drop-out removes more than half of its amplitude.
constexpr float kSilenced = 0.5f;

LevelLimiterDef level_limiter_def(const RendererDef& def) {
  LevelLimiterDef limiter = def.level_limit;
  limiter.ears = def.space.hrtf != nullptr;
  return limiter;
}

}  // namespace

sync::LatePolicy late_policy(double rate_Hz, sync::Nanoseconds limit) {
  const sync::Nanoseconds slack = sync::from_seconds(kSlack_samples / rate_Hz);
  return {kLatePolicy, slack, std::max(slack, limit)};
}

Renderer::Renderer(CallbackQueues& queues, const RendererDef& def)
    : queues_(queues),
      rate_Hz_(def.rate_Hz),
      channels_(def.space.channels()),
      delay_(def.space.latency() + Limiter::kDelay),
      silent_(def.silent),
      late_(def.late),
      newest_scene_(queues.oldest_held_scene.load(std::memory_order_relaxed)),
      voices_(kQualities[0].voices, def.rate_Hz, ring(def.instructions), def.space, def.instructions),
      scrapes_(def.rate_Hz),
      recordings_(queues.recorded, def.rate_Hz, def.space, def.instructions),
      clock_ns_(def.clock_ns),
      scrapes_taken_(queues.oldest_held_scrape.load(std::memory_order_relaxed)),
      dropout_(def.rate_Hz),
      limiter_(def.ceiling, def.rate_Hz, channels_),
      level_limiter_(level_limiter_def(def), def.rate_Hz, channels_),
      edge_(def.rate_Hz),
      ladder_(static_cast<int>(kQualities.size()), sync::from_seconds(kBudget),
              static_cast<int>(kCalm_s * std::min(kMeans_Hz, def.rate_Hz / def.period_frames))) {}

// The process was stopped, or the card was: its last sound is over.
void Renderer::resume(const BlockTime& time) {
  const auto gap = next_first_ ? time.first_sample - *next_first_ : sync::Nanoseconds(0);
  if (gap > kForget || -gap > kForget) {
    voices_.clear();
    scrapes_.clear();
    recordings_.clear();
    limiter_.clear();
    edge_.restart();
  }
  if (time.interrupted) edge_.restart();
}

void Renderer::receive_commands() {
  RenderCommand command;
  while (queues_.commands.pop(command)) {
    dropout_.set(command.dropout);
    fixed_quality_ = std::min(command.quality, static_cast<int>(kQualities.size()) - 1);
  }
  Listener listener;
  bool moved = false;
  while (queues_.listeners.pop(listener)) moved = true;
  if (moved) voices_.set_listener(listener), recordings_.set_listener(listener);
}

// The ladder receives the time per second of sound, since blocks may differ in length.
void Renderer::adapt(int frames, sync::Nanoseconds render_time) {
  if (fixed_quality_ < 0 && render_time > sync::Nanoseconds(0)) frames_ += last_frames_, render_time_ += render_time;
  last_frames_ = frames;
  if (frames_ > 0 && frames_ >= rate_Hz_ / kMeans_Hz) {
    ladder_.add(sync::from_seconds(sync::to_seconds(render_time_) * rate_Hz_ / frames_));
    frames_ = 0, render_time_ = {};
  }
  const int step = fixed_quality_ < 0 ? ladder_.step() : fixed_quality_;
  voices_.set_limits(kQualities[static_cast<std::size_t>(step)]);
  queues_.quality.store(step, std::memory_order_relaxed);
}

sync::Nanoseconds Renderer::samples(int count) const {
  return sync::Nanoseconds(std::llround(count * 1e9 / rate_Hz_));
}

void Renderer::report(const Strike& strike, std::int8_t outcome, std::int64_t presented_ns,
                      sync::Nanoseconds uncertainty) {
  presentation_t r{};
  r.event_id = strike.event_id;
  r.part = presentation_t::WHOLE;
  r.scheduled_ns = sync::to_ns(strike.scheduled);
  r.presented_ns = presented_ns;
  r.uncertainty_ns = uncertainty.count();
  r.outcome = outcome;
  if (!queues_.reports.push(r)) queues_.reports_lost.fetch_add(1, std::memory_order_relaxed);
}

void Renderer::render(float* out, int frames, const BlockTime& time) {
  const FlushToZero guard;
  resume(time);
  receive_commands();
  recordings_.receive_databases();
  adapt(frames, time.render_time);
  Strike strike;
  while (queues_.strikes.pop(strike)) {
    newest_scene_ = std::max(newest_scene_, strike.scene);
    if (!scheduler_.push(strike)) report(strike, presentation_t::DROPPED_LATE, -1, sync::Nanoseconds(0));
  }
  for (int done = 0; done < frames;) {
    const int some = next_block(frames - done);
    render_block(out + channels_ * done, some, {time.first_sample + samples(done), time.uncertainty, {}});
    done += some;
  }
  next_first_ = time.first_sample + samples(frames);
  release_strikes();
  release_scrapes();
  recordings_.release(scheduler_);
}

void Renderer::abandon() {
  const auto drop = [&](const Strike& s) { report(s, presentation_t::DROPPED_LATE, -1, sync::Nanoseconds(0)); };
  for (Strike strike; queues_.strikes.pop(strike);) {
    newest_scene_ = std::max(newest_scene_, strike.scene);
    drop(strike);
  }
  while (const Strike* strike = scheduler_.pop_before(sync::HostTime::max())) drop(*strike);
  for (Scrape s; queues_.scrapes.pop(s);) scrapes_taken_ = s.number + 1;
  release_strikes();
  next_scrape_.reset();
  scrapes_.clear();
  release_scrapes();
  recordings_.abandon(scheduler_);
}

// The frames of the block are rendered now, pass the spatialiser and leave the limiter kDelay frames later.
void Renderer::render_block(float* out, int frames, const BlockTime& time) {
  const BlockTime leaving{time.first_sample + samples(delay_), time.uncertainty, {}};
  const sync::HostTime end =
      leaving.first_sample + sync::Nanoseconds(std::llround((frames - 0.5) * 1e9 / rate_Hz_));
  dropout_.next({open_.data(), static_cast<std::size_t>(frames)});
  while (const Strike* strike = scheduler_.pop_before(end)) begin(*strike, frames, leaving);
  std::fill(out, out + channels_ * frames, 0.f);
  if (!silent_) render_sound(out, frames, leaving.first_sample);
}

void Renderer::render_sound(float* out, int frames, sync::HostTime leaving) {
  const std::int64_t begun = clock();
  const int scraping = scrapes_.active();
  for (int done = 0; done < frames;) {
    const sync::HostTime first = leaving + samples(done);
    receive_scrapes(first);
    const int some = frames_to_next_scrape(first, frames - done);
    scrapes_.render(done, some, first);
    done += some;
  }
  queues_.costs[0].contacts.fetch_add(std::max(0, scrapes_.active() - scraping), std::memory_order_relaxed);
  scrapes_.drive(voices_, frames);
  voices_.render(out, frames);
  const std::int64_t computed = clock();
  const int contacts = recordings_.render(out, frames, leaving);
  queues_.costs[1].contacts.fetch_add(contacts, std::memory_order_relaxed);
  // A block without sound counts for no contact.
  if (voices_.active() > 0) queues_.costs[0].ns.fetch_add(computed - begun, std::memory_order_relaxed);
  if (recordings_.active() > 0) queues_.costs[1].ns.fetch_add(clock() - computed, std::memory_order_relaxed);
  for (int n = 0; n < frames; ++n)
    for (int c = 0; c < channels_; ++c) out[channels_ * n + c] *= open_[static_cast<std::size_t>(n)];
  limit(out, frames);
}

// The level limiter is after all gains, so that it measures the played sound; an edge only makes it quieter.
void Renderer::limit(float* out, int frames) {
  limiter_.process(out, frames);
  level_limiter_.process(out, frames);
  edge_.apply(out, frames, channels_);
  // no other thread writes it
  const double exposure = queues_.exposure.exposure_Pa2_s.load(std::memory_order_relaxed);
  queues_.exposure.exposure_Pa2_s.store(exposure + level_limiter_.take_exposure_Pa2_s(), std::memory_order_relaxed);
  queues_.exposure.gain.store(level_limiter_.gain(), std::memory_order_relaxed);
}

// Frames from this one to the first at which the waiting scrape is due.
int Renderer::frames_to_next_scrape(sync::HostTime first, int frames_left) const {
  if (!next_scrape_) return frames_left;
  const double away = std::ceil(sync::to_seconds(next_scrape_->at - first) * rate_Hz_);
  return static_cast<int>(std::clamp(away, 1.0, static_cast<double>(frames_left)));
}

// They are queued in the order of presentation; an early one waits.
void Renderer::receive_scrapes(sync::HostTime until) {
  for (Scrape s; next_scrape_ || queues_.scrapes.pop(s);) {
    if (next_scrape_) s = *std::exchange(next_scrape_, std::nullopt);
    scrapes_taken_ = s.number + 1;
    if (s.at > until) {
      next_scrape_ = s;
      return;
    }
    scrapes_.update(s);
  }
}

// Strikes that are still in the queue are of the newest scene or of a later one. Voices keep a copy of their modes.
void Renderer::release_strikes() {
  if (queues_.oldest_held_scene.load(std::memory_order_relaxed) == newest_scene_) return;
  std::int64_t held = newest_scene_;
  scheduler_.for_each([&](const Strike& s) { held = std::min(held, s.scene); });
  queues_.oldest_held_scene.store(held, std::memory_order_release);
}

// Scrapes that are still in the queue have larger numbers than all received ones.
void Renderer::release_scrapes() {
  std::int64_t held = scrapes_taken_;
  if (next_scrape_) held = std::min(held, next_scrape_->number);
  if (const auto oldest = scrapes_.oldest()) held = std::min(held, *oldest);
  queues_.oldest_held_scrape.store(held, std::memory_order_release);
}

void Renderer::begin(const Strike& strike, int frames, const BlockTime& leaving) {
  const sync::Nanoseconds lateness = leaving.first_sample - strike.scheduled;
  const std::int8_t outcome = late_.outcome(lateness);
  if (outcome == presentation_t::DROPPED_LATE) return report(strike, outcome, -1, sync::Nanoseconds(0));
  const auto gain = static_cast<float>(late_.gain(lateness));
  const auto nearest = static_cast<long>(std::floor(-sync::to_seconds(lateness) * rate_Hz_ + 0.5));
  const int offset = static_cast<int>(std::clamp<long>(nearest, 0, frames - 1));
  if (!silent_) {
    for (const StrikeSide& side : strike.sides) voices_.strike(side, gain, strike.pulse, offset);
    recordings_.begin(strike, gain, offset);
  }
  const bool computed = strike.sides[0].voice >= 0 || strike.sides[1].voice >= 0;
  queues_.costs[0].contacts.fetch_add(computed ? 1 : 0, std::memory_order_relaxed);
  queues_.costs[1].contacts.fetch_add(strike.recorded.database > 0 ? 1 : 0, std::memory_order_relaxed);
  // The bodies keep ringing during the silence.
  if (open_[static_cast<std::size_t>(offset)] < kSilenced)
    return report(strike, presentation_t::DROPPED_BY_PROFILE, -1, sync::Nanoseconds(0));
  const sync::Nanoseconds half_sample = samples(1) / 2;
  const bool audible = gain >= strike.min_audible_gain;
  report(strike, audible ? outcome : presentation_t::INAUDIBLE, sync::to_ns(leaving.first_sample + samples(offset)),
         leaving.uncertainty + half_sample);
}

}  // namespace tactus::audio
