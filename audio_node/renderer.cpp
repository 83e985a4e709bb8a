#include "audio_node/renderer.h"

#include <algorithm>
#include <cmath>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace tactus::audio {
namespace {

// Sound that dies away ends in denormal numbers, which cost a hundred times a normal one: taken for 0 while this
// lives.
class FlushToZero {
 public:
#if defined(__SSE__)
  FlushToZero() { _mm_setcsr(saved_ | 0x8040); }  // FTZ | DAZ, Intel SDM vol. 1, section 10.2.3
  ~FlushToZero() { _mm_setcsr(saved_); }

 private:
  unsigned saved_ = _mm_getcsr();
#endif
};

// Blocks are placed anew by the device's clock; a strike on their border may so miss its sample by one without
// being late.
constexpr long kSlack = 2;

}  // namespace

Renderer::Renderer(Crossing& crossing, double rate_Hz, double ceiling, sync::Nanoseconds late_limit)
    : crossing_(crossing), rate_Hz_(rate_Hz), late_limit_(late_limit), limiter_(ceiling, rate_Hz) {}

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
  crossing_.reports.push(r);
}

void Renderer::render(float* stereo, int frames, const BlockTime& time) {
  const FlushToZero guard;
  Strike strike;
  while (crossing_.strikes.pop(strike))
    if (!scheduler_.push(strike)) report(strike, presentation_t::DROPPED_LATE, -1, sync::Nanoseconds(0));
  for (int done = 0; done < frames; done += kMaxBlock)
    render_some(stereo + 2 * done, std::min(kMaxBlock, frames - done),
                {time.first_sample + samples(done), time.uncertainty});
}

void Renderer::abandon() {
  const auto drop = [&](const Strike& s) { report(s, presentation_t::DROPPED_LATE, -1, sync::Nanoseconds(0)); };
  for (Strike strike; crossing_.strikes.pop(strike);) drop(strike);
  while (const Strike* strike = scheduler_.pop_before(sync::HostTime::max())) drop(*strike);
}

// The block's frames are rendered now and leave the limiter kDelay frames later.
void Renderer::render_some(float* stereo, int frames, const BlockTime& time) {
  const BlockTime leaving{time.first_sample + samples(Limiter::kDelay), time.uncertainty};
  const sync::HostTime end =
      leaving.first_sample + sync::Nanoseconds(std::llround((frames - 0.5) * 1e9 / rate_Hz_));
  while (const Strike* strike = scheduler_.pop_before(end)) begin(*strike, frames, leaving);
  std::fill(stereo, stereo + 2 * frames, 0.f);
  voices_.render(stereo, frames);
  limiter_.process(stereo, frames);
}

void Renderer::begin(const Strike& strike, int frames, const BlockTime& leaving) {
  const sync::Nanoseconds lateness = leaving.first_sample - strike.scheduled;
  if (lateness > late_limit_) return report(strike, presentation_t::DROPPED_LATE, -1, sync::Nanoseconds(0));
  const auto nearest = static_cast<long>(std::floor(-sync::to_seconds(lateness) * rate_Hz_ + 0.5));
  const int offset = static_cast<int>(std::clamp<long>(nearest, 0, frames - 1));
  for (const StrikeSide& side : strike.sides) voices_.strike(side, strike.pulse_samples, offset);
  const std::int8_t outcome = strike.inaudible    ? presentation_t::INAUDIBLE
                              : nearest < -kSlack ? presentation_t::LATE
                                                  : presentation_t::PRESENTED;
  const sync::Nanoseconds half_sample = samples(1) / 2;
  report(strike, outcome, sync::to_ns(leaving.first_sample + samples(offset)), leaving.uncertainty + half_sample);
}

}  // namespace tactus::audio
