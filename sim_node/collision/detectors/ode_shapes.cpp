#include "sim_node/collision/detectors/ode_shapes.h"

#include <algorithm>

namespace tactus::sim::ode {
namespace {

// Two boxes have at most 8 points. Meshes have many more.
constexpr int kMaxRaw = 64;
// Static shapes are not tested against static shapes.
constexpr unsigned long kStatic = 1, kMoving = 2;

// The pose of a shape relative to its body's centre of mass.
Eigen::Isometry3d about_centre(const BodyDef& body, const Eigen::Isometry3d& in_body) {
  return Eigen::Translation3d(-body.centre_of_mass_m) * in_body;
}

// World pose of a geometry. For a box or mesh it is also the pose of the shape.
Eigen::Isometry3d pose(dGeomID geom) {
  dQuaternion q;
  dGeomGetQuaternion(geom, q);
  return Eigen::Translation3d(to_eigen(dGeomGetPosition(geom))) * quaternion(q);
}

}  // namespace

Shapes::Shapes(const WorldDef& world, const std::vector<dBodyID>& bodies, const Settings& settings)
    : space_(dHashSpaceCreate(nullptr)), chosen_(world, settings) {
  dSpaceSetCleanup(space_.get(), 1);
  for (std::size_t i = 0; i < world.shapes.size(); ++i) {
    const ShapeDef& shape = world.shapes[i];
    const BodyDef& body = world.bodies[static_cast<std::size_t>(shape.body)];
    body_of_.push_back(shape.body);
    is_mesh_shape_.push_back(shape.kind == ShapeKind::kMesh);
    if (body.tool >= 0) continue;
    const dBodyID id = bodies[static_cast<std::size_t>(shape.body)];
    const dGeomID geom = geoms_.make(world, shape, id == nullptr, body.pose * shape.pose);
    dGeomSetData(geom, reinterpret_cast<void*>(i));
    dGeomSetCategoryBits(geom, id ? kMoving : kStatic);
    dGeomSetCollideBits(geom, id ? kMoving | kStatic : kMoving);
    dSpaceAdd(space_.get(), geom);
    if (shape.kind == ShapeKind::kPlane && !id) continue;
    const Eigen::Isometry3d placed =
        Geoms::geom_pose(world, shape, id ? about_centre(body, shape.pose) : body.pose * shape.pose);
    dQuaternion q;
    set_quaternion(Eigen::Quaterniond(placed.linear()).normalized(), q);
    const Eigen::Vector3d p = placed.translation();
    if (id) {
      dGeomSetBody(geom, id);
      dGeomSetOffsetPosition(geom, p.x(), p.y(), p.z());
      dGeomSetOffsetQuaternion(geom, q);
    } else {
      dGeomSetPosition(geom, p.x(), p.y(), p.z());
      dGeomSetQuaternion(geom, q);
    }
  }
  for (const auto& [a, b] : world.no_collision) excluded_pairs_.emplace_back(std::min(a, b), std::max(a, b));
  std::sort(excluded_pairs_.begin(), excluded_pairs_.end());
  raw_.resize(kMaxRaw);
  found_.reserve(kMaxRaw);
}

bool Shapes::may_collide(int a, int b) const {
  return a != b && !std::binary_search(excluded_pairs_.begin(), excluded_pairs_.end(),
                                       std::pair(std::min(a, b), std::max(a, b)));
}

void Shapes::collide_by_ode(std::size_t a, dGeomID ga, std::size_t b, dGeomID gb) {
  const int count = dCollide(ga, gb, kMaxRaw, raw_.data(), sizeof(dContactGeom));
  found_.clear();
  for (int i = 0; i < count; ++i) {
    const dContactGeom& c = raw_[static_cast<std::size_t>(i)];
    ManifoldPoint p;
    p.point_m = to_eigen(c.pos);
    p.normal = -to_eigen(c.normal);  // ODE's normal points into its first geometry
    p.depth_m = c.depth;
    if (!p.normal.allFinite() || !p.point_m.allFinite() || std::abs(p.normal.norm() - 1) > 1e-3) continue;
    // For a capsule against a mesh, ODE also reports the near side of the axis, without depth.
    if (p.depth_m <= 0 && count > 1) continue;
    p.triangle_a = is_mesh_shape_[a] ? c.side1 : -1;
    p.triangle_b = is_mesh_shape_[b] ? c.side2 : -1;
    found_.push_back(p);
  }
}

void Shapes::near(void* self, dGeomID ga, dGeomID gb) {
  Shapes& s = *static_cast<Shapes*>(self);
  auto a = reinterpret_cast<std::size_t>(dGeomGetData(ga));
  auto b = reinterpret_cast<std::size_t>(dGeomGetData(gb));
  int body_a = s.body_of_[a], body_b = s.body_of_[b];
  if (!s.may_collide(body_a, body_b)) return;
  if (body_a > body_b) {
    std::swap(ga, gb);
    std::swap(a, b);
    std::swap(body_a, body_b);
  }
  const int ia = static_cast<int>(a), ib = static_cast<int>(b);
  if (!s.chosen_.supports(ia, ib) || !s.chosen_.query(ia, pose(ga), ib, pose(gb), s.found_))
    s.collide_by_ode(a, ga, b, gb);
  if (s.found_.empty()) return;
  Manifold& m = s.out_->emplace_back();
  m.shape_a = static_cast<int>(a), m.shape_b = static_cast<int>(b);
  m.body_a = body_a, m.body_b = body_b;
  reduce_points(s.found_, m);
}

// Visits all pairs whose bounding boxes are within the reach of each other, by sort and sweep along x. ODE's spaces
// report overlaps only.
void Shapes::sweep(double reach_m) {
  boxes_.clear();
  const int count = dSpaceGetNumGeoms(space_.get());
  for (int i = 0; i < count; ++i) {
    Box& box = boxes_.emplace_back();
    box.geom = dSpaceGetGeom(space_.get(), i);
    dGeomGetAABB(box.geom, box.side);
  }
  std::sort(boxes_.begin(), boxes_.end(), [](const Box& x, const Box& y) {
    return x.side[0] != y.side[0] ? x.side[0] < y.side[0] : dGeomGetData(x.geom) < dGeomGetData(y.geom);
  });
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    for (std::size_t j = i + 1; j < boxes_.size() && boxes_[j].side[0] <= boxes_[i].side[1] + reach_m; ++j) {
      const Box &x = boxes_[i], &y = boxes_[j];
      if (!(dGeomGetCategoryBits(x.geom) & dGeomGetCollideBits(y.geom))) continue;
      if (x.side[2] <= y.side[3] + reach_m && y.side[2] <= x.side[3] + reach_m && x.side[4] <= y.side[5] + reach_m &&
          y.side[4] <= x.side[5] + reach_m)
        near(this, x.geom, y.geom);
    }
}

void Shapes::collide(std::vector<Manifold>& out) {
  out.clear();
  out_ = &out;
  if (chosen_.shell_m() > 0)
    sweep(chosen_.shell_m());
  else
    dSpaceCollide(space_.get(), this, near);
  std::sort(out.begin(), out.end(), [](const Manifold& x, const Manifold& y) { return x.before(y); });
}

}  // namespace tactus::sim::ode
