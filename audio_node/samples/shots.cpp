#include "audio_node/samples/shots.h"

#include <algorithm>
#include <cmath>

#include "audio_node/modal/bank/ring.h"
#include "audio_node/samples/interpolate.h"

namespace tactus::audio {

Shots::Shots(double rate_Hz, const Space& space, Instructions instructions)
    : fade_step_(static_cast<float>(1 / (kFade_s * rate_Hz))),
      voices_(static_cast<std::size_t>(kMax + kFading)),
      spatialiser_(space, kMax + kFading, rate_Hz, instructions) {}

void Shots::fade_weakest() {
  const auto sounds = [](const Voice& v) { return v.on && !v.fades; };
  if (std::count_if(voices_.begin(), voices_.end(), sounds) < kMax) return;
  Voice* quietest = nullptr;
  for (Voice& v : voices_)
    if (sounds(v) && (!quietest || v.level < quietest->level)) quietest = &v;
  quietest->fades = true;
}

// There are more voices than may sound, so a voice that is not free fades, and the quietest of these ends.
Shots::Voice& Shots::free_voice() {
  Voice* best = nullptr;
  for (Voice& v : voices_) {
    if (!v.on) return v;
    if (v.fades && (!best || v.level < best->level)) best = &v;
  }
  return *best;
}

void Shots::start(const RecordedStrike& strike, float gain, int offset) {
  float level = 0;
  for (const Shot& s : strike.shots)
    if (s.recording) level += s.gain * gain * s.recording->peak;
  const bool plays = std::all_of(strike.shots.begin(), strike.shots.end(),
                                 [](const Shot& s) { return !s.recording || (s.step > 0 && std::isfinite(s.step)); });
  if (strike.database == 0 || !plays || !(level > 0) || !std::isfinite(level)) return;
  fade_weakest();
  Voice& v = free_voice();
  v = Voice{};
  spatialiser_.begin(static_cast<int>(&v - voices_.data()));
  v.on = true;
  for (std::size_t i = 0; i < v.shots.size(); ++i) {
    v.shots[i].shot = strike.shots[i];
    v.shots[i].shot.gain *= gain;
  }
  v.database = strike.database;
  v.place = strike.place;
  v.begin = offset;
  v.level = level / strike.place.distance_m;
}

// Adds its samples; false when it has ended.
bool Shots::play(Playing& p, float* out, int frames) {
  const std::vector<float>& x = p.shot.recording->samples;
  const auto size = static_cast<std::ptrdiff_t>(x.size());
  const auto sample = [&](std::ptrdiff_t i) { return i >= 0 && i < size ? x[static_cast<std::size_t>(i)] : 0.f; };
  const double step = static_cast<double>(p.shot.step);
  std::array<float, kMaxBlock> played{};
  for (int n = 0; n < frames && p.at < static_cast<double>(size);) {
    const int inside = stretch(x.data(), x.size(), p.at, step, &played[static_cast<std::size_t>(n)], frames - n);
    n += inside;
    p.at += inside * step;
    if (inside > 0) continue;
    const auto i = static_cast<std::ptrdiff_t>(p.at);
    const auto part = static_cast<float>(p.at - static_cast<double>(i));
    played[static_cast<std::size_t>(n++)] = between(sample(i - 1), sample(i), sample(i + 1), sample(i + 2), part);
    p.at += step;
  }
  for (int n = 0; n < frames; ++n) out[n] += p.shot.gain * played[static_cast<std::size_t>(n)];
  return p.at < static_cast<double>(size);
}

void Shots::render(Voice& v, int frames) {
  std::array<float, kMaxBlock> out{};
  const int begin = std::min(v.begin, frames);
  v.begin -= begin;
  bool sounds = false;
  for (Playing& p : v.shots) {
    if (!p.shot.recording) continue;
    if (play(p, out.data() + begin, frames - begin))
      sounds = true;
    else
      p.shot.recording = nullptr;
  }
  float max = 0;
  for (int n = begin; n < frames; ++n) {
    float& s = out[static_cast<std::size_t>(n)];
    if (v.fades) s *= v.fade = std::max(0.f, v.fade - fade_step_);
    max = std::max(max, std::abs(s));
  }
  const SourcePosition place = listener_ ? relative_to_listener(*listener_, v.place) : v.place;
  spatialiser_.add(static_cast<int>(&v - voices_.data()), place, out.data(), frames);
  if (begin < frames) v.level = max / place.distance_m;
  const bool over = !sounds || v.fade <= 0;
  v.on = !over || v.silent < spatialiser_.tail();
  v.silent = over ? v.silent + frames : 0;
}

void Shots::render(float* mix, int frames) {
  for (Voice& v : voices_)
    if (v.on) render(v, frames);
  spatialiser_.mix(mix, frames);
}

int Shots::active() const {
  return static_cast<int>(std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.on; }));
}

std::int64_t Shots::oldest(std::int64_t none) const {
  for (const Voice& v : voices_)
    if (v.on) none = std::min(none, v.database);
  return none;
}

void Shots::clear() { std::fill(voices_.begin(), voices_.end(), Voice{}); }

}  // namespace tactus::audio
