// Interface for the motion of all bodies of a world and their contacts, one tick at a time: in one world or in two
// groups.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/behaviour/impulse/scene_settings.h"
#include "sim_node/collision/detectors/mesh_trees.h"
#include "sim_node/model/behaviour_model.h"
#include "sim_node/model/body_motion.h"
#include "sim_node/model/group_tool.h"
#include "sim_node/model/ids.h"
#include "sim_node/model/look_ahead.h"
#include "sim_node/model/state_archive.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"
#include "sync/time/time.h"

namespace tactus::sim {

class Mechanics {
 public:
  virtual ~Mechanics() = default;

  // Appends the events of the contacts at the start. Call it once, before the first tick.
  virtual void start(std::span<const GroupTool> tools, std::vector<contact_event_t>& events) = 0;

  // Act during the next tick. Force N at a world point, m; or N and N m at the centre of mass. Static bodies ignore
  // them.
  virtual void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) = 0;
  virtual void add_wrench(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m) = 0;

  // Computes one tick from `now` on and appends its events, in any order. tools: current state. Deterministic, except
  // for the time at which look-ahead results are ready. Real-time safe once the lists have grown.
  virtual void tick(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) = 0;

  // Motion of every body. The caller writes the entries of tools.
  virtual std::span<BodyMotion> motions() = 0;
  // Moving bodies within reach of a tool, ascending; nullopt: any body may be.
  virtual std::optional<std::span<const int>> near_tools() const { return std::nullopt; }
  // Speed of the point along n per unit impulse along n at the point, 1/kg. Joints of a link are included where
  // impulses solve.
  virtual double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n) = 0;
  // Contacts between bodies to be published now; clears the list first.
  virtual void contacts(std::vector<contact_t>& out) = 0;
  // State of the bodies computed ahead; null: not supported.
  virtual const LookAhead* look_ahead() { return nullptr; }

  // Rate of the look-ahead steps, Hz; ignored without look-ahead.
  virtual void set_visual_rate(double) {}

  // Changes while the world runs, in force from the next tick on. Values are not checked here. Returns false when the
  // property does not exist: a static body has no velocity, and a jointed body has no pose and no mass.
  virtual bool apply(const impulse::SceneChange& change) = 0;
  virtual bool set_pose(int body, const Eigen::Isometry3d& pose) = 0;
  virtual bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s) = 0;
  virtual bool set_spin(int body, const Eigen::Vector3d& spin_rad_s) = 0;

  // Archives all state of the next ticks. Throws InvalidState when the data does not fit; the world is then partly
  // changed.
  virtual void archive(StateArchive& a) = 0;
  // Renames the ids of contacts and events to another incarnation, after `ids` has been renamed.
  virtual void rename(std::int64_t incarnation) = 0;
};

using MechanicsFactory = std::function<std::unique_ptr<Mechanics>(const WorldDef&, const Settings&, Ids&)>;

// Makes a behaviour model of another program available as the setting solver = custom:NAME, with groups = single. model: its properties, for the
// checks at start-up; its name is ignored. Call it before run() and from one thread. Throws std::invalid_argument when the name is empty or
// already registered.
void register_behaviour(const std::string& name, const BehaviourModel& model, MechanicsFactory make);

// Creates the implementation that the settings select. trees: of this world. Throws std::runtime_error with one
// sentence when the world cannot be simulated.
std::unique_ptr<Mechanics> make_mechanics(const WorldDef& world, const Settings& settings, Ids& ids,
                                          const std::shared_ptr<MeshTrees>& trees);

}  // namespace tactus::sim
