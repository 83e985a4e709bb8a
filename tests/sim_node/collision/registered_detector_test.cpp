// Tests of detectors that another program registers.
#include <catch2/catch.hpp>
#include <stdexcept>

#include "sim_node/collision/detector.h"

using namespace tactus::sim;

namespace {

class NoContact : public Detector {
 public:
  DetectorAbilities abilities() const override { return {.name = "custom:no_contact", .separation = true}; }
  int add(const ShapeDef&, const WorldDef&) override { return 0; }
  void query(int, const Eigen::Isometry3d&, int, const Eigen::Isometry3d&, double, std::vector<PointPair>& out) override { out.clear(); }

 protected:
  bool supports(ShapeKind, ShapeKind) const override { return true; }
};

}  // namespace

TEST_CASE("A registered detector is made by its name, once, and another name is refused with one sentence") {
  register_detector("no_contact", [] { return std::make_unique<NoContact>(); });
  CHECK(make_detector("custom:no_contact")->abilities().name == "custom:no_contact");
  CHECK_THROWS_WITH(make_detector("custom:other"), Catch::Contains("\"custom:other\" is not part of this program; start the program that registers it"));
  CHECK_THROWS_AS(make_detector("no_contact"), std::runtime_error);
  CHECK_THROWS_AS(register_detector("no_contact", [] { return std::make_unique<NoContact>(); }), std::invalid_argument);
  CHECK_THROWS_AS(register_detector("", [] { return std::make_unique<NoContact>(); }), std::invalid_argument);
}
