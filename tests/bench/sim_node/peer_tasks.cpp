#include "tests/bench/sim_node/peer_tasks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <limits>

#include "tests/sim_node/support/hard_scenes.h"

namespace tactus::bench {
namespace {

using namespace tactus::sim;
using namespace tactus::sim::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPercent = 100;

// Processor time of this thread, which other programs on the machine do not spend.
double processor_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Steps a world and times the steps. Velocities are taken from the poses, since engines report them for different instants.
class Course {
 public:
  Course(const MakePeer& make, const WorldDef& world, double h, double seconds, double budget_s)
      : world(world), step_s(h), peer(make(world, h)), steps_(std::lround(seconds / h)), budget_s_(budget_s) {}

  // Calls after(t) after each step until the time or the budget is spent. Returns the cost and the simulated time.
  PeerResult run(const std::function<void()>& before, const std::function<void(double)>& after) {
    PeerResult out;
    double spent_s = 0;
    std::int64_t done = 0;
    while (done < steps_ && spent_s < budget_s_ && finite()) {
      before();
      before_.assign(peer->bodies().begin(), peer->bodies().end());
      const double start_s = processor_s();
      peer->step();
      spent_s += processor_s() - start_s;
      after(static_cast<double>(++done) * step_s);
    }
    out.step_us = 1e6 * spent_s / static_cast<double>(std::max<std::int64_t>(1, done));
    out.simulated_s = static_cast<double>(done) * step_s;
    if (!finite()) out.error = std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  const BodyMotion& motion(int body) const { return peer->bodies()[static_cast<std::size_t>(body)]; }
  // Means over the last step.
  Vector3d velocity_m_s(std::size_t i) const { return (peer->bodies()[i].centre_m - before_[i].centre_m) / step_s; }
  Vector3d spin_rad_s(std::size_t i) const {
    const Eigen::AngleAxisd turn(peer->bodies()[i].orientation * before_[i].orientation.conjugate());
    return turn.angle() / step_s * turn.axis();
  }
  const BodyMotion& before(std::size_t i) const { return before_[i]; }
  // Of free balls without spin at the end of the step, if nothing was struck within it.
  double energy_J() const {
    double sum = 0;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
      const BodyDef& b = world.bodies[i];
      if (b.is_static) continue;
      const Vector3d v = velocity_m_s(i) + step_s / 2 * world.gravity_m_s2;
      sum += 0.5 * b.mass_kg * v.squaredNorm() - b.mass_kg * world.gravity_m_s2.dot(peer->bodies()[i].centre_m);
    }
    return sum;
  }

  const WorldDef& world;
  const double step_s;
  const std::unique_ptr<Peer> peer;

 private:
  bool finite() const {
    for (const BodyMotion& m : peer->bodies())
      if (!m.centre_m.allFinite() || !m.velocity_m_s.allFinite()) return false;
    return true;
  }
  std::int64_t steps_;
  double budget_s_;
  std::vector<BodyMotion> before_;
};

// Sets the error, unless the course ended with a value that is not finite.
PeerResult with_error(PeerResult r, double error) {
  if (!std::isnan(r.error)) r.error = error;
  return r;
}

class MeanSquare {
 public:
  void add(double x) { sum_ += x * x, ++count_; }
  double root() const { return std::sqrt(sum_ / std::max(1, count_)); }

 private:
  double sum_ = 0;
  int count_ = 0;
};

// The median over the last fifth of a course, which steps with an impact hardly change.
class LastFifth {
 public:
  explicit LastFifth(double seconds) : from_s_(0.8 * seconds) {}
  void add(double t, double x) {
    if (t >= from_s_) values_.push_back(x);
  }
  double median() {
    if (values_.empty()) return 0;
    const auto middle = values_.begin() + static_cast<std::ptrdiff_t>(values_.size() / 2);
    std::nth_element(values_.begin(), middle, values_.end());
    return *middle;
  }

