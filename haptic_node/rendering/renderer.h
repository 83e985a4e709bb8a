// One tick of haptic rendering: from the touch model, the due events and the device state to the force on the
// hand, the tool state and the reports. Pure: no clock, no bus, no device.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <tactus/contact_event_t.hpp>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <tactus/tool_state_t.hpp>
#include <vector>

#include "haptic_node/contact/contact_impulses.h"
#include "haptic_node/contact/pending_onsets.h"
#include "haptic_node/contact/reliefs.h"
#include "haptic_node/contact/surfaces.h"
#include "haptic_node/contact/touch_model_view.h"
#include "haptic_node/devices/device.h"
#include "haptic_node/rendering/coupling.h"
#include "haptic_node/rendering/force_crossfade.h"
#include "haptic_node/rendering/force_method.h"
#include "haptic_node/rendering/force_stage.h"
#include "haptic_node/rendering/transient.h"
#include "haptic_node/safety/passivity.h"
#include "haptic_node/safety/safety.h"
#include "haptic_node/safety/wall_energy.h"
#include "haptic_node/settings.gen.h"
#include "sync/resampling/sample_status.h"
#include "sync/time/time.h"

namespace tactus::haptic {

struct TickInput {
  sync::HostTime now{};
  DeviceState device;
  // A touch model of this tool that has not been given before; null: none.
  TouchModelView fresh;
  // The simulation has begun again, and its models describe another world than before.
  bool restarted = false;
  // When the newest touch model arrived, raw; nothing: none yet.
  std::optional<sync::HostTime> touch_arrival;
  // Map between simulated time and the host clock; empty: not known.
  std::optional<sync::TimeMap> map;
  // transient_delay: delay of hit transients, in addition to the setting. touch_delay: intended delay of the touch
  // models; surfaces are rendered as they were that much earlier.
  sync::Nanoseconds transient_delay{0}, touch_delay{0};
  // The force is commanded in steps of this size; 0: no steps.
  double force_step_N = 0;
  // Operators of the stage `force`, and the list for their decisions; null: none.
  sync::OperatorChain* force_stage = nullptr;
  sync::Decisions* force_decisions = nullptr;
  // Time by which the stage `action` delays the motion of the hand on its way to the world, s.
  double action_delay_s = 0;
  // Number of planes of a touch model that are considered.
  std::size_t planes = Surfaces::kMaxPresent;
  // Contact events that have become due; each is passed exactly once.
  std::span<const contact_event_t> events;
};

struct TickOutput {
  tool_state_t state{};
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();     // on the hand, in the world frame; to command now
  Eigen::Vector3d torque_N_m = Eigen::Vector3d::Zero();  // as force_N
  std::vector<presentation_t> reports;
};

class Renderer {
 public:
  // Reads the scene and keeps no reference to it. tool: index in its tools. safety: belongs to the process and
  // outlives this.
  Renderer(const scene_t& scene, int tool, const Settings& settings, Safety& safety);

  // Applies changed settings from the next tick on, as far as they can change while it runs; not the limits of
  // safety.
  void change(const Settings& settings);

  // Relief and friction maps of the scene, used from the next tick on; null: none.
  void set_maps(std::shared_ptr<const SurfaceMaps> maps) { reliefs_.set_maps(std::move(maps)); }

  // Call once per tick. The output is valid until the next call. Realtime-safe: yes, except for the growth of
  // lists in the first ticks.
  TickOutput& step(const TickInput& in);

  // True while the touch model is lost.
  bool lost() const { return fade_.lost(); }
  // True while the device is lost.
  bool device_lost() const { return device_.lost; }
  // Timing of the device, and the stiffness that it leaves for a wall, N/m: lower than that of a device that is read
  // and commanded in the tick itself. softened: touch is less than 0.7 as stiff as with such a device.
  struct DeviceLimit {
    DeviceLoop loop;
    double stiffness_N_m = 0;
    bool softened = false;
  };
  DeviceLimit device_limit() const;

