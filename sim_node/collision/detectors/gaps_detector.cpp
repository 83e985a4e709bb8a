// Detector for every pair of shapes, with gaps. Balls and planes use closed forms, convex shapes use faces and
// nearest points, meshes are tested triangle by triangle, and meshes against meshes and boxes use the three layers.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "sim_node/collision/closest_surface.h"
#include "sim_node/collision/detector.h"
#include "sim_node/collision/detectors/mesh_trees.h"
#include "sim_node/collision/gaps/convex_pair.h"
#include "sim_node/collision/gaps/mesh_nearest.h"
#include "sim_node/collision/gaps/mesh_pair.h"
#include "sim_node/collision/nearest_first.h"

namespace tactus::sim {
namespace {

using Eigen::Isometry3d;

// A normal that leaves a surface by more than this is behind it. Cosine; half a degree.
constexpr double kBehind = 0.01;

bool has_triangles(ShapeKind k) { return k == ShapeKind::kMesh || k == ShapeKind::kHeightfield; }

struct GapShape {
  ShapeKind kind;
  bool half_space = false;
  gaps::Convex convex;
  Isometry3d offset = Isometry3d::Identity();  // of the convex body in the frame of the shape
  ClosestSurface surface;
  std::shared_ptr<const TriangleTree> tree;
  std::shared_ptr<const ContactMesh> layers;
  std::shared_ptr<const gaps::NormalCones> cones = nullptr;
  std::shared_ptr<const features::FeatureTrees> features = nullptr;
};

class GapsDetector : public Detector, public NearestFirstDetector {
 public:
  GapsDetector(const MeshContactOptions& options, std::shared_ptr<MeshTrees> trees)
      : trees_(std::move(trees)),
        contact_(options),
        nearest_(options.isa),
        default_modes_(options.mode == ContactMode::kComplete && options.remover == DuplicateRemover::kHashed) {}

  DetectorAbilities abilities() const override {
    return {.name = "gaps",
            .separation = true,
            .both_surfaces = true,
            .overlap_depth = true,
            .minimum_translation = true,
            .contact_kind = true,
            .one_pair = false,
            .deterministic = true};
  }

  int add(const ShapeDef& shape, const WorldDef& world) override {
    const bool meshed = has_triangles(shape.kind), plane = shape.kind == ShapeKind::kPlane;
    const bool fixed =
        shape.body < 0 || world.bodies.empty() || world.bodies.at(static_cast<std::size_t>(shape.body)).is_static;
    const gaps::Convex convex = gaps::convex_of(shape);
    ShapeDef solid = shape;
    if (plane && !fixed) solid.kind = ShapeKind::kBox, solid.size_m = 2 * convex.half_m;
    auto tree = meshed ? trees_->triangles(shape, world) : nullptr;
    GapShape s{solid.kind, plane && fixed, convex, Isometry3d::Identity(), {solid, tree}, tree, nullptr};
    if (plane) s.offset = gaps::plate_offset();
    // A box is also needed as triangles when the world has meshes or heightfields.
    const bool box = convex.core == gaps::Core::kBox && !(world.meshes.empty() && world.heightfields.empty());
    if (meshed || box) {
      s.layers = trees_->layers(shape, world);
      contact_.check_supported(*s.layers, *s.layers);
    }
    if (box) s.tree = trees_->triangles(shape, world);
    shapes_.push_back(std::move(s));
    return static_cast<int>(shapes_.size()) - 1;
  }

  void query(int a, const Isometry3d& pose_a, int b, const Isometry3d& pose_b, double reach_m,
             std::vector<PointPair>& out) override {
    out.clear();
    const GapShape &sa = shapes_[static_cast<std::size_t>(a)], &sb = shapes_[static_cast<std::size_t>(b)];
    const bool swapped = rank(sa) > rank(sb);
    if (swapped)
      ordered(sb, pose_b, sa, pose_a, reach_m, out);
    else
      ordered(sa, pose_a, sb, pose_b, reach_m, out);
    if (!swapped) return;
    for (PointPair& p : out) swap_sides(p);
  }

  void prepare_nearest_first(int a, int b) override {
    GapShape &sa = shapes_[static_cast<std::size_t>(a)], &sb = shapes_[static_cast<std::size_t>(b)];
    if (!default_modes_ || !has_triangles(sa.kind) || !has_triangles(sb.kind)) return;
    for (GapShape* s : {&sa, &sb}) {
      auto& cones = cones_[s->layers.get()];
      if (!cones) cones = std::make_shared<const gaps::NormalCones>(s->layers->tree);
      s->cones = cones;
      auto& trees = features_[s->layers.get()];
      if (!trees) trees = std::make_shared<const features::FeatureTrees>(s->layers->tree);
      s->features = trees;
    }
  }

