#include "sim_node/model/archive_motion.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

using namespace tactus::sim;

namespace {

BodyMotion moving() {
  BodyMotion m;
  m.position_m = m.centre_m = {1, 2, 3};
  m.velocity_m_s = {-1, 0, 4}, m.spin_rad_s = {0, 5, 0};
  m.inverse_mass_1_kg = 2, m.inverse_inertia = Eigen::Matrix3d::Identity() * 7;
  return m;
}

// Whether a state with this motion can be restored.
bool restored(BodyMotion m) {
  StateArchive write;
  archive(write, m);
  StateArchive read(write.bytes());
  BodyMotion again;
  try {
    archive(read, again);
  } catch (const InvalidState&) {
    return false;
  }
  CHECK(again.position_m == m.position_m);
  CHECK(again.inverse_inertia == m.inverse_inertia);
  return true;
}

}  // namespace

TEST_CASE("Each number of a restored motion has its range") {
  struct Field {
    const char* name;
    std::function<double&(BodyMotion&)> of;
    double least, most;
  };
  const Field fields[] = {
      {"position", [](BodyMotion& m) -> double& { return m.position_m.y(); }, -kMaxPosition_m, kMaxPosition_m},
      {"centre", [](BodyMotion& m) -> double& { return m.centre_m.z(); }, -kMaxPosition_m, kMaxPosition_m},
      {"velocity", [](BodyMotion& m) -> double& { return m.velocity_m_s.x(); }, -kMaxRate, kMaxRate},
      {"spin", [](BodyMotion& m) -> double& { return m.spin_rad_s.z(); }, -kMaxRate, kMaxRate},
      {"inverse mass", [](BodyMotion& m) -> double& { return m.inverse_mass_1_kg; }, 0, kMaxMobility},
      {"inverse inertia", [](BodyMotion& m) -> double& { return m.inverse_inertia(1, 2); }, -kMaxMobility, kMaxMobility}};
  REQUIRE(restored(moving()));
  for (const Field& field : fields) {
    CAPTURE(field.name);
    const auto with = [&](double value) {
      BodyMotion m = moving();
      field.of(m) = value;
      return restored(m);
    };
    CHECK(with(field.least));
    CHECK(with(field.most));
    for (const double beyond : {std::nextafter(field.least, -1e300), std::nextafter(field.most, 1e300), -1e300, 1e300, double(-INFINITY), double(INFINITY), double(NAN)})
      CHECK_FALSE(with(beyond));
  }
}

TEST_CASE("A restored orientation has unit length") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    BodyMotion m = moving();
    Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    m.orientation = q.normalized();
    CHECK(restored(m));
    const double length = i % 2 == 0 ? 1 + 2e-3 + std::abs(normal(random)) : 1 / (1 + 2e-3 + std::abs(normal(random)));
    m.orientation.coeffs() *= length;
    CHECK_FALSE(restored(m));
  }
  BodyMotion none = moving();
  none.orientation.coeffs().setZero();
  CHECK_FALSE(restored(none));
}
