#include "audio_node/modal/bank/ring.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace tactus::audio {
namespace sse2 {
void ring(const Ringing&, const Push*, int, int, float*);
}
#if defined(__x86_64__)
namespace avx2 {
void ring(const Ringing&, const Push*, int, int, float*);
}
namespace avx512 {
void ring(const Ringing&, const Push*, int, int, float*);
}
#endif

std::vector<Instructions> available_instructions() {
  std::vector<Instructions> all{Instructions::kSse2};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) all.push_back(Instructions::kAvx2);
  if (__builtin_cpu_supports("avx512f")) all.push_back(Instructions::kAvx512);
#endif
  return all;
}

Ring ring(Instructions instructions) {
#if defined(__x86_64__)
  if (instructions == Instructions::kAvx2) return avx2::ring;
  if (instructions == Instructions::kAvx512) return avx512::ring;
#endif
  if (instructions != Instructions::kSse2) throw std::logic_error("this machine does not have these instructions");
  return sse2::ring;
}

const char* name(Instructions instructions) {
  switch (instructions) {
    case Instructions::kAvx2: return "avx2";
    case Instructions::kAvx512: return "avx512";
    default: return "sse2";
  }
}

std::optional<Instructions> find_instructions(std::string_view wanted) {
  const auto all = available_instructions();
  if (wanted == "auto") return all.back();
  const auto found = std::find_if(all.begin(), all.end(), [&](Instructions i) { return name(i) == wanted; });
  return found == all.end() ? std::nullopt : std::optional(*found);
}

ModeStep mode_step(double frequency_Hz, double damping_1_s, double rate_Hz) {
  const double w = 2 * std::numbers::pi * frequency_Hz / rate_Hz, r = std::exp(-damping_1_s / rate_Hz);
  // 1 + r^2 - 2 r cos w, without loss of digits near 0.
  const double half = std::sin(w / 2), lost = -std::expm1(-damping_1_s / rate_Hz);
  const double k = lost * lost + 4 * r * half * half;
  // After a unit impulse v_n = r^n (cos n w - (1 - r cos w) / (r sin w) sin n w), of amplitude sqrt(k) / (r sin
  // w); that of the oscillator is sqrt(1 + (d / w)^2), and has decayed for half a sample.
  const double struck = std::hypot(1, damping_1_s / (2 * std::numbers::pi * frequency_Hz)) * std::sqrt(r);
  return {static_cast<float>(r * r), static_cast<float>(k),
          static_cast<float>(struck * r * std::sin(w) / std::sqrt(k))};
}

}  // namespace tactus::audio
