// Which bodies are simulated in the haptic group, with every step, and which are computed ahead in the visual one.
// Pure.
#pragma once

#include <Eigen/Core>
#include <map>
#include <tactus/world_state_t.hpp>
#include <vector>

namespace tactus::visual {

class Groups {
 public:
  // No scene has more bodies.
  static constexpr int kMaxBodies = 1 << 16;

  void push(const world_state_t& m);
  void forget() { *this = {}; }
  // As SceneView::tint: orange what is in the haptic group, blue what is in the visual one; a body that nobody
  // told of, as one that never moves, keeps its colour.
  std::vector<Eigen::Vector4f> tints(std::size_t bodies) const;
  std::size_t haptic() const { return count(false); }
  std::size_t visual() const { return count(true); }

 private:
  struct Told {
    std::int64_t seq = -1;
    bool ahead = false;
  };
  std::size_t count(bool ahead) const;
  std::map<int, Told> told_;
  std::int64_t incarnation_ = 0;
};

}  // namespace tactus::visual