 private:
  // Factor on the wanted force: below 1 while the touch model or the device is lost or has just returned.
  double force_scale() const { return fade_.value() * device_share_; }
  // The commanded force of the surfaces and of the hit transients, after all limits.
  struct Commanded {
    Wrench constraint;
    Eigen::Vector3d transient_N;
  };
  void update_device(const TickInput& in);
  // Period for which a force is held, s.
  double hold_s() const { return std::max(period_s_, device_.loop.period_s); }
  Gains gains(const Surface& s) const;
  Wrench limited(const Wrench& wanted, double dt, ForceOutput to);
  // Surfaces that appear now may be above a hand that is already inside. A jump of 10 mm is followed within four recovery
  // times (surfaces.h).
  void begin_touch() {
    returning_s_ = 4 * settings_.recovery_time_s + 2 * period_s_;
    since_begin_s_ = 0;
  }
  // The device has dropped the force, and the hand may be anywhere: touch restarts, as after a lost device.
  void restart_touch();
  void update_surfaces(const TickInput& in, double dt);
  void handle_events(const TickInput& in);
  Hit hit_of(const contact_event_t& e, sync::HostTime scheduled) const;
  Wrench constraint_wrench(double force_step_N, double dt, double held_s);
  WallForce force_of_walls(const Wrench& constraint);
  // Displays the wrench of a tick to the hand, and returns the wrench whose opposite the bodies receive, both within all limits.
  // scale: factor on transient_N that `wanted` contains.
  Commanded output(const Wrench& wanted, double scale, const Eigen::Vector3d& transient_N, double dt);
  Commanded command(Wrench constraint, Eigen::Vector3d transient_N, double force_step_N, double dt);
  void distribute(const Wrench& felt_constraint);
  void fill_state(const TickInput& in, const Eigen::Vector3d& transient_N);
  sync::SampleStatus status(const TickInput& in) const;
  sync::Nanoseconds uncertainty() const;

  int tool_;
  std::int32_t tool_body_;
  std::vector<double> youngs_modulus_Pa_;
  Settings settings_;
  CouplingLimits coupling_;
  double period_s_, step_s_;

  Surfaces surfaces_;
  Reliefs reliefs_;
  ForceMethod force_method_;
  ForceCrossfade force_crossfade_, torque_crossfade_;
  LoopDelay loop_delay_;
  sync::Nanoseconds touch_delay_{0};  // of the previous tick
  Passivity passivity_;
  WallEnergy walls_;
  Transients transients_;
  Safety& safety_;
  ForceHistory commands_;  // to the device
  ForceStage force_stage_;
  Fade fade_;
  ContactImpulses impulses_;
  PendingOnsets pending_onsets_;

  bool started_ = false;
  sync::HostTime last_{};
  DeviceState device_;
  double device_share_ = 1;
  double rounded_share_ = 1;  // energy of the springs with rounded forces, in the last tick, relative to without
  double since_begin_s_ = 0, returning_s_ = 0;  // remaining time in which surfaces appear because touch begins or returns
  DeviceMotion motion_;  // since the last tick
  // Of the last tick: the part of hit transients in the reaction of the bodies, and in the force on the hand.
  Eigen::Vector3d felt_transient_N_ = Eigen::Vector3d::Zero(), shown_transient_N_ = Eigen::Vector3d::Zero();
  std::optional<sync::SimTime> model_time_;
  double model_age_s_ = 0, action_delay_s_ = 0;
  double stored_J_ = 0;  // energy in all springs of the coupling, in the last tick
  std::vector<Eigen::Vector3d> forces_;  // of each surface, before the limits
  std::vector<Eigen::Vector3d> arms_;    // from the proxy to each contact, if a torque is rendered
  std::vector<ContactForce> felt_;       // of each surface, as commanded
  TickOutput out_;
};

}  // namespace tactus::haptic
