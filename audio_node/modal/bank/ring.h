// How many damped oscillators ring on for a block, pushed or not: the inner loop of modal sound, compiled once for
// each set of vector instructions and chosen when the program runs. Pure.
//
// A mode is a mass on a spring, stepped so that its frequency and damping are exact:
//
//   v <- c v - k u + g force,   u <- u + v,   c = r^2,  k = 1 + r^2 - 2 r cos w
//
// whose poles are r e^(+-i w). That is the direct two-pole with the difference of its two samples for a state: at
// low frequencies its coefficients lose nothing in single precision (those of the direct form lie near 2 and 1:
// rounding the first may put 40 Hz at 48 kHz off by 0.1 %). Its velocity v is what is heard.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace tactus::audio {

inline constexpr int kMaxBlock = 64;   // frames that are rendered at once
inline constexpr int kModeGroup = 16;  // modes are computed in groups of so many

// A force on a body at one place: how strongly it drives each mode, and its samples.
struct Push {
  const float* gains;  // of each mode; aligned to 64 bytes
  const float* force;  // of each frame
};

// All arrays of modes: `modes` long, a multiple of kModeGroup, aligned to 64 bytes; unused modes are zero.
struct Ringing {
  const float* damping;    // c
  const float* stiffness;  // k
  float* velocity;         // v, kept from block to block
  float* displacement;     // u
  int modes;
};

// Adds the sum of all modes' velocities to `out`. frames <= kMaxBlock. Realtime-safe: yes; denormal numbers are
// the caller's to flush.
using Ring = void (*)(const Ringing& modes, const Push* pushes, int count, int frames, float* out);

// The instructions it may use. The same bits come out for the same instructions, others may round otherwise.
enum class Instructions { kSse2, kAvx2, kAvx512 };

// Those that this machine has, the widest last. kSse2 stands for what every machine has, also one of another kind.
std::vector<Instructions> available_instructions();
Ring ring(Instructions instructions);
const char* name(Instructions instructions);
// sse2, avx2, avx512, or auto: the widest there is. Nothing: no such name, or the machine lacks them.
std::optional<Instructions> instructions_named(std::string_view name);

// Coefficients of one mode of that damped frequency, and the factor on a gain so that a unit impulse makes the
// velocity of a unit mass: exp(-d t) (cos w t - d / w sin w t), in the middle of each sample.
struct ModeStep {
  float damping, stiffness;
  float unit_gain;
};
ModeStep mode_step(double frequency_Hz, double damping_1_s, double rate_Hz);

}  // namespace tactus::audio
