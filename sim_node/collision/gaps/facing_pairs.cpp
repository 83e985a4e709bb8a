#include "sim_node/collision/gaps/facing_pairs.h"

#include <Eigen/Geometry>
#include <bit>

namespace tactus::sim::gaps {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3f;
using Eigen::Vector3f;

// Rounding of a test in float per metre of the coordinates, as in LeafPairs.
constexpr double kRounding = 4e-6;

struct Motion {  // from one tree's frame to the other's
  Matrix3f rotation;
  Vector3f shift;
  Motion(const Isometry3d& to_from, const ObbTree& from, const ObbTree& to)
      : rotation(to_from.linear().cast<float>()), shift((to_from * from.origin() - to.origin()).cast<float>()) {}
};

// Bounding sphere of a box of a tree, with its cone of normals.
struct Ball {
  Vector3f centre;
  float radius;
  Vector3f axis, face;  // of the cone; normal of the triangle in a leaf
  float cosine, sine;
  bool leaf;
};

Ball ball_of(const ObbTree& tree, const NormalCones& cones, int node, int lane) {
  const WideNode& n = tree.nodes()[static_cast<std::size_t>(node)];
  const NormalCone& c = cones.of(node, lane);
  return {{n.centre[0][lane], n.centre[1][lane], n.centre[2][lane]},
          n.size[lane],
          c.axis,
          {n.axis[2][0][lane], n.axis[2][1][lane], n.axis[2][2][lane]},
          c.cosine,
          c.sine,
          n.child[lane] < 0};
}

// Transforms the box into the other tree's frame.
void move(const Motion& m, const WideNode& n, int lane, BoxQuery& q) {
  for (int k = 0; k < 3; ++k) {
    q.centre[k] = m.shift[k];
    for (int i = 0; i < 3; ++i) q.centre[k] += m.rotation(k, i) * n.centre[i][lane];
    q.half[k] = n.half[k][lane] + q.grow;
    for (int j = 0; j < 3; ++j) {
      q.axis[j][k] = 0;
      for (int i = 0; i < 3; ++i) q.axis[j][k] += m.rotation(k, i) * n.axis[j][i][lane];
    }
  }
}

void move(const Motion& m, Ball& b) {
  b.centre = m.rotation * b.centre + m.shift;
  b.axis = m.rotation * b.axis;
  b.face = m.rotation * b.face;
}

// Whether a connection from one ball to the other may lie within the cone. `way` connects the centres, and the
// connection deviates from it by at most r. straight() is the same for a connection along the normal of a leaf's
// triangle.
bool within(const Ball& b, const Vector3f& direction, float squared, float r) {
  const float high = std::abs(direction.dot(b.axis)), wide2 = squared - high * high,
              max_offset = r + high * b.sine;
  return wide2 * b.cosine * b.cosine <= max_offset * max_offset;
}
bool straight(const Ball& b, const Vector3f& direction, float squared, float r) {
  const float high = direction.dot(b.face);
  return squared - high * high <= r * r;
}

// A pair lies over a's face or over b's face, or is a local minimum of the distance on both.
bool may_meet(const Ball& a, const Ball& b, float reach, float slack) {
  const Vector3f direction = b.centre - a.centre;
  const float squared = direction.squaredNorm(), r = a.radius + b.radius + slack, far = reach + r;
  if (squared > far * far) return false;
  const bool in_a = within(a, direction, squared, r), in_b = within(b, direction, squared, r);
  if (in_a && in_b) return true;
  return (in_a && (!a.leaf || straight(a, direction, squared, r))) ||
         (in_b && (!b.leaf || straight(b, direction, squared, r)));
}

}  // namespace

FacingPairs::FacingPairs(Isa isa)
    : overlap_(isa == Isa::kAvx512 ? overlap_avx512
               : isa == Isa::kAvx2 ? overlap_avx2
                                   : overlap_baseline) {}

void FacingPairs::find(const Mesh& a, const Mesh& b, double reach_m, std::vector<std::pair<int, int>>& out) {
  out.clear();
  if (a.tree.empty() || b.tree.empty()) return;
  const Isometry3d b_from_a = b.pose.inverse(Eigen::Isometry) * a.pose;
  const Motion to_b(b_from_a, a.tree, b.tree), to_a(b_from_a.inverse(Eigen::Isometry), b.tree, a.tree);
  const double apart = (b_from_a * a.tree.origin() - b.tree.origin()).norm();
  const double size = a.tree.radius_m() + b.tree.radius_m() + reach_m;
  if (apart > size) return;
  const float reach = static_cast<float>(reach_m), slack = static_cast<float>(kRounding * (apart + size));
  BoxQuery query;
  query.slack = slack;
  query.grow = reach / 2 + slack;
  const auto &nodes_a = a.tree.nodes(), &nodes_b = b.tree.nodes();
  open_.clear();
  open_.push_back({{0, 0}, {0, 0}});
  while (!open_.empty()) {
    const Step s = open_.back();
    open_.pop_back();
    const WideNode &na = nodes_a[static_cast<std::size_t>(s.a.node)],
                   &nb = nodes_b[static_cast<std::size_t>(s.b.node)];
    const int child_a = na.child[s.a.lane], child_b = nb.child[s.b.lane];
    if (child_a < 0 && child_b < 0) {
      out.emplace_back(~child_a, ~child_b);
      continue;
    }
    const bool open_a = child_b < 0 || (child_a >= 0 && na.size[s.a.lane] > nb.size[s.b.lane]);
    Ball fixed =
        open_a ? ball_of(b.tree, b.cones, s.b.node, s.b.lane) : ball_of(a.tree, a.cones, s.a.node, s.a.lane);
    move(open_a ? to_a : to_b, fixed);
    const int child = open_a ? child_a : child_b;
    if (open_a)
      move(to_a, nb, s.b.lane, query);
    else
      move(to_b, na, s.a.lane, query);
    for (unsigned hit = overlap_((open_a ? nodes_a : nodes_b)[static_cast<std::size_t>(child)], query); hit;
         hit &= hit - 1) {
      const int lane = std::countr_zero(hit);
      if (open_a) {
        if (may_meet(ball_of(a.tree, a.cones, child, lane), fixed, reach, slack))
          open_.push_back({{child, lane}, s.b});
      } else if (may_meet(fixed, ball_of(b.tree, b.cones, child, lane), reach, slack)) {
        open_.push_back({s.a, {child, lane}});
      }
    }
  }
}

}  // namespace tactus::sim::gaps
