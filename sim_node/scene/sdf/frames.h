// The frames of a scene: poses of models, links, joints and frames by relative_to, attached_to, placement_frame and
// expressed_in, and the links that they move with. As SDFormat 1.9 specifies ("Pose frame semantics"), and as libsdformat 12
// computes it.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "sim_node/scene/sdf/element.h"
#include "sim_node/scene/sdf/pose.h"

namespace tactus::sim::sdf {

class Frames {
 public:
  // The frames of a <world>, or of the <model> inside <sdf>. The elements must outlive it. All functions throw
  // std::runtime_error with file, line and path: a name that is not known, or frames that are relative to each other in a
  // circle.
  explicit Frames(const Element& world);

  // Of a <model>, <link>, <joint> or <frame>, in the model or world that contains it.
  Pose pose(const Element& element);
  // Of a <collision>, <visual>, <light> or <sensor> in its link, or of a <light> in its world.
  Pose pose_inside(const Element& element);
  // Unit vector of an <axis>, in the frame of the model or world that contains the joint; its <xyz> when that is 0.
  Eigen::Vector3d direction(const Element& axis);
  // The link that the frame named by a <parent> or <child> moves with; nullptr: the world.
  const Element* link(const Element& end_of_joint);

 private:
  enum class State { kNew, kInProgress, kDone };
  static constexpr int kNone = -1, kUnknown = -2;
  struct Node {
    const Element* element = nullptr;
    int scope = 0;
    int inner = kNone;        // scope of a model
    int relative_to = kNone;  // node; kNone: a root; kUnknown: its name is not known
    int placement = kNone;    // node of the placement frame
    Pose raw = {}, pose = {};  // pose: in its scope, when kDone
    State state = State::kNew;
    State body_state = State::kNew;
    int body = kNone;  // node of its link, kNone: the world
  };
  // A world or a model, and the frames that it names.
  struct Scope {
    const Element* element = nullptr;
    int model = kNone;  // node of the model in the scope that contains it
    int root = kNone;   // node of the frame of the world or model
    std::unordered_map<std::string_view, int> names = {};
  };

  void add_scope(const Element& element, int model);
  int add_node(const Element& element, int scope, std::string_view name);
  void connect(int scope);
  void connect_node(int node);
  // kUnknown: there is none.
  int find(int scope, std::string_view name) const;
  int find_or_reject(int scope, std::string_view name, const Element& by, const char* what) const;

  const Pose& resolve(int node);
  // The first node that the pose of `node` depends on and that is not done; kNone: there is none.
  int missing(const Node& node) const;
  int missing_above(int node, int scope) const;
  void place(Node& node);
  // The pose of a node of an inner scope; every model in between is done.
  Pose pose_in(int node, int scope) const;
  int body_of(int node);
  int next_body(int node) const;
  [[noreturn]] void reject_circle(const std::vector<int>& chain, int from, const char* relation) const;
  std::string scope_name(int scope) const;
  int node_of(const Element& element) const;

  std::vector<Node> nodes_;
  std::vector<Scope> scopes_;
  std::unordered_map<const Element*, int> node_of_;
};

}  // namespace tactus::sim::sdf
