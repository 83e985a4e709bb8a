// Mechanics of all bodies in one world, at the tick rate.
#pragma once

#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/behaviour/mechanics.h"
#include "sim_node/behaviour/solver.h"
#include "sim_node/contacts/contact_tracker.h"

namespace tactus::sim {

class SingleGroup : public Mechanics {
 public:
  SingleGroup(const WorldDef& world, const Settings& settings, Ids& ids);

  void start(std::span<const GroupTool> tools, std::vector<contact_event_t>& events) override;
  void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) override {
    solver_.add_force(body, force_N, point_m);
  }
  void add_wrench(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m) override {
    solver_.add_force(body, force_N, solver_.bodies()[static_cast<std::size_t>(body)].centre_m);
    solver_.add_torque(body, torque_N_m);
  }
  void tick(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) override;
  std::span<BodyMotion> motions() override { return motions_; }
  double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n) override {
    return solver_.mobility(body, point_m, n);
  }
  void contacts(std::vector<contact_t>& out) override;

  bool apply(const impulse::SceneChange& change) override { return solver_.apply(change); }
  bool set_pose(int body, const Eigen::Isometry3d& pose) override { return updated(solver_.set_pose(body, pose)); }
  bool set_velocity(int body, const Eigen::Vector3d& v) override { return updated(solver_.set_velocity(body, v)); }
  bool set_spin(int body, const Eigen::Vector3d& spin) override { return updated(solver_.set_spin(body, spin)); }

  void archive(StateArchive& a) override;
  void rename(std::int64_t) override { tracker_.rename(); }

  const Solver& solver() const { return solver_; }

 private:
  // Makes a change effective immediately.
  bool updated(bool done) {
    read();
    return done;
  }
  void read();
  void detect_contacts(sync::SimTime now, std::vector<contact_event_t>& events);

  sync::Nanoseconds step_;
  Solver solver_;
  ContactTracker tracker_;
  std::vector<BodyMotion> motions_;
};

}  // namespace tactus::sim
