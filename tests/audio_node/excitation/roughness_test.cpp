#include "audio_node/excitation/roughness.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace tactus::audio;

namespace {

// Slopes along a line, at intervals of step_m.
std::vector<double> line(const Roughness& of, const Eigen::Vector3d& along, double step_m, int count) {
  std::vector<double> all;
  for (int begin = 0; begin < count; begin += 64) {
    float slope[64] = {}, other[64] = {};
    add_slopes(of, {(begin * step_m) * along, step_m * along, Eigen::Vector3d::Zero()}, along.cast<float>(),
               Eigen::Vector3f::Zero(), 64, slope, other);
    for (const float s : slope) all.push_back(static_cast<double>(s));
  }
  return all;
}

const Eigen::Vector3d kOblique = Eigen::Vector3d(3, 1, -2).normalized();

}  // namespace

TEST_CASE("Heights and slopes of roughness have the requested mean square in any direction") {
  const Roughness of{2e-6, 0};
  const Eigen::Vector3d along = GENERATE(Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), kOblique);
  // A quarter of the finest grain, so that nothing is omitted: 0.25 m in total. The longest waves, of 2.4 mm where
  // a line crosses them at a third, occur about 100 to 600 times: their mean square has an error of a tenth.
  const double step_m = 0.4e-6;
  const auto slopes = line(of, along, step_m, 640'000);
  double height = 0, square_height = 0, mean = 0, square_slope = 0;
  for (const double s : slopes) {
    height += s * step_m;
    mean += height, square_height += height * height, square_slope += s * s;
  }
  const auto n = static_cast<double>(slopes.size());
  CHECK(std::sqrt(square_height / n - mean / n * mean / n) == Approx(of.height_m).epsilon(0.1));
  CHECK(square_slope / n == Approx(mean_square_slope(of)).epsilon(0.05));
}

TEST_CASE("Roughness is fractal: height differences over twice the distance are larger by 2^H") {
  const double step_m = 0.4e-6;
  const auto slopes = line({2e-6, 0}, kOblique, step_m, 640'000);
  std::vector<double> heights{0};
  for (const double s : slopes) heights.push_back(heights.back() + s * step_m);
  const auto differ = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = lag; i < heights.size(); ++i) sum += std::pow(heights[i] - heights[i - lag], 2);
    return sum / static_cast<double>(heights.size() - lag);
  };
  // From 8 um to 64 um, between the finest grain and the longest wave. The finite sum of octaves bends the law at
  // either end: by 2^(-2 (1 - H) 2.3 octaves) of the slope below and less above.
  const double exponent = 0.5 * std::log2(differ(160) / differ(20)) / 3;
  CHECK(exponent == Approx(kHurst).margin(0.08));
}

TEST_CASE("Roughness below a map has no waves that the map resolves") {
  const double step_m = 0.4e-6;
  const auto long_waves = [&](double texel_m) {
    const auto slopes = line({2e-6, texel_m}, kOblique, step_m, 64'000);
    double height = 0, most = 0;
    for (const double s : slopes) most = std::max(most, std::abs(height += s * step_m));
    return most;
  };
  // Grains of at most 25 um: four octaves less, 2^(-4 H) of the height.
  CHECK(long_waves(25e-6) < 0.25 * long_waves(0));
  CHECK(mean_square_slope({2e-6, 25e-6}) < mean_square_slope({2e-6, 0}));
  CHECK(mean_square_slope({2e-6, 1e-9}) == 0);
}

TEST_CASE("A surface without roughness has no slope, and a contact at rest has a constant slope") {
  CHECK(line({0, 0}, kOblique, 1e-6, 64) == std::vector<double>(64, 0.0));
  const auto still = line({2e-6, 0}, kOblique, 0, 64);
  for (const double s : still) CHECK(s == still[0]);
}
