#include "sim_node/scene/sdf/frames.h"

#include <algorithm>
#include <cmath>

#include "sim_node/scene/sdf/values.h"

namespace tactus::sim::sdf {
namespace {

constexpr double kZeroLength = 1e-6;  // of libignition-math: a shorter vector is not normalized

bool is_frame(std::string_view name) { return name == "link" || name == "joint" || name == "frame" || name == "model"; }

std::string relative_to_of(const Element& element) {
  const Element* pose = element.child("pose");
  return pose ? std::string(pose->value("relative_to")) : "";
}

}  // namespace

Frames::Frames(const Element& world) {
  add_scope(world, kNone);
  for (std::size_t scope = 0; scope < scopes_.size(); ++scope) connect(static_cast<int>(scope));
  // A circle is rejected even where nothing uses it. A joint whose child is not known may have no effect.
  for (std::size_t node = 0; node < nodes_.size(); ++node)
    if (nodes_[node].relative_to != kUnknown) resolve(static_cast<int>(node));
}

void Frames::add_scope(const Element& element, int model) {
  const int scope = static_cast<int>(scopes_.size());
  scopes_.push_back({&element, model});
  if (model != kNone) nodes_[static_cast<std::size_t>(model)].inner = scope;
  const std::string_view root_name = element.name == "model" ? "__model__" : "world";
  const int root = static_cast<int>(nodes_.size());
  nodes_.push_back({&element, scope});
  Node& root_node = nodes_.back();
  root_node.state = State::kDone;
  if (model == kNone) root_node.body_state = State::kDone;
  scopes_.back().root = root;
  scopes_.back().names[root_name] = root;
  std::vector<std::pair<const Element*, int>> models;
  for (const Element& child : element.children()) {
    if (!is_frame(child.name)) continue;
    const int node = add_node(child, scope, child.value("name"));
    if (child.name == "model") models.emplace_back(&child, node);
  }
  for (const auto& [inner, node] : models) add_scope(*inner, node);
}

int Frames::add_node(const Element& element, int scope, std::string_view name) {
  const int node = static_cast<int>(nodes_.size());
  nodes_.push_back({&element, scope});
  node_of_[&element] = node;
  scopes_[static_cast<std::size_t>(scope)].names.try_emplace(name, node);
  return node;
}

void Frames::connect(int scope) {
  const Scope& at = scopes_[static_cast<std::size_t>(scope)];
  for (const Element& child : at.element->children())
    if (is_frame(child.name)) connect_node(node_of_.at(&child));
}

void Frames::connect_node(int node) {
  Node& n = nodes_[static_cast<std::size_t>(node)];
  const Element& element = *n.element;
  n.raw = child_pose(element);
  const int root = scopes_[static_cast<std::size_t>(n.scope)].root;
  const std::string relative_to = relative_to_of(element);
  const std::string_view attached_to = element.name == "frame" ? element.value("attached_to") : std::string_view();
  if (!relative_to.empty())
    n.relative_to = find_or_reject(n.scope, relative_to, *element.child("pose"), "is relative to");
  else if (!attached_to.empty())
    n.relative_to = find_or_reject(n.scope, attached_to, element, "is attached to");
  else if (element.name == "joint")
    n.relative_to = find(n.scope, child_of(&element, "child") ? element.child("child")->text : std::string_view());
  else
    n.relative_to = root;
  if (element.name != "model") return;
  const std::string_view placement = element.value("placement_frame");
  if (!placement.empty()) n.placement = find_or_reject(n.inner, placement, element, "has the placement_frame");
}

int Frames::find(int scope, std::string_view name) const {
  while (true) {
    const auto& names = scopes_[static_cast<std::size_t>(scope)].names;
    if (const auto found = names.find(name); found != names.end()) return found->second;
    const auto colon = name.find("::");
    if (colon == std::string_view::npos) return kUnknown;
    const auto model = names.find(name.substr(0, colon));
    if (model == names.end()) return kUnknown;
    scope = nodes_[static_cast<std::size_t>(model->second)].inner;
    if (scope == kNone) return kUnknown;
    name.remove_prefix(colon + 2);
  }
}

int Frames::find_or_reject(int scope, std::string_view name, const Element& by, const char* what) const {
  const int node = find(scope, name);
  if (node == kUnknown)
    reject(by, std::string(what) + " \"" + std::string(name) + "\": there is no such link, joint, frame or model in " +
                   scope_name(scope));
  return node;
}

std::string Frames::scope_name(int scope) const {
  const Element& element = *scopes_[static_cast<std::size_t>(scope)].element;
  return "<" + std::string(element.name) + " name=\"" + std::string(element.value("name")) + "\">";
}

int Frames::node_of(const Element& element) const {
  const auto found = node_of_.find(&element);
  if (found == node_of_.end()) reject(element, "is no frame of this scene");
  return found->second;
}

int Frames::missing_above(int node, int scope) const {
  const Node* n = &nodes_[static_cast<std::size_t>(node)];
  if (n->state != State::kDone) return node;
  while (n->scope != scope) {
    const int model = scopes_[static_cast<std::size_t>(n->scope)].model;
    n = &nodes_[static_cast<std::size_t>(model)];
    if (n->state != State::kDone) return model;
  }
  return kNone;
}

int Frames::missing(const Node& node) const {
  if (node.relative_to == kUnknown) {
    const Element* child = node.element->child("child");
    reject(child ? *child : *node.element, "names no link, joint, frame or model of " + scope_name(node.scope));
  }
  const int above = missing_above(node.relative_to, node.scope);
  return above != kNone || node.placement == kNone ? above : missing_above(node.placement, node.inner);
}

Pose Frames::pose_in(int node, int scope) const {
  const Node* n = &nodes_[static_cast<std::size_t>(node)];
  Pose pose = n->pose;
  while (n->scope != scope) {
    n = &nodes_[static_cast<std::size_t>(scopes_[static_cast<std::size_t>(n->scope)].model)];
    pose = n->pose * pose;
  }
  return pose;
}

void Frames::place(Node& node) {
  const Pose edge =
      node.placement == kNone ? node.raw : node.raw * pose_in(node.placement, node.inner).inverse();
  const bool at_root = node.relative_to == scopes_[static_cast<std::size_t>(node.scope)].root;
  node.pose = at_root ? edge * Pose{} : pose_in(node.relative_to, node.scope) * edge;
  node.state = State::kDone;
}

// Without recursion: a chain of frames may be as long as the scene.
const Pose& Frames::resolve(int node) {
  std::vector<int> chain{node};
  while (!chain.empty()) {
    Node& n = nodes_[static_cast<std::size_t>(chain.back())];
    const int next = n.state == State::kDone ? kNone : missing(n);
    if (next == kNone) {
      if (n.state != State::kDone) place(n);
      chain.pop_back();
      continue;
    }
    n.state = State::kInProgress;
    if (nodes_[static_cast<std::size_t>(next)].state == State::kInProgress) reject_circle(chain, next, "relative to");
    chain.push_back(next);
  }
  return nodes_[static_cast<std::size_t>(node)].pose;
}

void Frames::reject_circle(const std::vector<int>& chain, int from, const char* relation) const {
  constexpr std::ptrdiff_t kMaxNamed = 5;
  std::string names;
  const auto begin = std::find(chain.begin(), chain.end(), from);
  for (auto at = begin; at != chain.end() && at - begin < kMaxNamed; ++at)
    names += (names.empty() ? "\"" : ", \"") + std::string(nodes_[static_cast<std::size_t>(*at)].element->value("name")) + "\"";
  if (chain.end() - begin > kMaxNamed) names += " and others";
  reject(*nodes_[static_cast<std::size_t>(from)].element,
         std::string("is ") + relation + " itself through " + names + ": remove one of these relations");
}

int Frames::next_body(int node) const {
  const Node& n = nodes_[static_cast<std::size_t>(node)];
  const Element& element = *n.element;
  if (const Scope& scope = scopes_[static_cast<std::size_t>(n.scope)]; scope.root == node) {
    const std::string_view canonical = element.value("canonical_link");
    if (!canonical.empty()) return find_or_reject(n.scope, canonical, element, "has the canonical_link");
    for (const char* type : {"link", "model"})
      for (const Element& child : element.children(type)) return node_of_.at(&child);
    reject(element, "has no link that a joint or frame could move with");
  }
  if (element.name == "model") return scopes_[static_cast<std::size_t>(n.inner)].root;
  if (element.name == "joint") {
    const Element* child = element.child("child");
    return child ? find_or_reject(n.scope, child->text, *child, "names") : kUnknown;
  }
  const std::string_view attached_to = element.value("attached_to");
  if (attached_to.empty()) return scopes_[static_cast<std::size_t>(n.scope)].root;
  return find_or_reject(n.scope, attached_to, element, "is attached to");
}

int Frames::body_of(int node) {
  std::vector<int> chain;
  while (nodes_[static_cast<std::size_t>(node)].body_state != State::kDone) {
    Node& n = nodes_[static_cast<std::size_t>(node)];
    if (n.body_state == State::kInProgress) reject_circle(chain, node, "attached to");
    if (n.element->name == "link") {
      n.body = node, n.body_state = State::kDone;
      break;
    }
    n.body_state = State::kInProgress;
    chain.push_back(node);
    const int next = next_body(node);
    if (next == kUnknown) reject(*n.element, "lacks its <child>");
    node = next;
  }
  const int body = nodes_[static_cast<std::size_t>(node)].body;
  for (const int each : chain) {
    nodes_[static_cast<std::size_t>(each)].body = body;
    nodes_[static_cast<std::size_t>(each)].body_state = State::kDone;
  }
  return body;
}

Pose Frames::pose(const Element& element) { return Pose{}.inverse() * resolve(node_of(element)); }

Pose Frames::pose_inside(const Element& element) {
  const Element& owner = *element.parent;
  const Pose raw = child_pose(element);
  const std::string relative_to = relative_to_of(element);
  const auto known = node_of_.find(&owner);
  const int scope = known == node_of_.end() ? 0 : nodes_[static_cast<std::size_t>(known->second)].scope;
  const int own = known == node_of_.end() ? scopes_.front().root : known->second;
  const int from = relative_to.empty() ? own : find_or_reject(scope, relative_to, *element.child("pose"), "is relative to");
  resolve(own);
  for (int next = missing_above(from, scope); next != kNone; next = missing_above(from, scope)) resolve(next);
  return pose_in(own, scope).inverse() * pose_in(from, scope) * raw;
}

Eigen::Vector3d Frames::direction(const Element& axis) {
  const Element* xyz = axis.child("xyz");
  Eigen::Vector3d direction = xyz ? vector3(*xyz) : Eigen::Vector3d::UnitZ();
  const double length = std::sqrt(direction.squaredNorm());
  if (length > kZeroLength) direction /= length;
  const int joint = node_of(*axis.parent);
  const int scope = nodes_[static_cast<std::size_t>(joint)].scope;
  const std::string_view frame = xyz ? xyz->value("expressed_in") : std::string_view();
  const int from = frame.empty() ? joint : find_or_reject(scope, frame, *xyz, "is expressed in");
  for (int next = missing_above(from, scope); next != kNone; next = missing_above(from, scope)) resolve(next);
  return (Pose{}.inverse() * pose_in(from, scope)).rotation * direction;
}

const Element* Frames::link(const Element& end_of_joint) {
  const int scope = nodes_[static_cast<std::size_t>(node_of(*end_of_joint.parent))].scope;
  if (end_of_joint.text == "world" && end_of_joint.name == "parent") return nullptr;
  const int node = find_or_reject(scope, end_of_joint.text, end_of_joint, "names");
  const int body = body_of(node);
  return body == kNone ? nullptr : nodes_[static_cast<std::size_t>(body)].element;
}

}  // namespace tactus::sim::sdf
