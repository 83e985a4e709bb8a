// What a tool does to the bodies that it touches: the opposite of the force that the hand feels. The haptic loop and the
// simulation are not in step, so 0, 1 or 2 messages come a step; cumulative impulses keep the books right. Pure.
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
  // reach_m: of each body, how far from its centre of mass a force may act; what is told beyond is drawn in.
  ToolPush(const Settings& settings, const Ids& ids, std::vector<double> reach_m)
      : settings_(settings), ids_(ids), reach_m_(std::move(reach_m)) {}

  // The pushes for the step that follows `now`. news: messages of the tool since the last call, in order. What they say
  // was felt since those before is applied as a mean force; what is still owed or was given too much, because a step had
  // no message or two, is made up for over 5 steps. Without news the force is held, then fades. A new haptic process
  // counts its impulses from zero; forces on contacts that this simulation never named are ignored.
  const std::vector<Push>& step(sync::SimTime now, std::span<const tool_state_t> news, std::span<const BodyMotion> bodies);
  // The same while the world stands still: what is felt meanwhile pushes nothing, then or later.
  void hold(sync::SimTime now, std::span<const tool_state_t> news, std::span<const BodyMotion> bodies);
  // After the step: books the work that the pushes did.
  void settle(std::span<const BodyMotion> bodies);

  void archive(StateArchive& a, std::size_t bodies);
  // The world began anew under new ids: what the hand said before is of another life. The next message begins new books.
  void forget();

  // What was applied for each contact, the latest first, at most `most`.
  void books(std::vector<touch_applied_t>& out, std::size_t most) const;

 private:
  static constexpr double kMakeUpSteps = 5;
  static constexpr std::size_t kRemembered = 64;

  struct Account {
    int body = -1;
    Eigen::Vector3d point{0, 0, 0};
    Eigen::Vector3d told{0, 0, 0};     // cumulative impulse on the tool as of the newest message, N s
    Eigen::Vector3d felt{0, 0, 0};     // of that, in the newest messages
    Eigen::Vector3d owed{0, 0, 0};     // to the body, not applied yet, N s
    Eigen::Vector3d mean_N{0, 0, 0};   // on the body, over the newest messages
    Eigen::Vector3d applied{0, 0, 0};  // to the body, N s
    Eigen::Vector3d velocity{0, 0, 0};  // of the point, before the step, m/s
    double energy_J = 0;
    sync::SimTime used{};
  };
  bool accept(const header_t& header);
  void take(std::span<const tool_state_t> news, sync::SimTime now, std::span<const BodyMotion> bodies);
  void note(const tool_constraint_t& c, sync::SimTime now, std::span<const BodyMotion> bodies);

  Settings settings_;
  const Ids& ids_;
  std::vector<double> reach_m_;
  std::map<std::int64_t, Account> accounts_;
  std::int64_t incarnation_ = 0, replaced_ = 0;
  std::int64_t last_seq_ = -1;
  std::int64_t last_publish_ns_ = 0;  // 0: none of this incarnation yet
  std::optional<sync::SimTime> heard_;
  std::vector<Push> pushes_;
};

}  // namespace tactus::sim