  bool nearest_first(int a, const Isometry3d& pose_a, int b, const Isometry3d& pose_b, double reach_m,
                     PairVisitor& visitor, std::vector<PointPair>& scratch) override {
    const GapShape &sa = shapes_[static_cast<std::size_t>(a)], &sb = shapes_[static_cast<std::size_t>(b)];
    if (!sa.cones || !sb.cones) return false;
    nearest_.find({*sa.tree, *sa.layers, *sa.cones, *sa.features, pose_a},
                  {*sb.tree, *sb.layers, *sb.cones, *sb.features, pose_b}, reach_m, visitor, scratch);
    return true;
  }

 protected:
  bool supports(ShapeKind a, ShapeKind b) const override {
    const auto ground = [](ShapeKind k) { return k == ShapeKind::kPlane || k == ShapeKind::kHeightfield; };
    return !(ground(a) && ground(b));
  }

 private:
  static int rank(const GapShape& s) {
    if (s.kind == ShapeKind::kSphere) return 0;
    if (s.half_space) return 1;
    return has_triangles(s.kind) ? 3 : 2;
  }

  void ordered(const GapShape& a, const Isometry3d& pose_a, const GapShape& b, const Isometry3d& pose_b, double reach_m,
               std::vector<PointPair>& out) {
    if (a.kind == ShapeKind::kSphere) return ball(a.convex.round_m, pose_a.translation(), b, pose_b, reach_m, out);
    if (a.half_space && b.half_space) return;
    if (has_triangles(b.kind)) {
      if (a.half_space) return gaps::plane_mesh(pose_a, *b.tree, pose_b, reach_m, out);
      if (a.layers) return triangles(a, pose_a, b, pose_b, reach_m, out);
      gaps::convex_mesh(a.convex, pose_a, *b.tree, pose_b, reach_m, out);
      return ends(a, pose_a, b, pose_b, reach_m, out);
    }
    if (a.half_space) return gaps::plane_pair(pose_a, b.convex, pose_b * b.offset, reach_m, out);
    gaps::convex_pair(a.convex, pose_a * a.offset, b.convex, pose_b * b.offset, reach_m, out);
    if (out.empty()) return;
    ends(a, pose_a, b, pose_b, reach_m, out);
    const std::size_t first = out.size();
    ends(b, pose_b, a, pose_a, reach_m, out);
    for (std::size_t i = first; i < out.size(); ++i) swap_sides(out[i]);
  }

  // The other end of a tilted capsule may land within the same step.
  void ends(const GapShape& a, const Isometry3d& pose_a, const GapShape& b, const Isometry3d& pose_b, double reach_m,
            std::vector<PointPair>& out) {
    if (a.kind != ShapeKind::kCapsule) return;
    for (const double side : {-1.0, 1.0})
      ball(a.convex.round_m, pose_a * (side * a.convex.half_m), b, pose_b, reach_m, out);
  }

  static void swap_sides(PointPair& p) {
    std::swap(p.on_a_m, p.on_b_m);
    std::swap(p.triangle_a, p.triangle_b);
    p.normal = -p.normal;
  }

  void ball(double r, const Eigen::Vector3d& middle, const GapShape& b, const Isometry3d& pose_b, double reach_m,
            std::vector<PointPair>& out) {
    const Isometry3d pose = b.half_space || has_triangles(b.kind) ? pose_b : pose_b * b.offset;
    b.surface.query(pose.inverse(Eigen::Isometry) * middle, reach_m + r, planes_);
    for (const SurfacePlane& s : planes_) {
      PointPair p;
      p.normal = pose.linear() * -s.normal;
      p.on_a_m = middle + r * p.normal;
      p.on_b_m = pose * s.point;
      p.gap_m = s.distance_m - r;
      p.triangle_b = s.triangle;
      out.push_back(p);
    }
  }

  void triangles(const GapShape& a, const Isometry3d& pose_a, const GapShape& b, const Isometry3d& pose_b,
                 double reach_m, std::vector<PointPair>& out) {
    const bool box = !has_triangles(a.kind);
    const Isometry3d at = box ? pose_a * a.offset : pose_a;
    contact_.query(*a.layers, at, *b.layers, pose_b, {reach_m, kEqualShare * reach_m}, found_);
    const bool pierced = found_.pierced, flush = any_flush(*a.layers, at, *b.layers, pose_b);
    if (box && pierced && !flush) {
      gaps::convex_mesh(a.convex, at, *b.tree, pose_b, reach_m, out);
      if (!any_from_behind(*b.layers, pose_b, out)) return;
      out.clear();
    }
    const bool crosses = std::any_of(found_.pairs.begin(), found_.pairs.end(), [](const PointPair& p) { return p.pierced; });
    add_found(a, at, b, pose_b, pierced || flush, out);
    if (flush || (pierced && !crosses)) add_overlap_of_equals(a, at, b, pose_b, reach_m, out);
    const bool deep = std::any_of(out.begin(), out.end(), [](const PointPair& p) { return p.gap_m < -gaps::kMaxOriented_m; });
    if (!box || !deep) return;
    out.clear();
    gaps::convex_mesh(a.convex, at, *b.tree, pose_b, reach_m, out);
  }

