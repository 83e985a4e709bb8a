// The proof engine by our impulse solver and joint coordinates.
#include "tests/bench/sim_node/proof_engine.h"
#include "tests/sim_node/support/articulated_trees.h"
#include "tests/sim_node/support/toys.h"

namespace tactus::bench {
namespace {

using namespace tactus::sim;
using namespace tactus::sim::test;

class Ours : public Engine {
 public:
  void set_gravity(const Eigen::Vector3d& g) override { toys_.gravity_m_s2 = g; }
  void plane(const Eigen::Vector3d& n, double friction, double restitution) override {
    toys_.plane(n, {0, 0, 0}, friction, restitution);
  }
  int ball(double mass, double r, const Eigen::Vector3d& place, double friction, double restitution) override {
    return toys_.ball(mass, r, place, friction, restitution);
  }
  int box(double mass, const Eigen::Vector3d& size, const Eigen::Isometry3d& pose, double friction,
          double restitution) override {
    return toys_.box(mass, size, pose, friction, restitution);
  }
  int rod(double mass, double length, double r, const Eigen::Isometry3d& pose, double friction) override {
    return toys_.rod(mass, length, r, pose, friction);
  }
  void chain(int links, double about_vertical) override {
    articulated::ArticulatedSystem s(horizontal_chain(links));
    auto state = s.state();
    state.rates[1] = about_vertical;
    s.set_state(state);
    jointed_ = add_system(toys_.world, std::move(s));
  }
  int hanging_rod(double restitution) override {
    articulated::LinkDef link = rod_link(-1, JointKind::kBall, {0, 0, 0}, {0, 0, -1});
    link.gravity_m_s2 = toys_.gravity_m_s2;
    jointed_ = add_system(toys_.world, articulated::ArticulatedSystem({link}));
    return toys_.capsule(jointed_, 0.1, 0.01, {0, 0, 1}, 0, restitution);
  }
  void pendulum(double angle) override {
    articulated::LinkDef link = rod_link(-1, JointKind::kRevolute, {0, 0, 0}, {0, 0, -1});
    link.axes[0].axis = {0, 1, 0};
    articulated::ArticulatedSystem s({link});
    auto state = s.state();
    state.positions[0] = angle;
    s.set_state(state);
    jointed_ = add_system(toys_.world, std::move(s));
  }
  void set_motion(int body, const Eigen::Vector3d& v, const Eigen::Vector3d& w) override {
    toys_.world.free_body(body).velocity_m_s = v;
    toys_.world.free_body(body).spin_rad_s = w;
  }
  void step(double h) override { toys_.step(h); }
  Eigen::Vector3d position(int body) override { return toys_.motion(body).centre_m; }
  Eigen::Quaterniond orientation(int body) override { return toys_.motion(body).orientation; }
  Eigen::Vector3d velocity(int body) override { return toys_.world.free_body(body).velocity_m_s; }
  Eigen::Vector3d spin(int body) override { return toys_.world.free_body(body).spin_rad_s; }
  Eigen::Vector3d link_spin() override { return toys_.world.system_of(jointed_).motion(0).spin_rad_s; }
  double contact_force_N() override { return toys_.force_N(); }
  double chain_energy_J() override { return energy_J(toys_.world.system_of(jointed_)); }
  double joint_gap_m() override { return 0; }  // joint coordinates have no gap
  double pendulum_angle_rad() override { return toys_.world.system_of(jointed_).state().positions[0]; }

 private:
  Toys toys_;
  int jointed_ = -1;
};

}  // namespace

std::unique_ptr<Engine> make_ours() { return std::make_unique<Ours>(); }

}  // namespace tactus::bench
