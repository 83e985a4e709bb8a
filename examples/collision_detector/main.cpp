// A sim_node with a detector of its own for balls: detector = custom:balls. All other pairs keep the default detector.
//
//    sim_with_balls SCENE.sdf --set detector=custom:balls
#include <stdexcept>

#include "sim_node/collision/detector.h"
#include "sim_node/run.h"

namespace {

using namespace tactus::sim;

// Two balls have one pair of nearest points, on the line through their centres.
class Balls : public Detector {
 public:
  DetectorAbilities abilities() const override {
    return {.name = "custom:balls", .separation = true, .both_surfaces = true, .one_pair = true, .deterministic = true};
  }

  int add(const ShapeDef& shape, const WorldDef&) override {
    if (shape.kind != ShapeKind::kSphere) throw std::runtime_error(unsupported_reason(shape.kind, shape.kind));
    radii_m_.push_back(shape.size_m.x());
    return static_cast<int>(radii_m_.size()) - 1;
  }

  void query(int a, const Eigen::Isometry3d& pose_a, int b, const Eigen::Isometry3d& pose_b, double reach_m, std::vector<PointPair>& out) override {
    out.clear();
    const double radius_a_m = radii_m_[static_cast<std::size_t>(a)], radius_b_m = radii_m_[static_cast<std::size_t>(b)];
    const Eigen::Vector3d between_m = pose_b.translation() - pose_a.translation();
    const double distance_m = between_m.norm();
    const double gap_m = distance_m - radius_a_m - radius_b_m;
    if (gap_m > reach_m) return;
    PointPair& pair = out.emplace_back();
    if (distance_m > 0) pair.normal = between_m / distance_m;  // equal centres: any direction is right
    pair.gap_m = gap_m;
    pair.on_a_m = pose_a.translation() + radius_a_m * pair.normal;
    pair.on_b_m = pose_b.translation() - radius_b_m * pair.normal;
  }

 protected:
  bool supports(ShapeKind a, ShapeKind b) const override { return a == ShapeKind::kSphere && b == ShapeKind::kSphere; }

 private:
  std::vector<double> radii_m_;
};

}  // namespace

int main(int argc, char** argv) {
  register_detector("balls", [] { return std::make_unique<Balls>(); });
  return run(argc, argv);
}