  // Whether an overlap would push a surface of the mesh from inside: that of a side nearly in one plane with the box.
  static bool any_from_behind(const ContactMesh& mesh, const Isometry3d& pose, const std::vector<PointPair>& pairs) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const PointPair& p) {
      return p.gap_m < 0 && p.normal.dot(pose.linear() * mesh.tree.triangles()[static_cast<std::size_t>(p.triangle_b)].normal) > kBehind;
    });
  }

  // Bodies of equal size that overlap exactly on each other have no edge that passes inside a face. They have one when they
  // are moved aside a little, by less than the gap that contacts keep.
  void add_overlap_of_equals(const GapShape& a, const Isometry3d& pose_a, const GapShape& b, const Isometry3d& pose_b,
                             double reach_m, std::vector<PointPair>& out) {
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    const Eigen::Vector3d by_m = gaps::kFlush_m * Eigen::Vector3d(1.1, 1.7, 1.4);
    const Isometry3d aside = Eigen::Translation3d(by_m) * pose_b;
    contact_.query(*a.layers, pose_a, *b.layers, aside, {reach_m, kEqualShare * reach_m}, found_);
    add_found(a, pose_a, b, aside, true, out);
    const auto added = out.begin() + before;
    std::for_each(added, out.end(), [&](PointPair& p) {
      const double by = by_m.dot(p.normal);
      p.gap_m -= by;
      p.on_b_m -= by * p.normal;
    });
    const bool shallow = std::all_of(added, out.end(), [](const PointPair& p) { return p.gap_m > -gaps::kMaxOriented_m; });
    out.erase(std::remove_if(added, out.end(), [&](const PointPair& p) { return !shallow || p.gap_m >= -2 * gaps::kFlush_m; }), out.end());
    if (added == out.end()) return;
    // Sides that touch are no contact where the bodies overlap.
    out.erase(std::remove_if(out.begin(), added, [](const PointPair& p) { return std::abs(p.gap_m) <= gaps::kFlush_m; }), added);
  }

  // Appends the contacts of the pairs that were found. overlap: the bodies may overlap.
  void add_found(const GapShape& a, const Isometry3d& pose_a, const GapShape& b, const Isometry3d& pose_b, bool overlap,
                 std::vector<PointPair>& out) {
    for (PointPair& p : found_.pairs) {
      const Triangle &of_a = a.layers->tree.triangles()[static_cast<std::size_t>(p.triangle_a)],
                     &of_b = b.layers->tree.triangles()[static_cast<std::size_t>(p.triangle_b)];
      if (p.pierced)
        gaps::resolve_piercing(gaps::moved(of_a, pose_a), gaps::moved(of_b, pose_b), p);
      else if (!gaps::is_contact({*a.tree, pose_a, of_a}, {*b.tree, pose_b, of_b}, p))
        continue;
      else if (p.gap_m < gaps::kMaxOriented_m && !gaps::orient(gaps::moved(of_a, pose_a), gaps::moved(of_b, pose_b), overlap, p))
        continue;
      if (!has_triangles(a.kind)) p.triangle_a = -1;
      out.push_back(p);
    }
  }

  // Whether two faces with the same normal touch: sides of bodies of equal size.
  bool any_flush(const ContactMesh& a, const Isometry3d& pose_a, const ContactMesh& b, const Isometry3d& pose_b) const {
    return std::any_of(found_.pairs.begin(), found_.pairs.end(), [&](const PointPair& p) {
      return p.gap_m <= gaps::kFlush_m && gaps::are_flush(a.tree.triangles()[static_cast<std::size_t>(p.triangle_a)], pose_a,
                                                          b.tree.triangles()[static_cast<std::size_t>(p.triangle_b)], pose_b);
    });
  }

  std::shared_ptr<MeshTrees> trees_;
  MeshContact contact_;
  gaps::MeshNearest nearest_;
  bool default_modes_;  // false when another mode of layers 2 and 3 is selected for comparison
  std::vector<GapShape> shapes_;
  // One per mesh, like its tree.
  std::map<const ContactMesh*, std::shared_ptr<const gaps::NormalCones>> cones_;
  std::map<const ContactMesh*, std::shared_ptr<const features::FeatureTrees>> features_;
  std::vector<SurfacePlane> planes_;
  MeshContactResult found_;
};

}  // namespace

std::unique_ptr<Detector> make_gaps_detector(const MeshContactOptions& options, std::shared_ptr<MeshTrees> trees) {
  if (!trees) trees = std::make_shared<MeshTrees>();
  return std::make_unique<GapsDetector>(options, std::move(trees));
}

}  // namespace tactus::sim
