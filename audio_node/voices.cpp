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

Voices::Voices(int voices) : voices_(static_cast<std::size_t>(voices)) {}

Voices::Voice& Voices::voice_for(std::int64_t id) {
  Voice* best = &voices_.front();
  for (Voice& v : voices_) {
    if (v.id == id) return v;
    if (best->id >= 0 && (v.id < 0 || v.level < best->level)) best = &v;
  }
  best->id = -1;
  return *best;
}

void Voices::strike(const StrikeSide& side, int pulse_samples, int offset) {
  if (side.voice < 0) return;
  Voice& v = voice_for(side.voice);
  if (v.id != side.voice) {
    v = Voice{};
    v.id = side.voice;
    v.groups = (std::min(side.resonators.count, kMaxModes) + kLanes - 1) / kLanes;
    for (int g = 0; g < v.groups; ++g) {
      const auto i = static_cast<std::size_t>(g);
      v.re[i].setZero(), v.im[i].setZero();
      v.pole_re[i] = Eigen::Map<const Lanes>(&side.resonators.pole_re[i * kLanes]);
      v.pole_im[i] = Eigen::Map<const Lanes>(&side.resonators.pole_im[i * kLanes]);
      v.response[i] = Eigen::Map<const Lanes>(&side.resonators.response[i * kLanes]);
    }
    v.left = side.left, v.right = side.right;
  }
  v.left_to = side.left, v.right_to = side.right;
  const auto free = std::find_if(v.pulses.begin(), v.pulses.end(), [](const Pulse& p) { return p.samples == 0; });
  if (free != v.pulses.end()) {
    *free = {offset, std::max(1, pulse_samples), side.impulse, side.click, 0};
  } else {
    v.pulses.back().impulse += side.impulse;
  }
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

void Voices::resonate(Voice& v, int frames, const float* force, float* out) {
  std::array<Lanes, kMaxBlock> sum;
  for (int n = 0; n < frames; ++n) sum[static_cast<std::size_t>(n)].setZero();
  for (int g = 0; g < v.groups; ++g) {
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

void Voices::render(float* mix, int frames) {
  for (Voice& v : voices_) {
    if (v.id < 0) continue;
    std::array<float, kMaxBlock> push, out{};
    const bool pushed = force(v, frames, push.data(), out.data());
    resonate(v, frames, push.data(), out.data());
    const float step_left = (v.left_to - v.left) / static_cast<float>(frames);
    const float step_right = (v.right_to - v.right) / static_cast<float>(frames);
    for (int n = 0; n < frames; ++n) {
      v.left += step_left, v.right += step_right;
      mix[2 * n] += v.left * out[static_cast<std::size_t>(n)];
      mix[2 * n + 1] += v.right * out[static_cast<std::size_t>(n)];
    }
    v.left = v.left_to, v.right = v.right_to;
    v.level = 0;
    for (int g = 0; g < v.groups; ++g) {
      const auto i = static_cast<std::size_t>(g);
      v.level += (v.re[i].square() + v.im[i].square()).sqrt().sum();
    }
    v.level *= std::max(v.left, v.right);
    // The comparison also ends a voice that has become no number.
    if (!pushed && !(v.level > kOver)) v.id = -1;
  }
}

int Voices::active() const {
  return static_cast<int>(std::count_if(voices_.begin(), voices_.end(), [](const Voice& v) { return v.id >= 0; }));
}

double Voices::energy() const {
  double sum = 0;
  for (const Voice& v : voices_)
    for (int g = 0; v.id >= 0 && g < v.groups; ++g) {
      const auto i = static_cast<std::size_t>(g);
      sum += static_cast<double>((v.re[i].square() + v.im[i].square()).sum());
    }
  return sum;
}

}  // namespace tactus::audio
