#include "audio_node/spatial/diffuse_field.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "audio_node/spatial/hull.h"

using namespace tactus::audio;

TEST_CASE("The response common to all directions is removed") {
  // 1 + 0.5 z^-1 has minimum phase, and the inverse (-0.5)^n, of which 1e-7 remains after 24 samples.
  const auto inverse = diffuse_field_inverse({{1, 0.5f}, {1, 0.5f}, {1, 0.5f}}, {1, 2, 1}, 24);
  REQUIRE(inverse.size() == 24);
  for (std::size_t n = 0; n < inverse.size(); ++n)
    CHECK(static_cast<double>(inverse[n]) == Approx(std::pow(-0.5, n)).margin(1e-6));
}

TEST_CASE("A direction that was measured twice counts once, by its part of the sphere") {
  // Where directions are dense the responses differ.
  std::vector<Eigen::Vector3d> directions;
  for (const double z : {-1.0, 0.0, 0.8, 0.9})
    for (int i = 0; i < 8; ++i) {
      const double azimuth = std::numbers::pi * (i / 4.0 + z), r = std::sqrt(1 - z * z);
      directions.emplace_back(r * std::cos(azimuth), r * std::sin(azimuth), z);
      if (z < -0.99) break;
    }
  const auto inverse = [](const std::vector<Eigen::Vector3d>& of) {
    std::vector<std::vector<float>> responses;
    for (const auto& d : of) responses.push_back({1, static_cast<float>(0.6 * d.z())});
    return diffuse_field_inverse(responses, solid_angles(of), 24);
  };
  const auto once = inverse(directions);
  auto twice = directions;
  for (std::size_t i = 12; i < 20; ++i) twice.push_back(directions[i]);
  const auto doubled = inverse(twice);
  // Points are nudged by 1e-6 to make the hull.
  for (std::size_t n = 0; n < once.size(); ++n)
    CHECK(static_cast<double>(doubled[n]) == Approx(static_cast<double>(once[n])).margin(2e-5));
}
