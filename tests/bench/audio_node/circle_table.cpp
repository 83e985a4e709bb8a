// Interaural time and level differences of a source on a circle around the head: ours, as the callback renders it at 48 kHz, and those of
// the SOFA file's responses. A negative time: the left ear leads.
//
//    bin/circle_table [--json FILE]
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sync/node/node_options.h"
#include "tests/audio_node/support/kemar.h"

using namespace tactus::audio;

int main(int argc, char** argv) {
  std::string json;
  tactus::sync::Arguments app{"Time and level differences between the ears on a circle."};
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "circle_table", argc, argv);

  constexpr std::array<int, 3> kOctaves_Hz{500, 2000, 8000};
  std::printf("%-8s %12s %12s", "azimuth", "ITD us", "measured");
  for (const int f : kOctaves_Hz) std::printf(" %8d Hz dB %9s", f, "measured");
  std::printf("\n");
  nlohmann::json rows = nlohmann::json::array();
  double worst_us = 0;
  std::array<double, 3> worst_dB{};
  for (int azimuth = -180; azimuth <= 180; azimuth += 5) {
    const test::BinauralResponse ours = test::rendered_response(test::towards(azimuth)), measured = test::measured_response(azimuth);
    const double theirs_Hz = test::kemar().rate_Hz, ours_us = test::time_difference_us(ours, 48000),
                 measured_us = test::time_difference_us(measured, theirs_Hz);
    std::printf("%-8d %12.0f %12.0f", azimuth, ours_us, measured_us);
    nlohmann::json row{{"azimuth_deg", azimuth}, {"ours_us", ours_us}, {"measured_us", measured_us}};
    worst_us = std::max(worst_us, std::abs(ours_us - measured_us));
    for (std::size_t i = 0; i < kOctaves_Hz.size(); ++i) {
      const double from_Hz = kOctaves_Hz[i] / std::sqrt(2), to_Hz = kOctaves_Hz[i] * std::sqrt(2);
      const double a = test::level_difference_dB(ours, 48000, from_Hz, to_Hz);
      const double b = test::level_difference_dB(measured, theirs_Hz, from_Hz, to_Hz);
      std::printf(" %14.2f %9.2f", a, b);
      const std::string octave = std::to_string(kOctaves_Hz[i]);
      row["ours_" + octave + "_dB"] = a, row["measured_" + octave + "_dB"] = b;
      worst_dB[i] = std::max(worst_dB[i], std::abs(a - b));
    }
    std::printf("\n");
    rows.push_back(row);
  }
  std::printf("worst    %12.0f us", worst_us);
  for (std::size_t i = 0; i < worst_dB.size(); ++i) std::printf(", %.2f dB at %d Hz", worst_dB[i], kOctaves_Hz[i]);
  std::printf("\n");
  if (!json.empty()) std::ofstream(json) << rows.dump(1) << "\n";
  return 0;
}
