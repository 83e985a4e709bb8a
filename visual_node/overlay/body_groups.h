// Tracks which bodies are simulated in the haptic group (every step) and which are computed ahead in the visual
// group. Pure.
#pragma once

#include <Eigen/Core>
#include <map>
#include <tactus/world_state_t.hpp>
#include <vector>

namespace tactus::visual {

class BodyGroups {
 public:
  // Limit of body indices.
  static constexpr int kMaxBodies = 1 << 16;

  void push(const world_state_t& m);
  void reset() { *this = {}; }
  // For SceneView::tint: orange for the haptic group, blue for the visual group. A body without messages, such as
  // a static one, keeps its colour.
  std::vector<Eigen::Vector4f> tints(std::size_t bodies) const;
  std::size_t haptic() const { return count(false); }
  std::size_t visual() const { return count(true); }

 private:
  struct BodyGroup {
    std::int64_t seq = -1;
    bool ahead = false;
  };
  std::size_t count(bool ahead) const;
  std::map<int, BodyGroup> body_groups_;
  std::int64_t incarnation_ = 0;
};

}  // namespace tactus::visual
