// Forces of a tool on the bodies that it touches: the opposite of the force on the hand. The haptic loop and the
// simulation are not synchronized, so that 0, 1 or 2 messages arrive per step; cumulative impulses make the total
// exact. Pure.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tactus/tool_state_t.hpp>
#include <tactus/touch_applied_t.hpp>
#include <vector>
#include <tactus/header_t.hpp>
#include <tactus/tool_constraint_t.hpp>

#include "sim_node/model/body_motion.h"
#include "sim_node/model/ids.h"
#include "sim_node/settings.gen.h"
#include "sim_node/model/state_archive.h"
#include "sync/time/time.h"

namespace tactus::sim {

struct Push {
  std::int64_t contact_id = 0;
  int body = -1;
  Eigen::Vector3d force_N{0, 0, 0};  // on the body, world
  Eigen::Vector3d point_m{0, 0, 0};
};

class ToolPush {
 public:
  // reach_m: for each body, the maximum distance of a force from its centre of mass; points beyond are moved to this
  // distance.
  ToolPush(const Settings& settings, const Ids& ids, std::vector<double> reach_m)
      : settings_(settings), ids_(ids), reach_m_(std::move(reach_m)) {}

  // Pushes for the step that follows `now`. new_messages: messages of the one sender of the tool since the last call,
  // in order (tool_senders.h). The impulse that they report since the previous messages is applied as a mean force.
  // The remaining difference, caused by steps with no message or with two, is corrected over 5 steps. Without messages
  // the force is held, then fades. At most the force limit times the time since the last message is applied, and no
  // more than a held and fading force would have given. The first message of a sender only sets the start of its sums.
  // Forces on contact ids that this simulation never issued are ignored.
  const std::vector<Push>& step(sync::SimTime now, std::span<const tool_state_t> new_messages, std::span<const BodyMotion> bodies);
  // The same while the world is paused: impulses received meanwhile are never applied.
  void hold(sync::SimTime now, std::span<const tool_state_t> new_messages, std::span<const BodyMotion> bodies);
  // Call after the step: adds the work of the pushes.
  void add_work(std::span<const BodyMotion> bodies);

  void archive(StateArchive& a, std::size_t bodies);
  // Call when the world starts again under new ids: drops the impulses reported under the old ids. The next message
  // starts new sums.
  void reset();

  // Impulse and energy applied for each contact, most recent first.
  void applied_impulses(std::vector<touch_applied_t>& out, std::size_t max_count) const;

 private:
  static constexpr double kCorrectionSteps = 5;
  static constexpr std::size_t kMaxContacts = 64;

  struct ContactImpulses {
    std::int64_t since_ns = -1;  // begin of the reported sum on the sender's clock; -1: no sum yet
    int body = -1;
    Eigen::Vector3d point{0, 0, 0};
    Eigen::Vector3d reported{0, 0, 0};     // cumulative impulse on the tool in the newest message, N s
    Eigen::Vector3d received{0, 0, 0};     // the part reported in the newest messages, N s
    Eigen::Vector3d pending{0, 0, 0};     // to the body, not applied yet, N s
    Eigen::Vector3d mean_N{0, 0, 0};   // on the body, over the newest messages
    Eigen::Vector3d applied{0, 0, 0};  // to the body, N s
    Eigen::Vector3d velocity{0, 0, 0};  // of the point before the step, m/s
    double energy_J = 0;
    sync::SimTime used{};
  };
  bool is_repetition(const header_t& header) const;
  void follow(const header_t& header);
  void receive(std::span<const tool_state_t> new_messages, sync::SimTime now, std::span<const BodyMotion> bodies);
  void add_constraint(const tool_constraint_t& c, sync::SimTime now, std::span<const BodyMotion> bodies);

  Settings settings_;
  const Ids& ids_;
  std::vector<double> reach_m_;
  std::map<std::int64_t, ContactImpulses> impulses_;
  std::int64_t incarnation_ = 0;
  std::int64_t last_seq_ = -1;
  std::int64_t last_publish_ns_ = 0;  // 0: no message of this incarnation yet
  std::optional<sync::SimTime> last_message_;
  std::vector<Push> pushes_;
};

}  // namespace tactus::sim