 private:
  double from_s_;
  std::vector<double> values_;
};

void nothing() {}

// A plate of 10 kg that is pulled along the floor with 150 N at 60 degrees to the x axis, with 25 balls of 1 kg that roll on it.
// Friction 0.4 below and 0.8 above the plate: it accelerates by (F - mu (M + 25 m) g) / (M + 25 m 2/7), the balls by 2/7 of it.
PeerResult rolling(const MakePeer& make, double h, double seconds, double budget_s) {
  const double force_N = 150, plate_kg = 10, ball_kg = 1, balls = 25;
  WorldDef w = empty_world();
  add_floor(w, 0.2);
  const int plate = add_box(w, plate_kg, {20, 20, 1}, at(0, 0, 0.5), 0.8);
  for (int i = 0; i < 25; ++i) add_ball(w, ball_kg, 0.5, {2.0 * (i % 5) - 4, 2.0 * (i / 5) - 4, 1.5}, 0.8);
  const Vector3d along(std::cos(M_PI / 3), std::sin(M_PI / 3), 0);
  const double pulled = force_N - 0.4 * (plate_kg + balls * ball_kg) * kG, acceleration = pulled / (plate_kg + balls * ball_kg * 2 / 7);
  Course course(make, w, h, seconds, budget_s);
  MeanSquare error;
  // In the first step engines let gravity, and so friction, act for half of it, because velocities are those of its middle.
  double part = 0.5;
  const auto pull = [&] { course.peer->add_force(plate, part * force_N * along), part = 1; };
  const auto result = course.run(pull,
                                 [&](double t) {
                                   const Vector3d truth = (t - h / 2) * acceleration * along;
                                   error.add((course.velocity_m_s(1) - truth).norm());
                                   error.add((course.velocity_m_s(2) - 2.0 / 7 * truth).norm());
                                 });
  return with_error(result, kPercent * error.root() / (seconds * acceleration));
}

// 49 balls that bounce without loss from a height of 5 m.
PeerResult bouncing(const MakePeer& make, double h, double seconds, double budget_s) {
  WorldDef w = empty_world();
  add_floor(w, 0, 1);
  for (int i = 0; i < 49; ++i) add_ball(w, 10, 0.1, {2.0 * (i % 7) - 6, 2.0 * (i / 7) - 6, 5}, 0, 1);
  Course course(make, w, h, seconds, budget_s);
  const double start = 49 * 10 * kG * 5, lowest = 49 * 10 * kG * 0.1;
  LastFifth energy(seconds);
  const auto result = course.run(nothing, [&](double t) { energy.add(t, course.energy_J()); });
  return with_error(result, kPercent * std::abs(energy.median() - start) / (start - lowest));
}

// 216 balls in six layers, 1 cm apart and up to 1 mm beside their places, at this height.
WorldDef balls_666(double lowest_m, double restitution) {
  WorldDef w = empty_world();
  add_floor(w, 0, restitution);
  Random random(42);
  const auto beside = [&] { return uniform(random, 0, 0.001); };
  for (int i = 0; i < 216; ++i) {
    const double x = 0.21 * (i % 6) + beside(), y = 0.21 * (i / 6 % 6) + beside(), z = lowest_m + 0.21 * (i / 36) + beside();
    add_ball(w, 10, 0.1, {x, y, z}, 0, restitution);
  }
  return w;
}

PeerResult hard_666(const MakePeer& make, double h, double seconds, double budget_s) {
  const WorldDef w = balls_666(0.101, 0);
  Course course(make, w, h, seconds, budget_s);
  double deepest = 0;
  const auto result = course.run(nothing, [&](double) {
    for (int i = 1; i <= 216; ++i) {
      const Vector3d& centre = course.motion(i).centre_m;
      deepest = std::max(deepest, 0.1 - centre.z());
      for (int j = i + 1; j <= 216; ++j) deepest = std::max(deepest, 0.2 - (course.motion(j).centre_m - centre).norm());
    }
  });
  return with_error(result, 1e6 * deepest);
}

PeerResult elastic_666(const MakePeer& make, double h, double seconds, double budget_s) {
  const WorldDef w = balls_666(1.101, 1);
  Course course(make, w, h, seconds, budget_s);
  double start = 0;
  for (const BodyDef& b : w.bodies) start += b.is_static ? 0 : b.mass_kg * kG * b.pose.translation().z();
  const double lowest = 216 * 10 * kG * 0.1;
  LastFifth energy(seconds);
  const auto result = course.run(nothing, [&](double t) { energy.add(t, course.energy_J()); });
  return with_error(result, kPercent * std::abs(energy.median() - start) / (start - lowest));
}

// Six floors of eight beams across and nine planks along, 10 kg each, which stand.
PeerResult kapla(const MakePeer& make, double h, double seconds, double budget_s) {
  constexpr double kFriction = 0.8, kMass_kg = 10;
  WorldDef w = empty_world();
  add_floor(w, kFriction);
  const auto add = [&](const Vector3d& size, double x, double y, double z) { add_box(w, kMass_kg, size, at(x, y, z), kFriction); };
  for (int floor = 0; floor < 6; ++floor) {
    const double z = 0.2 * floor;
    for (int i = 0; i < 8; ++i) add({0.05, 0.25, 0.1}, 0.2 * i, 0, z + 0.05);
    for (const double x : {0.1, 0.5, 0.9, 1.3}) add({0.2, 0.05, 0.1}, x, -0.1, z + 0.15);
    for (const double x : {0.1, 0.3, 0.7, 1.1, 1.3}) add({0.2, 0.05, 0.1}, x, 0.1, z + 0.15);
  }
  Course course(make, w, h, seconds, budget_s);
  const auto result = course.run(nothing, [](double) {});
  double moved = 0;
  for (std::size_t i = 0; i < w.bodies.size(); ++i)
    moved = std::max(moved, (course.motion(static_cast<int>(i)).centre_m - w.bodies[i].pose.translation()).norm());
  return with_error(result, 1000 * moved);
}

// A body of the size of a dog: a trunk of 16 kg with four legs of two links, each on a universal joint at the hip and a hinge at
// the knee: 18 degrees of freedom. It has a shape only at the trunk. Design values.
WorldDef quadruped(double height_m) {
  WorldDef w = empty_world();
  const int trunk = add_box(w, 16, {0.5, 0.25, 0.2}, at(0, 0, height_m), 0, 1);
  const auto link = [&](double mass, const Vector3d& centre) {
    return add_body(w, "link", mass, box_inertia(mass, {0.05, 0.05, 0.25}), at(centre.x(), centre.y(), centre.z()));
  };
  for (int leg = 0; leg < 4; ++leg) {
    const Vector3d hip(leg % 2 ? 0.25 : -0.25, leg / 2 ? 0.15 : -0.15, height_m), down(0, 0, -0.25);
    const int thigh = link(2, hip + down / 2);
    add_joint(w, JointKind::kUniversal, trunk, thigh, hip, {1, 0, 0}, {0, 1, 0});
    const int shank = link(0.5, hip + 1.5 * down);
    add_joint(w, JointKind::kRevolute, thigh, shank, hip + down, {0, 1, 0});
  }
  return w;
}

// A ball of 10 kg at 5 m/s strikes the trunk beside its centre, without gravity.
PeerResult momentum(const MakePeer& make, double h, double seconds, double budget_s) {
  WorldDef w = quadruped(0);
  w.gravity_m_s2.setZero();
  const int ball = add_ball(w, 10, 0.2, {0.1, -1, 0.05}, 0, 1);
  body_of(w, ball).velocity_m_s = {0, 5, 0};
  Course course(make, w, h, seconds, budget_s);
  LastFifth lost(seconds);
  const auto result = course.run(nothing, [&](double t) {
    Vector3d sum(0, -10 * 5, 0);
    for (std::size_t i = 0; i < w.bodies.size(); ++i) sum += w.bodies[i].mass_kg * course.velocity_m_s(i);
    lost.add(t, sum.norm() / 50);
  });
  const bool struck = std::abs(course.velocity_m_s(static_cast<std::size_t>(ball)).y() - 5) > 0.1;
  return with_error(result, struck ? kPercent * lost.median() : std::numeric_limits<double>::quiet_NaN());
}

// The same body is thrown up and spins, and its legs swing: its energy over the kinetic energy at the start. The velocity at an
// instant is the mean of those of the steps before and after it.
PeerResult energy(const MakePeer& make, double h, double seconds, double budget_s) {
  WorldDef w = quadruped(2);
  const Vector3d spin(2, 3, 1), up(0, 0, 5), trunk = w.bodies[0].pose.translation();
  for (BodyDef& b : w.bodies) b.spin_rad_s = spin, b.velocity_m_s = up + spin.cross(b.pose.translation() - trunk);
  Course course(make, w, h, seconds, budget_s);
  double kinetic = 0, start = 0;
  for (const BodyDef& b : w.bodies) {
    const double own = 0.5 * b.mass_kg * b.velocity_m_s.squaredNorm() + 0.5 * spin.dot(b.inertia_kg_m2 * spin);
    kinetic += own;
    start += own + b.mass_kg * kG * b.pose.translation().z();
  }
  MeanSquare error;
  std::vector<Vector3d> velocities, spins;  // of the step before
  const auto result = course.run(nothing, [&](double) {
    double sum = 0;
    std::vector<Vector3d> v, spun;
    for (std::size_t i = 0; i < w.bodies.size(); ++i) v.push_back(course.velocity_m_s(i)), spun.push_back(course.spin_rad_s(i));
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      const BodyDef& b = w.bodies[i];
      const BodyMotion& then = course.before(i);
      const Vector3d local = then.orientation.conjugate() * Vector3d((spins[i] + spun[i]) / 2);
      sum += 0.125 * b.mass_kg * (velocities[i] + v[i]).squaredNorm() + 0.5 * local.dot(b.inertia_kg_m2 * local) + b.mass_kg * kG * then.centre_m.z();
    }
    if (!velocities.empty()) error.add((sum - start) / kinetic);
    velocities = v, spins = spun;
  });
  return with_error(result, kPercent * error.root());
}

}  // namespace

const std::vector<PeerTask>& peer_tasks() {
  static const std::vector<PeerTask> tasks{
      {"rolling", "%", "(F - mu (M + 25 m) g) t / (M + 25 m 2/7), and 2/7 of it", 4, rolling},
      {"bouncing", "%", "energy kept", 10, bouncing},
      {"666", "um", "no overlap", 3, hard_666},
      {"elastic_666", "%", "energy kept", 3, elastic_666},
      {"kapla", "mm", "no block moves", 5, kapla},
      {"momentum", "%", "momentum kept", 4, momentum},
      {"energy", "%", "energy kept", 2, energy},
  };
  return tasks;
}

}  // namespace tactus::bench
