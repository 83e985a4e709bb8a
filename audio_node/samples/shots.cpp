#include "audio_node/samples/shots.h"

#include <algorithm>
#include <cmath>

#include "audio_node/bank/ring.h"
#include "audio_node/samples/interpolate.h"

namespace tactus::audio {

Shots::Shots(double rate_Hz)
    : fade_step_(static_cast<float>(1 / (kFade_s * rate_Hz))),
      voices_(static_cast<std::size_t>(kMost + kFading)) {}

void Shots::leave_room() {
  const auto sounds = [](const Voice& v) { return v.shot.recording && !v.fades; };
  if (std::count_if(voices_.begin(), voices_.end(), sounds) < kMost) return;
  Voice* quietest = nullptr;
  for (Voice& v : voices_)
    if (sounds(v) && (!quietest || v.level < quietest->level)) quietest = &v;
  quietest->fades = true;
}

// There are more voices than may sound, so what is not free here fades, and the quietest of that ends.
Shots::Voice& Shots::free_voice() {
  Voice* best = nullptr;
  for (Voice& v : voices_) {
    if (!v.shot.recording) return v;
    if (v.fades && (!best || v.level < best->level)) best = &v;
  }
  return *best;
}

void Shots::take(const RecordedStrike& strike, float gain, int offset) {
  if (strike.database == 0) return;
  for (const Shot& shot : strike.shots) {
    if (!shot.recording || !(shot.gain * gain > 0)) continue;
    leave_room();
    Voice& v = free_voice();
    v = Voice{};
    v.shot = shot;
    v.shot.gain *= gain;
    v.database = strike.database;
    v.place = strike.place;
    v.begin = offset;
    v.level = v.shot.gain * shot.recording->peak / strike.place.distance_m;
  }
}

void Shots::render(Voice& v, float* mix, int frames) const {
  const std::vector<float>& x = v.shot.recording->samples;
  const auto size = static_cast<std::ptrdiff_t>(x.size());
  const auto sample = [&](std::ptrdiff_t i) { return i >= 0 && i < size ? x[static_cast<std::size_t>(i)] : 0.f; };
  std::array<float, kMaxBlock> out{};
  float most = 0;
  bool over = false;
  for (int n = v.begin; n < frames && !over; ++n) {
    const auto i = static_cast<std::ptrdiff_t>(v.at);
    const auto part = static_cast<float>(v.at - static_cast<double>(i));
    if (v.fades) v.fade = std::max(0.f, v.fade - fade_step_);
    const float s = v.shot.gain * v.fade * between(sample(i - 1), sample(i), sample(i + 1), sample(i + 2), part);
    out[static_cast<std::size_t>(n)] = s;
    most = std::max(most, std::abs(s));
    v.at += static_cast<double>(v.shot.step);
    over = v.at >= static_cast<double>(size) || v.fade <= 0;
  }
  v.ears.add(v.place, out.data(), mix, frames);
  if (v.begin < frames) v.level = most / v.place.distance_m;
  v.begin = std::max(0, v.begin - frames);
  if (over) v.shot.recording = nullptr;
}

void Shots::render(float* mix, int frames) {
  for (Voice& v : voices_)
    if (v.shot.recording) render(v, mix, frames);
}

int Shots::active() const {
  return static_cast<int>(
      std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.shot.recording; }));
}

std::int64_t Shots::oldest(std::int64_t none) const {
  for (const Voice& v : voices_)
    if (v.shot.recording) none = std::min(none, v.database);
  return none;
}

void Shots::clear() { std::fill(voices_.begin(), voices_.end(), Voice{}); }

}  // namespace tactus::audio
