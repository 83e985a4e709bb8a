#include "audio_node/voices.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::audio {
namespace {

// A voice weaker than this is over: -100 dBFS, below the noise of any 16-bit converter.
constexpr float kOver = 1e-5f;

// Sample i of a raised-cosine pulse of n samples whose sum is 1.
float pulse_weight(int i, int n) {
  if (n <= 1) return 1;
  return (1 - std::cos(2 * std::numbers::pi_v<float> * (static_cast<float>(i) + 0.5f) / static_cast<float>(n))) /
         static_cast<float>(n);
}

}  // namespace

Voices::Voices(int voices, double rate_Hz)
    : limits_{voices, 1},
      fade_step_(static_cast<float>(1 / (kFade_s * rate_Hz))),
      voices_(static_cast<std::size_t>(voices + kFading)) {}

void Voices::set_limits(const VoiceLimits& limits) {
  const int most = static_cast<int>(voices_.size()) - kFading;
  limits_ = {std::clamp(limits.voices, 1, most), std::max(1, limits.modes_of)};
}

Voices::Voice* Voices::sounding(std::int64_t id) {
  for (Voice& v : voices_)
    if (v.id == id && !v.whole.on) return &v;
  return nullptr;
}

// The weakest give way until no more than so many sound besides those that fade.
void Voices::leave_room(int at_most) {
  const auto sounds = [](const Voice& v) { return v.id >= 0 && !v.whole.on; };
  auto count = std::count_if(voices_.begin(), voices_.end(), sounds);
  for (; count > at_most; --count) {
    Voice* weakest = nullptr;
    for (Voice& v : voices_)
      if (sounds(v) && (!weakest || v.level < weakest->level)) weakest = &v;
    weakest->whole.on = true;
  }
}

// There are more voices than may sound, so what is not free here fades, and the weakest of that ends.
Voices::Voice& Voices::free_voice() {
  Voice* best = nullptr;
  for (Voice& v : voices_) {
    if (v.id < 0) return v;
    if (v.whole.on && (!best || v.level < best->level)) best = &v;
  }
  return *best;
}

int Voices::allowed(const Voice& v) const { return (v.groups + limits_.modes_of - 1) / limits_.modes_of; }

void Voices::take(Voice& v, const StrikeSide& side) const {
  v = Voice{};
  v.id = side.voice;
  v.groups = (std::min(side.resonators.count, kMaxModes) + kLanes - 1) / kLanes;
  v.rendered = v.kept = allowed(v);
  for (int g = 0; g < v.groups; ++g) {
    const auto i = static_cast<std::size_t>(g);
    v.re[i].setZero(), v.im[i].setZero();
    v.pole_re[i] = Eigen::Map<const Lanes>(&side.resonators.pole_re[i * kLanes]);
    v.pole_im[i] = Eigen::Map<const Lanes>(&side.resonators.pole_im[i * kLanes]);
    v.response[i] = Eigen::Map<const Lanes>(&side.resonators.response[i * kLanes]);
  }
  v.left = side.left, v.right = side.right;
}

void Voices::strike(const StrikeSide& side, float gain, int pulse_samples, int offset) {
  if (side.voice < 0) return;
  Voice* known = sounding(side.voice);
  if (!known) {
    leave_room(limits_.voices - 1);
    take(*(known = &free_voice()), side);
  }
  Voice& v = *known;
  v.left_to = side.left, v.right_to = side.right;
  const auto pushes = [](const Pulse& p) { return p.samples > 0; };
  // Modes that were cut come back at rest, with a pulse from its beginning: in the middle of one they would jump.
  if (!v.cut.on && v.rendered < allowed(v) && std::none_of(v.pulses.begin(), v.pulses.end(), pushes))
    v.rendered = v.kept = allowed(v);
  const auto free = std::find_if_not(v.pulses.begin(), v.pulses.end(), pushes);
  if (free != v.pulses.end()) {
    *free = {offset, std::max(1, pulse_samples), gain * side.impulse, gain * side.click, 0};
  } else {
    v.pulses.back().impulse += gain * side.impulse;
  }
  float response = 0;
  for (int g = 0; g < v.rendered; ++g) response += v.response[static_cast<std::size_t>(g)].sum();
  v.expected = gain * (std::abs(side.impulse) * response + std::abs(side.click)) * std::max(side.left, side.right);
  v.level += v.expected;
}

