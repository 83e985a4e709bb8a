// Number of modes of a vibrating body that one core renders at 48 kHz in blocks of 64: by a plain loop over modes and samples, by STK's
// modal instrument where it is installed, and by bank/ring.h with each instruction set of this machine; driven, ringing freely, and after
// a silence in which all states have become denormal.
//
//    bin/ring_bench [--modes N] [--json FILE]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "audio_node/modal/bank/ring.h"
#if defined(TACTUS_STK)
#include "sync/node/node_options.h"
#include "tests/bench/audio_node/stk_bars.h"
#endif

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

using namespace tactus::audio;

namespace {

constexpr double kRate_Hz = 48000;

__attribute__((noinline)) void plain(const Ringing& m, const Push* pushes, int count, int frames, float* out) {
  for (int i = 0; i < m.modes; ++i) {
    float v = m.velocity[i], u = m.displacement[i];
    for (int n = 0; n < frames; ++n) {
      v = m.damping[i] * v - m.stiffness[i] * u;
      if (count > 0) v += pushes[0].gains[i] * pushes[0].force[n];
      u += v;
      out[n] += v;
    }
    m.velocity[i] = v, m.displacement[i] = u;
  }
}

// Median of rounds interleaved with the other methods; modes at 48 kHz.
struct Variant {
  std::string name;
  std::function<void(int pushes)> block;
  std::vector<double> modes = {};
  double median() {
    std::sort(modes.begin(), modes.end());
    return modes[modes.size() / 2];
  }
};

}  // namespace

int main(int argc, char** argv) {
  std::string json;
  int modes = 1600;
  tactus::sync::Arguments app{"Number of modes that one core renders at 48 kHz."};
  app.add_option("--modes", modes, "of the bank").range(16, 1'000'000);
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "ring_bench", argc, argv);
  modes = (modes + kModeGroup - 1) / kModeGroup * kModeGroup;
#if defined(__SSE__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // denormal numbers are 0, as in the callback
#endif
  struct alignas(64) Line {
    float x[16];
  };
  const auto n = static_cast<std::size_t>(modes) / 16;
  std::vector<Line> memory(5 * n);
  const auto array = [&](std::size_t k) { return memory[k * n].x; };
  for (int i = 0; i < modes; ++i) {
    const ModeStep s = mode_step(100 + 15000.0 * i / modes, 10, kRate_Hz);
    array(0)[i] = s.damping, array(1)[i] = s.stiffness, array(4)[i] = s.unit_gain;
  }
  const Ringing bank{array(0), array(1), array(2), array(3), modes};
  float force[kMaxBlock], out[kMaxBlock];
  for (int k = 0; k < kMaxBlock; ++k) force[k] = static_cast<float>(std::sin(k));
  const Push push{array(4), force};

  const auto bank_of = [&](Ring ring) {
    return [&, ring](int pushes) {
      std::fill(out, out + kMaxBlock, 0.f);
      ring(bank, &push, pushes, kMaxBlock, out);
    };
  };
  constexpr int kBlocks = 20;
  const auto measure = [&](Variant& variant, int pushes) {
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < kBlocks; ++k) variant.block(pushes);
    const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    variant.modes.push_back(modes * kBlocks * kMaxBlock / kRate_Hz / took_s);
  };

  std::printf("%-8s %-8s %14s %10s\n", "modes", "state", "modes / core", "ratio");
  nlohmann::json rows = nlohmann::json::array();
  for (const std::string state : {"pushed", "free", "silent"}) {
    std::vector<Variant> variants{{"plain", bank_of(plain)}};
#if defined(TACTUS_STK)
    StkBars bars(modes, kRate_Hz);
    if (state != "silent") variants.push_back({"stk", [&](int pushes) { bars.block(kMaxBlock, pushes > 0); }});
#endif
    for (const Instructions i : available_instructions()) variants.push_back({name(i), bank_of(ring(i))});
    if (state == "silent")  // 20 s at 10 / s: e^-200
      for (int k = 0; k < 20 * kRate_Hz / kMaxBlock; ++k) variants.back().block(0);
    for (int round = 0; round < 41; ++round)
      for (Variant& variant : variants) measure(variant, state == "pushed" ? 1 : 0);
    const double plainly = variants[0].median();
    for (Variant& variant : variants) {
      std::printf("%-8s %-8s %14.0f %10.1f\n", variant.name.c_str(), state.c_str(), variant.median(),
                  variant.median() / plainly);
      rows.push_back(
          {{"way", variant.name}, {"state", state}, {"modes", variant.median()}, {"ratio", variant.median() / plainly}});
    }
  }
  if (!json.empty()) std::ofstream(json) << rows.dump(1) << "\n";
  return 0;
}
