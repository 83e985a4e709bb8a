#include "audio_node/samples/loops.h"

#include <algorithm>
#include <cmath>

#include "audio_node/modal/bank/ring.h"
#include "audio_node/samples/interpolate.h"

namespace tactus::audio {
namespace {

// Time constant of a level. Design: shorter is audible as roughness when contacts are updated at 1 kHz.
constexpr double kLevel_s = 0.005;
// A contact without updates fades out. Design, as for scrapes: a few lost messages are not a gap.
constexpr sync::Nanoseconds kUpdateTimeout{30'000'000};
constexpr double kMaxTimeout_s = 0.5;  // design: or twice the update interval, but at most this
constexpr float kEndLevel = 1e-6f;
// At most one octave up or down; beyond it a recording sounds like another material (design).
constexpr double kMinStep = 0.5, kMaxStep = 2;

}  // namespace

bool Loops::update(const RecordedContact& contact) {
  if (contact.ends) {
    for (Voice& v : voices_)
      if (v.on && v.ends_in < 0 && v.now.contact == contact.contact && v.now.part == contact.part)
        v.ends_in = static_cast<int>(kEnd_s * rate_Hz_);
    return false;
  }
  if (!contact.layers || !std::isfinite(contact.level) || !std::isfinite(contact.speed_m_s) ||
      !std::isfinite(contact.update_interval_s))
    return false;
  Voice* free = nullptr;
  for (Voice& v : voices_) {
    // A contact of another database is another sound; the previous one fades.
    if (v.on && v.now.contact == contact.contact && v.now.part == contact.part && v.now.layers == contact.layers) {
      v.now = contact;
      v.ends_in = -1;
      return false;
    }
    if (!v.on && !free) free = &v;
  }
  if (!free) return false;
  *free = Voice{};
  spatialiser_.begin(static_cast<int>(free - voices_.data()));
  free->on = true;
  free->now = contact;
  const auto count = std::min(contact.layers->by_speed.size(), static_cast<std::size_t>(kMaxLayers));
  for (std::size_t i = 0; i < count; ++i) {
    const Recording& r = select_take(contact.layers->by_speed[i], contact.contact);
    // Each contact begins at another place of the loop, so that contacts that begin together remain distinct.
    const auto begin = static_cast<std::uint64_t>(contact.contact + 1) * 0x9E3779B97F4A7C15u % r.samples.size();
    free->layers[i] = {&r, static_cast<double>(begin), 0};
  }
  return true;
}

void Loops::add(Playing& p, double step, float wanted, int ends_in, float* out, int frames) const {
  const std::vector<float>& x = p.recording->samples;
  const auto size = x.size();
  const auto length = static_cast<double>(size);
  std::array<float, kMaxBlock> played;
  for (int n = 0; n < frames;) {
    const int inside = stretch(x.data(), size, p.at, step, &played[static_cast<std::size_t>(n)], frames - n);
    n += inside;
    p.at += inside * step;
    if (inside > 0) continue;
    // Across the seam.
    const auto i = std::min(static_cast<std::size_t>(p.at), size - 1);
    const auto part = static_cast<float>(p.at - static_cast<double>(i));
    const std::size_t before = i == 0 ? size - 1 : i - 1, after = i + 1 < size ? i + 1 : 0;
    const std::size_t later = after + 1 < size ? after + 1 : 0;
    played[static_cast<std::size_t>(n++)] = between(x[before], x[i], x[after], x[later], part);
    p.at += step;
    if (p.at >= length) p.at -= length;
  }
  if (ends_in >= 0) {
    // Linearly to zero, exactly.
    const float begin = p.level, fall = begin / static_cast<float>(std::max(ends_in, 1));
    const int sounding = std::min(frames, ends_in);
    for (int n = 0; n < sounding; ++n)
      out[n] += (begin - static_cast<float>(n + 1) * fall) * played[static_cast<std::size_t>(n)];
    p.level = ends_in > frames ? begin - static_cast<float>(frames) * fall : 0;
    return;
  }
  // Linearly to the level at the end of the block.
  const auto left = static_cast<float>(std::exp(-frames / (kLevel_s * rate_Hz_)));
  const float begin = p.level, rise = (wanted + (begin - wanted) * left - begin) / static_cast<float>(frames);
  for (int n = 0; n < frames; ++n)
    out[n] += (begin + static_cast<float>(n + 1) * rise) * played[static_cast<std::size_t>(n)];
  p.level = wanted + (begin - wanted) * left;
}

void Loops::render(Voice& v, int frames, sync::HostTime first) {
  const bool updated =
      v.ends_in < 0 &&
      first - v.now.at < std::max(kUpdateTimeout, sync::from_seconds(std::min(2 * v.now.update_interval_s, kMaxTimeout_s)));
  const LayerMix mixed = mix_of(*v.now.layers, v.now.speed_m_s);
  std::array<float, kMaxBlock> out{};
  float level = 0;
  for (std::size_t i = 0; i < v.layers.size(); ++i) {
    Playing& p = v.layers[i];
    if (!p.recording) break;
    const Layer& layer = v.now.layers->by_speed[i];
    float wanted = 0;
    for (std::size_t k = 0; k < 2; ++k)
      if (updated && mixed.layer[k] == static_cast<int>(i)) wanted = v.now.level * layer.gain * mixed.gain[k];
    if (wanted <= 0 && p.level < kEndLevel) {
      p.level = 0;
      continue;
    }
    add(p, std::clamp(v.now.speed_m_s / layer.speed_m_s, kMinStep, kMaxStep), wanted, v.ends_in, out.data(),
        frames);
    level = std::max(level, p.level);
  }
  spatialiser_.add(static_cast<int>(&v - voices_.data()),
                   listener_ ? relative_to_listener(*listener_, v.now.place) : v.now.place, out.data(), frames);
  v.ends_in = v.ends_in < 0 ? -1 : std::max(0, v.ends_in - frames);
  // The comparison also ends a level that is NaN.
  const bool over = !updated && !(level > kEndLevel);
  if (over && v.silent >= spatialiser_.tail()) v.on = false;
  v.silent = over ? v.silent + frames : 0;
}

void Loops::render(float* mix, int frames, sync::HostTime first) {
  for (Voice& v : voices_)
    if (v.on) render(v, frames, first);
  spatialiser_.mix(mix, frames);
}

int Loops::active() const {
  return static_cast<int>(std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.on; }));
}

std::int64_t Loops::oldest(std::int64_t none) const {
  for (const Voice& v : voices_)
    if (v.on) none = std::min(none, v.now.database);
  return none;
}

}  // namespace tactus::audio