// Fills the force of the block and the clicks. False when no pulse is on.
bool Voices::force(Voice& v, int frames, float* force, float* out) {
  bool any = false;
  std::fill(force, force + frames, 0.f);
  for (Pulse& p : v.pulses) {
    if (p.samples == 0) continue;
    any = true;
    for (int n = std::max(0, p.begin); n < frames && n <= p.begin + p.samples; ++n) {
      const int i = n - p.begin;
      const float weight = i < p.samples ? pulse_weight(i, p.samples) : 0;
      force[n] += p.impulse * weight;
      out[n] += p.click * (weight - p.weight);
      p.weight = weight;
    }
    p.begin -= frames;
    if (p.begin + p.samples < 0) p.samples = 0;
  }
  return any;
}

void Voices::resonate(Voice& v, int from, int to, int frames, const float* force, float* out) {
  std::array<Lanes, kMaxBlock> sum;
  for (int n = 0; n < frames; ++n) sum[static_cast<std::size_t>(n)].setZero();
  for (int g = from; g < to; ++g) {
    const auto i = static_cast<std::size_t>(g);
    Lanes re = v.re[i], im = v.im[i];
    const Lanes a = v.pole_re[i], b = v.pole_im[i], response = v.response[i];
    for (int n = 0; n < frames; ++n) {
      const Lanes next = a * re - b * im + response * force[n];
      im = b * re + a * im;
      re = next;
      sum[static_cast<std::size_t>(n)] += re;
    }
    v.re[i] = re, v.im[i] = im;
  }
  for (int n = 0; n < frames; ++n) out[n] += sum[static_cast<std::size_t>(n)].sum();
}

void Voices::fade(Fade& fade, float* samples, int frames) const {
  for (int n = 0; fade.on && n < frames; ++n) {
    fade.gain = std::max(0.f, fade.gain - fade_step_);
    samples[n] *= fade.gain;
  }
}

// Begins when it must and none is on: one after the other.
void Voices::cut(Voice& v) const {
  if (v.cut.on || v.rendered <= allowed(v)) return;
  v.kept = allowed(v);
  v.cut.on = true;
}

void Voices::end_cut(Voice& v) const {
  if (!v.cut.on || v.cut.gain > 0) return;
  for (int g = v.kept; g < v.rendered; ++g)
    v.re[static_cast<std::size_t>(g)].setZero(), v.im[static_cast<std::size_t>(g)].setZero();
  v.rendered = v.kept;
  v.cut = {};
}

void Voices::render(Voice& v, float* mix, int frames) const {
  cut(v);
  std::array<float, kMaxBlock> push, out{};
  const bool pushed = force(v, frames, push.data(), out.data());
  resonate(v, 0, v.kept, frames, push.data(), out.data());
  if (v.cut.on) {
    std::array<float, kMaxBlock> leaving{};
    resonate(v, v.kept, v.rendered, frames, push.data(), leaving.data());
    fade(v.cut, leaving.data(), frames);
    for (int n = 0; n < frames; ++n) out[static_cast<std::size_t>(n)] += leaving[static_cast<std::size_t>(n)];
    end_cut(v);
  }
  fade(v.whole, out.data(), frames);
  const float step_left = (v.left_to - v.left) / static_cast<float>(frames);
  const float step_right = (v.right_to - v.right) / static_cast<float>(frames);
  for (int n = 0; n < frames; ++n) {
    v.left += step_left, v.right += step_right;
    mix[2 * n] += v.left * out[static_cast<std::size_t>(n)];
    mix[2 * n + 1] += v.right * out[static_cast<std::size_t>(n)];
  }
  v.left = v.left_to, v.right = v.right_to;
  v.level = 0;
  for (int g = 0; g < v.rendered; ++g) {
    const auto i = static_cast<std::size_t>(g);
    v.level += (v.re[i].square() + v.im[i].square()).sqrt().sum();
  }
  v.level *= std::max(v.left, v.right) * v.whole.gain;
  // The comparison also ends a voice that has become no number.
  if (v.whole.gain <= 0 || (!pushed && !(v.level > kOver))) v.id = -1;
  if (pushed) v.level += v.expected;
}

void Voices::render(float* mix, int frames) {
  leave_room(limits_.voices);
  for (Voice& v : voices_)
    if (v.id >= 0) render(v, mix, frames);
}

int Voices::active() const {
  return static_cast<int>(std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.id >= 0; }));
}

double Voices::energy() const {
  double sum = 0;
  for (const Voice& v : voices_)
    for (int g = 0; v.id >= 0 && g < v.rendered; ++g) {
      const auto i = static_cast<std::size_t>(g);
      sum += static_cast<double>((v.re[i].square() + v.im[i].square()).sum());
    }
  return sum;
}

}  // namespace tactus::audio
