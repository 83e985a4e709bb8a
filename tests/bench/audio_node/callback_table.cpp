// Cost of a block in the callback of the sound card while 100 bodies of 100 modes ring and are struck repeatedly: median, 99th percentile
// and maximum, as a share of the block's duration, for each instruction set of this machine.
//
//    bin/callback_table [--bodies N] [--modes N] [--frames N] [--seconds S] [--json FILE]
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <utility>
#include <vector>
#include <tactus/presentation_t.hpp>

#include "audio_node/mixer/renderer.h"
#include "audio_node/spatial/space_of.h"
#include "sync/node/node_options.h"

using namespace tactus;
using namespace tactus::audio;

namespace {

constexpr double kRate_Hz = 48000;
constexpr double kStrikes_Hz = 200;  // over all bodies

// Keeps the modes of a body until the program ends.
const Resonators* kept(const Resonators& resonators) {
  static std::deque<Resonators> all;
  return &all.emplace_back(resonators);
}

Strike strike_of(int body, int modes, sync::HostTime at, std::mt19937& random) {
  std::uniform_real_distribution<float> any(0, 1);
  Strike s;
  s.scheduled = at;
  s.pulse = one_hump(20);
  StrikeSide& side = s.sides[0];
  side.voice = body;
  Resonators resonators;
  for (int i = 0; i < modes; ++i) {
    const ModeStep step = mode_step(100 + 15000.0 * i / modes + body, 0.5, kRate_Hz);
    resonators.add(step);
    side.gains[static_cast<std::size_t>(i)] = step.unit_gain;
  }
  side.resonators = kept(resonators);
  side.impulse = 1e-4f;
  const float angle = 2 * std::numbers::pi_v<float> * any(random);
  side.place = {{std::cos(angle), std::sin(angle), 0}, 1 + any(random)};
  return s;
}

double at(const std::vector<double>& sorted, double share) {
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
}

}  // namespace

int main(int argc, char** argv) {
  int bodies = 100, modes = 100, frames = 64;
  double seconds = 10;
  std::string json;
  tactus::sync::Arguments app{"Cost of a block in the audio callback while many bodies ring."};
  app.add_option("--bodies", bodies, "that ring").range(1, kQualities[0].voices);
  app.add_option("--modes", modes, "of each").range(1, kMaxModes);
  app.add_option("--frames", frames, "of a block").range(1, 4096);
  app.add_option("--seconds", seconds, "of sound").range(0.1, 3600.0);
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "callback_table", argc, argv);

  const double period_s = frames / kRate_Hz;
  std::printf("%d bodies of %d modes, blocks of %d frames (%.2f ms), %.0f strikes a second\n", bodies, modes,
              frames, 1e3 * period_s, kStrikes_Hz);
  const Settings settings;
  const std::array<std::pair<const char*, Space>, 2> spaces{
      {{"pair", {}}, {"ears", space_of(settings, kRate_Hz)}}};
  std::printf("%-12s %-6s %8s %8s %8s %10s\n", "instructions", "heard", "p50 %", "p99 %", "most %", "ringing");
  nlohmann::json rows = nlohmann::json::array();
  for (const Instructions use : available_instructions())
    for (const auto& [heard, space] : spaces) {
      std::mt19937 random(1);
      RendererDef def;
      def.period_frames = frames;
      def.instructions = use;
      def.space = space;
      auto queues = std::make_unique<CallbackQueues>();
      auto renderer = std::make_unique<Renderer>(*queues, def);
      RenderCommand all;
      all.quality = 0;
      queues->commands.push(all);
      std::vector<float> stereo(2 * static_cast<std::size_t>(frames));
      std::vector<double> shares;
      const auto blocks = static_cast<int>(seconds / period_s);
      double due = 0;
      for (int k = 0; k < blocks; ++k) {
        const sync::HostTime time = sync::host_time(std::llround(1e9 * k * period_s));
        for (int i = 0; k == 0 && i < bodies; ++i) queues->strikes.push(strike_of(i, modes, time, random));
        for (due += kStrikes_Hz * period_s; due >= 1; --due)
          queues->strikes.push(
              strike_of(static_cast<int>(random() % static_cast<unsigned>(bodies)), modes, time, random));
        const auto begin = std::chrono::steady_clock::now();
        renderer->render(stereo.data(), frames, {time, {}, {}});
        const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        shares.push_back(100 * took_s / period_s);
        for (presentation_t r; queues->reports.pop(r);) continue;
      }
      const int rang = renderer->sounding();
      std::sort(shares.begin(), shares.end());
      std::printf("%-12s %-6s %8.1f %8.1f %8.1f %10s\n", name(use), heard, at(shares, 0.5), at(shares, 0.99),
                  shares.back(), std::to_string(rang).c_str());
      rows.push_back({{"instructions", name(use)},
                      {"heard", heard},
                      {"p50_percent", at(shares, 0.5)},
                      {"p99_percent", at(shares, 0.99)},
                      {"most_percent", shares.back()},
                      {"ringing", rang}});
    }
  if (!json.empty()) std::ofstream(json) << rows.dump(1) << "\n";
  return 0;
}
