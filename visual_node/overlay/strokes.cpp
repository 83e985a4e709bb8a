#include "visual_node/overlay/strokes.h"

namespace tactus::visual {
namespace {

// Two unit vectors perpendicular to a line.
std::pair<Eigen::Vector3f, Eigen::Vector3f> across(const Eigen::Vector3f& along) {
  const Eigen::Vector3f u = along.unitOrthogonal();
  return {u, along.normalized().cross(u)};
}

bool drawable(const Eigen::Vector3f& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxCoordinate_m; }

}  // namespace

void append_line(std::vector<Stroke>& out, const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                 const Pen& pen) {
  if (!drawable(from) || !drawable(to)) return;
  Stroke s;
  s.from << from, pen.width_px;
  s.to << to, 1;
  s.colour = pen.colour;
  out.push_back(s);
}

void append_cross(std::vector<Stroke>& out, const Eigen::Vector3f& at, float length_m, const Pen& pen) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3f half = Eigen::Vector3f::Unit(axis) * length_m / 2;
    append_line(out, at - half, at + half, pen);
  }
}

void append_arrow(std::vector<Stroke>& out, const Eigen::Vector3f& from, const Eigen::Vector3f& along,
                  const Pen& pen) {
  if (!drawable(along) || along.squaredNorm() == 0) return;
  const Eigen::Vector3f tip = from + along;
  append_line(out, from, tip, pen);
  const auto [u, v] = across(along);
  const float barb = along.norm() / 4;
  for (const Eigen::Vector3f& side : {u, v, Eigen::Vector3f(-u), Eigen::Vector3f(-v)})
    append_line(out, tip, tip - along / 4 + side * barb / 2, pen);
}

void append_spring(std::vector<Stroke>& out, const Eigen::Vector3f& from, const Eigen::Vector3f& to, float width_m,
                   const Pen& pen) {
  const Eigen::Vector3f along = to - from;
  if (!drawable(along) || along.squaredNorm() == 0) return;
  const Eigen::Vector3f aside = across(along).first * width_m / 2;
  constexpr int kCorners = 2 * kSpringTurns;
  Eigen::Vector3f last = from;
  for (int i = 0; i < kCorners; ++i) {
    const float share = (static_cast<float>(i) + 0.5f) / kCorners;
    const Eigen::Vector3f corner = from + along * share + (i % 2 ? -aside : aside);
    append_line(out, last, corner, pen);
    last = corner;
  }
  append_line(out, last, to, pen);
}

void append_axes(std::vector<Stroke>& out, const Eigen::Isometry3d& pose, float length_m, const Pen& pen) {
  const Eigen::Vector3f at = pose.translation().cast<float>();
  for (int axis = 0; axis < 3; ++axis) {
    Pen own = pen;
    own.colour.head<3>() = Eigen::Vector3f::Constant(0.25f) + 0.75f * Eigen::Vector3f::Unit(axis);
    append_line(out, at, at + pose.linear().col(axis).cast<float>() * length_m, own);
  }
}

}  // namespace tactus::visual
