// Damped oscillators over one block, with or without forces: the inner loop of modal sound, compiled once for each
// set of vector instructions and selected at run time. Pure.
//
// A mode is a mass on a spring, stepped so that its frequency and damping are exact:
//
//   v <- c v - k u + g force,   u <- u + v,   c = r^2,  k = 1 + r^2 - 2 r cos w
//
// with the poles r e^(+-i w). It is the direct two-pole filter with the difference of its two samples as a state.
// At low frequencies its coefficients lose nothing in single precision (those of the direct form lie near 2 and 1:
// rounding the first may shift 40 Hz at 48 kHz by 0.1 %). Its velocity v is the sound.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace tactus::audio {

inline constexpr int kMaxBlock = 64;   // frames that are rendered in one call
inline constexpr int kModeGroup = 16;  // modes are computed in groups of this size

// A force on a body at one place: the gain of each mode, and its samples.
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

// Adds the sum of the velocities of all modes to `out`. frames <= kMaxBlock. Realtime-safe: yes; the caller must
// flush denormal numbers.
using Ring = void (*)(const Ringing& modes, const Push* pushes, int count, int frames, float* out);

// Vector instructions in use. The same instructions give the same bits; others may round differently.
enum class Instructions { kSse2, kAvx2, kAvx512 };

// Instructions of this machine, the widest last. kSse2 is available on every machine, also on other architectures.
std::vector<Instructions> available_instructions();
Ring ring(Instructions instructions);
const char* name(Instructions instructions);
// sse2, avx2, avx512, or auto: the widest available. Empty: no such name, or not available on this machine.
std::optional<Instructions> find_instructions(std::string_view name);

// Coefficients of one mode of that damped frequency. unit_gain: factor on a gain with which a unit impulse gives
// the velocity of a unit mass: exp(-d t) (cos w t - d / w sin w t), in the middle of each sample.
struct ModeStep {
  float damping, stiffness;
  float unit_gain;
};
ModeStep mode_step(double frequency_Hz, double damping_1_s, double rate_Hz);

}  // namespace tactus::audio
