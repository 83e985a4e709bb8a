// What moves the bodies of a world and follows their contacts, one tick at a time: all bodies in one world, or in
// two groups.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tactus/contact_event_t.hpp>
#include <tactus/contact_t.hpp>
#include <vector>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/group_tool.h"
#include "sim_node/behaviour/impulse/scene_settings.h"
#include "sim_node/model/ids.h"
#include "sim_node/collision/detectors/mesh_trees.h"
#include "sim_node/model/ahead.h"
#include "sim_node/model/world_def.h"
#include "sim_node/settings.gen.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

class Mechanics {
 public:
  virtual ~Mechanics() = default;

  // The world at its first instant: appends the events of what touches then. Once, before the first tick.
  virtual void start(std::span<const GroupTool> tools, std::vector<contact_event_t>& events) = 0;

  // Act during the next tick: N at a point of the world, m; N and N m at the centre of mass. What never moves ignores it.
  virtual void add_force(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& point_m) = 0;
  virtual void add_wrench(int body, const Eigen::Vector3d& force_N, const Eigen::Vector3d& torque_N_m) = 0;

  // One tick, from `now` on; appends the events that it reached, in any order. tools: as they are now.
  // Deterministic, but for when what is computed ahead is there. Realtime-safe once the lists have grown.
  virtual void tick(sync::SimTime now, std::span<const GroupTool> tools, std::vector<contact_event_t>& events) = 0;

  // Of every body. The entries of tools are the caller's to write.
  virtual std::span<BodyMotion> motions() = 0;
  // Bodies that move and that a tool may touch, ascending; none: any may be.
  virtual std::optional<std::span<const int>> near_tools() const { return std::nullopt; }
  // Speed that a unit impulse along n at the point gives to that point, 1/kg: of a link with its joints, where impulses
  // solve.
  virtual double mobility(int body, const Eigen::Vector3d& point_m, const Eigen::Vector3d& n) = 0;
  // Contacts between bodies that are told of at the present instant; clears the list.
  virtual void contacts(std::vector<contact_t>& out) = 0;
  // Of the bodies that are computed ahead; null: none ever are.
  virtual const Ahead* ahead() { return nullptr; }

  // Steps of what is computed ahead, a second; nothing where nothing is.
  virtual void set_visual_rate(double) {}

  // What may be set while the world runs; each holds from the next tick on. Values are not checked here. False: it
  // has none, as a body that does not move has no velocity, and one on a joint no pose and no mass.
  virtual bool apply(const impulse::SceneChange& change) = 0;
  virtual bool set_pose(int body, const Eigen::Isometry3d& pose) = 0;
  virtual bool set_velocity(int body, const Eigen::Vector3d& velocity_m_s) = 0;
  virtual bool set_spin(int body, const Eigen::Vector3d& spin_rad_s) = 0;

  // All that the next ticks depend on. Throws BadState when what is read does not fit; this is then half changed.
  virtual void archive(StateArchive& a) = 0;
  // The ids of contacts and events go by another incarnation, under which `ids` go already.
  virtual void rename(std::int64_t incarnation) = 0;
};

// As the settings say. trees: of this world. Throws std::runtime_error with one sentence when the world cannot be simulated.
std::unique_ptr<Mechanics> make_mechanics(const WorldDef& world, const Settings& settings, Ids& ids,
                                          const std::shared_ptr<MeshTrees>& trees);

}  // namespace tactus::sim
