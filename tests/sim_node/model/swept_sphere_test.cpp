#include "sim_node/model/swept_sphere.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "sim_node/model/bounds_grid.h"

using namespace tactus::sim;

namespace {

struct DrawnSpheres {
  std::mt19937 random{7};
  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); }
  Eigen::Vector3d point(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  SweptSphere sphere() {
    SweptSphere s{point(1), point(20), between(0.01, 0.1), between(0, 0.02)};
    if (random() % 5 == 0) s.velocity_m_s.setZero();
    return s;
  }
};

// Minimum distance of the centres in linear motion at equal times within the horizon.
double closest_approach_m(const SweptSphere& a, const SweptSphere& b, double horizon_s) {
  const Eigen::Vector3d apart = b.centre_m - a.centre_m, closing = b.velocity_m_s - a.velocity_m_s;
  const double speed2 = closing.squaredNorm();
  const double when = speed2 > 0 ? std::clamp(-apart.dot(closing) / speed2, 0.0, horizon_s) : 0;
  return (apart + closing * when).norm();
}

constexpr double kHorizon_s = 0.017;

}  // namespace

TEST_CASE("The closest approach of two linear motions matches a fine sampling of time") {
  DrawnSpheres c;
  for (int round = 0; round < 300; ++round) {
    const SweptSphere a = c.sphere(), b = c.sphere();
    double least = 1e9;
    for (int k = 0; k <= 2000; ++k) {
      const double t = kHorizon_s * k / 2000;
      least = std::min(least, (a.centre_m + a.velocity_m_s * t - b.centre_m - b.velocity_m_s * t).norm());
    }
    CHECK(closest_approach_m(a, b, kHorizon_s) <= least + 1e-12);
    CHECK(closest_approach_m(a, b, kHorizon_s) >= least - 1e-3);  // 70 m/s, 8.5 us
  }
}

TEST_CASE("The first contact time of two linear motions matches a fine sampling of time, if there is one") {
  DrawnSpheres c;
  int met = 0;
  for (int round = 0; round < 1000; ++round) {
    const SweptSphere a = c.sphere(), b = c.sphere();
    const double distance = c.between(0.1, 1);
    const double when = first_contact_time_s(a, b, distance, kHorizon_s);
    CHECK((when >= 0) == (closest_approach_m(a, b, kHorizon_s) <= distance));
    if (when <= 0) continue;
    ++met;
    const auto apart = [&](double t) {
      return (a.centre_m + a.velocity_m_s * t - b.centre_m - b.velocity_m_s * t).norm();
    };
    CHECK(apart(when) == Approx(distance).epsilon(1e-9));
    for (int k = 0; k < 100; ++k) CHECK(apart(when * k / 100) > distance);
  }
  CHECK(met > 20);
}

TEST_CASE(
    "The distance of two capsule axes matches a fine sampling and never exceeds that of the motions") {
  DrawnSpheres c;
  for (int round = 0; round < 100; ++round) {
    SweptSphere a = c.sphere(), b = c.sphere();
    if (round % 4 == 0) b.velocity_m_s = a.velocity_m_s * c.between(-2, 2);  // parallel
    double least = 1e9;
    for (int k = 0; k <= 100; ++k)
      for (int l = 0; l <= 100; ++l)
        least = std::min(least, (a.centre_m + a.velocity_m_s * (kHorizon_s * k / 100) - b.centre_m -
                                 b.velocity_m_s * (kHorizon_s * l / 100))
                                    .norm());
    CHECK(axis_distance_m(a, b, kHorizon_s) <= least + 1e-12);
    CHECK(axis_distance_m(a, b, kHorizon_s) >= least - 0.008);  // 35 m/s for a hundredth of the horizon each
    CHECK(axis_distance_m(a, b, kHorizon_s) <= closest_approach_m(a, b, kHorizon_s) + 1e-12);
    CHECK(axis_distance_m(a, b, kHorizon_s) == Approx(axis_distance_m(b, a, kHorizon_s)).margin(1e-9));
  }
}

TEST_CASE("A grid finds exactly the boxes that overlap the query") {
  DrawnSpheres c;
  const double spread = GENERATE(0.5, 50.0, 1e7);
  std::vector<Bounds> boxes;
  for (int i = 0; i < 500; ++i) {
    SweptSphere s = c.sphere();
    s.centre_m *= spread;
    if (i % 50 == 0) s.radius_m *= 100;
    boxes.push_back(bounds_of(s, kHorizon_s));
  }
  BoundsGrid grid;
  grid.build({});
  std::vector<int> none;
  grid.find(boxes[0], none);
  CHECK(none.empty());
  grid.build(boxes);
  for (int round = 0; round < 200; ++round) {
    SweptSphere s = c.sphere();
    s.centre_m *= spread;
    if (round % 20 == 0) s.radius_m *= 300;
    const Bounds query = bounds_of(s, kHorizon_s);
    std::vector<int> expected{-1}, found{-1};
    for (int i = 0; i < 500; ++i)
      if (boxes[static_cast<std::size_t>(i)].overlaps(query)) expected.push_back(i);
    grid.find(query, found);
    CHECK(found == expected);
  }
}
