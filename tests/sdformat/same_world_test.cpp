// The reader of scenes gives the same world as libsdformat 12, where that is installed: random worlds and all scenes.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <tactus/light_def_t.hpp>

#include <sdf/sdf.hh>

#include "lcmtypes/vectors.h"
#include "sim_node/scene/load_sdf.h"
#include "tests/sdformat/random_world.h"
#include "tests/source_dir.h"

namespace {

namespace fs = std::filesystem;
using tactus::sim::BodyDef;
using tactus::sim::ShapeKind;
using tactus::sim::WorldDef;

// Positions are below 100 m: 1e-12 is about a hundred roundings.
constexpr double kSame = 1e-12;
constexpr double kNoLimit = 1e16;  // as SDF writes it

Eigen::Vector3d eigen(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }
Eigen::Vector3d eigen(const ignition::math::Color& c) { return {c.R(), c.G(), c.B()}; }
Eigen::Isometry3d eigen(const ignition::math::Pose3d& p) {
  return Eigen::Translation3d(eigen(p.Pos())) * Eigen::Quaterniond(p.Rot().W(), p.Rot().X(), p.Rot().Y(), p.Rot().Z()).normalized();
}

// Relative to the largest entry when that is above 1.
template <typename Matrix>
double difference(const Matrix& a, const Matrix& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1.0, b.cwiseAbs().maxCoeff());
}
double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) { return difference(a.matrix(), b.matrix()); }

Eigen::Isometry3d resolved(const sdf::SemanticPose& pose, const std::string& to = "") {
  ignition::math::Pose3d result;
  const sdf::Errors errors = pose.Resolve(result, to);
  for (const auto& error : errors) UNSCOPED_INFO(error.Message());
  CHECK(errors.empty());
  return eigen(result);
}

// Numbers of compared elements: a test that compares nothing fails.
struct Count {
  int bodies = 0, shapes = 0, visuals = 0, joints = 0, lights = 0;
};

class Comparison {
 public:
  Comparison(const WorldDef& world, Count& count) : world_(world), count_(count) {}

  void model(const sdf::Model& model, const Eigen::Isometry3d& around, const std::string& scope, bool is_static) {
    const Eigen::Isometry3d pose = around * resolved(model.SemanticPose());
    const std::string inner = scope + model.Name() + "::";
    is_static = is_static || model.Static();
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) link(*model.LinkByIndex(i), pose, inner, is_static);
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) this->model(*model.ModelByIndex(i), pose, inner, is_static);
    for (std::uint64_t i = 0; i < model.JointCount(); ++i) joint(*model.JointByIndex(i), pose, inner, is_static);
  }

  void light(const sdf::Light& from, const Eigen::Isometry3d& around) {
    INFO("light " << from.Name());
    REQUIRE(static_cast<std::size_t>(count_of_lights_) < world_.lights.size());
    const tactus::light_def_t& l = world_.lights[static_cast<std::size_t>(count_of_lights_++)];
    const Eigen::Isometry3d pose = around * resolved(from.SemanticPose());
    CHECK(l.name == from.Name());
    CHECK(difference(tactus::to_eigen(l.pose), pose) <= kSame);
    CHECK(difference(tactus::to_eigen(l.direction), Eigen::Vector3d((pose.linear() * eigen(from.Direction())).normalized())) <= kSame);
    CHECK(l.diffuse.x == from.Diffuse().R());
    CHECK(l.specular.z == from.Specular().B());
    CHECK(l.range_m == static_cast<float>(from.AttenuationRange()));
    CHECK(l.attenuation_linear == static_cast<float>(from.LinearAttenuationFactor()));
    CHECK(l.attenuation_constant == static_cast<float>(from.ConstantAttenuationFactor()));
    CHECK(l.inner_angle_rad == static_cast<float>(from.SpotInnerAngle().Radian()));
    CHECK(l.outer_angle_rad == static_cast<float>(from.SpotOuterAngle().Radian()));
    CHECK((l.casts_shadow != 0) == from.CastShadows());
    ++count_.lights;
  }

 private:
  int body_of(const std::string& name) const {
    for (std::size_t i = 0; i < world_.bodies.size(); ++i)
      if (world_.bodies[i].name == name) return static_cast<int>(i);
    FAIL("no body " << name);
    return -1;
  }

  void link(const sdf::Link& from, const Eigen::Isometry3d& model_pose, const std::string& scope, bool is_static) {
    INFO("link " << scope << from.Name());
    const int index = body_of(scope + from.Name());
    const BodyDef& body = world_.bodies[static_cast<std::size_t>(index)];
    const Eigen::Isometry3d pose = model_pose * resolved(from.SemanticPose());
    CHECK(difference(body.pose, pose) <= kSame);
    CHECK(body.is_static == is_static);
    if (!is_static && from.Element()->HasElement("inertial") && from.Element()->GetElement("inertial")->HasElement("inertia"))
      inertia(from.Inertial(), body);
    for (std::uint64_t i = 0; i < from.CollisionCount(); ++i) {
      const sdf::Collision& c = *from.CollisionByIndex(i);
      shape(*c.Geom(), c.Name(), index, resolved(c.SemanticPose()), world_.shapes);
      ++count_.shapes;
    }
    for (std::uint64_t i = 0; i < from.VisualCount(); ++i) visual(*from.VisualByIndex(i), index);
    for (std::uint64_t i = 0; i < from.LightCount(); ++i) light(*from.LightByIndex(i), pose);
    ++count_.bodies;
  }

  static void inertia(const ignition::math::Inertiald& from, const BodyDef& body) {
    CHECK(body.mass_kg == from.MassMatrix().Mass());
    CHECK(difference(body.centre_of_mass_m, eigen(from.Pose().Pos())) <= kSame);
    const auto moi = from.Moi();  // in the axes of the link
    Eigen::Matrix3d matrix;
    for (unsigned r = 0; r < 3; ++r)
      for (unsigned c = 0; c < 3; ++c) matrix(r, c) = moi(r, c);
    CHECK(difference(body.inertia_kg_m2, matrix) <= kSame);
  }

  template <typename Shapes>
  void shape(const sdf::Geometry& geometry, const std::string& name, int body, const Eigen::Isometry3d& pose, const Shapes& shapes) {
    INFO("shape " << name);
    const tactus::sim::ShapeDef* found = nullptr;
    for (const auto& each : shapes)
      if (const auto& s = shape_of(each); s.name == name && s.body == body) found = &s;
    if (geometry.Type() == sdf::GeometryType::EMPTY || geometry.Type() == sdf::GeometryType::ELLIPSOID) return;
    REQUIRE(found);
    Eigen::Vector3d size = Eigen::Vector3d::Zero();
    Eigen::Isometry3d expected = pose;
    switch (geometry.Type()) {
      case sdf::GeometryType::BOX: size = eigen(geometry.BoxShape()->Size()); break;
      case sdf::GeometryType::SPHERE: size.x() = geometry.SphereShape()->Radius(); break;
      case sdf::GeometryType::CYLINDER: size << geometry.CylinderShape()->Radius(), 0, geometry.CylinderShape()->Length(); break;
      case sdf::GeometryType::CAPSULE: size << geometry.CapsuleShape()->Radius(), 0, geometry.CapsuleShape()->Length(); break;
      case sdf::GeometryType::PLANE:
        size << geometry.PlaneShape()->Size().X(), geometry.PlaneShape()->Size().Y(), 0;
        expected.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), eigen(geometry.PlaneShape()->Normal())));
        break;
      default: size = found->size_m;
    }
    CHECK(difference(found->pose, expected) <= kSame);
    CHECK(found->size_m == size);
  }
  static const tactus::sim::ShapeDef& shape_of(const tactus::sim::ShapeDef& s) { return s; }
  static const tactus::sim::ShapeDef& shape_of(const tactus::sim::VisualDef& v) { return v.shape; }

  void visual(const sdf::Visual& from, int body) {
    shape(*from.Geom(), from.Name(), body, resolved(from.SemanticPose()), world_.visuals);
    ++count_.visuals;
    const sdf::ElementPtr material = from.Element()->HasElement("material") ? from.Element()->GetElement("material") : nullptr;
    if (!material || !from.Material() || from.Geom()->Type() == sdf::GeometryType::MESH) return;  // a mesh that is missing has its own colour
    for (const auto& v : world_.visuals) {
      if (v.shape.name != from.Name() || v.shape.body != body) continue;
      const auto given = [&](const char* name) { return material->HasElement(name) && material->GetElement(name)->GetExplicitlySetInFile(); };
      if (given("diffuse")) CHECK(v.diffuse == eigen(from.Material()->Diffuse()));
      if (given("ambient")) CHECK(v.ambient == eigen(from.Material()->Ambient()));
      if (given("specular")) CHECK(v.specular == eigen(from.Material()->Specular()));
      if (given("emissive")) CHECK(v.emissive == eigen(from.Material()->Emissive()));
    }
  }

  void joint(const sdf::Joint& from, const Eigen::Isometry3d& model_pose, const std::string& scope, bool is_static) {
    INFO("joint " << scope << from.Name());
    std::string parent, child;
    CHECK(from.ResolveParentLink(parent).empty());
    CHECK(from.ResolveChildLink(child).empty());
    for (const auto& j : world_.joints) {
      if (j.name != scope + from.Name()) continue;
      CHECK(j.parent == (parent == "world" ? -1 : body_of(scope + parent)));
      CHECK(j.child == body_of(scope + child));
      CHECK(difference(j.anchor_m, Eigen::Vector3d((model_pose * resolved(from.SemanticPose(), "__model__")).translation())) <= kSame);
      for (unsigned i = 0; i < 2; ++i)
        if (from.Axis(i) && has_axis(from.Type())) axis(*from.Axis(i), model_pose, from.Type() != sdf::JointType::CONTINUOUS, j.axes[i]);
      ++count_.joints;
      return;
    }
    CHECK((is_static || !is_supported(from.Type())));  // left out
  }

  static bool has_axis(sdf::JointType type) { return type != sdf::JointType::FIXED && type != sdf::JointType::BALL; }
  static bool is_supported(sdf::JointType type) {
    return type != sdf::JointType::GEARBOX && type != sdf::JointType::SCREW && type != sdf::JointType::REVOLUTE2;
  }

  static void axis(const sdf::JointAxis& from, const Eigen::Isometry3d& model_pose, bool limited, const tactus::sim::JointAxis& axis) {
    ignition::math::Vector3d xyz;
    CHECK(from.ResolveXyz(xyz, "__model__").empty());
    CHECK(difference(axis.axis, Eigen::Vector3d((model_pose.linear() * eigen(xyz)).normalized())) <= kSame);
    CHECK(axis.damping == from.Damping());
    CHECK(axis.friction == from.Friction());
    CHECK(axis.stiffness == from.SpringStiffness());
    CHECK(axis.reference == from.SpringReference());
    if (limited) {
      CHECK(axis.lower == std::max(from.Lower(), -kNoLimit));
      CHECK(axis.upper == std::min(from.Upper(), kNoLimit));
    }
  }

  const WorldDef& world_;
  Count& count_;
  int count_of_lights_ = 0;
};

// False when libsdformat does not load it, and it does not have to.
bool compare(const fs::path& file, Count& count, bool must_load = true) {
  std::vector<std::string> warnings;
  WorldDef world;
  try {
    world = tactus::sim::load_sdf(file, warnings, {.confined = false});
  } catch (const std::runtime_error& e) {
    FAIL(e.what());
  }
  sdf::Console::Instance()->SetQuiet(true);
  sdf::ParserConfig config;
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetFindCallback([](const std::string&) { return std::string(); });
  for (const char* scheme : {"", "model://", "file://"}) config.AddURIPath(scheme, file.parent_path().string());
  sdf::ParserConfig::GlobalConfig() = config;  // included files are read with this one only
  sdf::Root root;
  const sdf::Errors errors = root.Load(file.string(), config);
  const sdf::World* from = root.WorldByIndex(0);
  if (must_load) {
    for (const auto& error : errors) UNSCOPED_INFO(error.Message());
    REQUIRE(errors.empty());
    REQUIRE(from);
  } else if (!errors.empty() || !from) {
    return false;
  }
  CHECK(difference(world.gravity_m_s2, eigen(from->Gravity())) <= kSame);
  Comparison comparison(world, count);
  for (std::uint64_t i = 0; i < from->LightCount(); ++i) comparison.light(*from->LightByIndex(i), Eigen::Isometry3d::Identity());
  for (std::uint64_t i = 0; i < from->ModelCount(); ++i)
    comparison.model(*from->ModelByIndex(i), Eigen::Isometry3d::Identity(), "", false);
  return true;
}

// A folder that is removed at the end.
struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "tactus_sdformat_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path = name;
  }
  ~Folder() { fs::remove_all(path); }
};

}  // namespace

TEST_CASE("Three hundred random worlds are the same as with libsdformat: poses, inertias, joints, geometries, materials and lights") {
  Count count;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const tactus::test::RandomWorld random(seed);
    const Folder folder;
    for (const auto& [name, text] : random.files()) {
      std::ofstream(folder.path / name) << text;
      UNSCOPED_INFO("--- " << name << "\n" << text);
    }
    INFO("seed " << seed);
    compare(folder.path / "scene.sdf", count);
  }
  CHECK(count.bodies > 900);
  CHECK(count.shapes > 500);
  CHECK(count.visuals > 500);
  CHECK(count.joints > 150);
  CHECK(count.lights > 200);
}

TEST_CASE("Every scene of the project is the same as with libsdformat") {
  Count count;
  for (const auto& entry : fs::directory_iterator(tactus::source_dir() + "/sim_node/scenes")) {
    if (entry.path().extension() != ".sdf") continue;
    INFO(entry.path().filename());
    compare(entry.path(), count);
  }
  CHECK(count.bodies > 50);
}

// Not among the tests that always run: TACTUS_WORLDS=DIR sdformat_test "[worlds]", for example for the worlds of gz-sim.
TEST_CASE("The worlds of a folder are the same as with libsdformat, where both load them", "[.][worlds]") {
  const char* folder = std::getenv("TACTUS_WORLDS");
  REQUIRE(folder);
  Count count;
  int compared = 0, refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".sdf" && entry.path().extension() != ".world") continue;
    std::vector<std::string> warnings;
    try {
      tactus::sim::load_sdf(entry.path(), warnings, {.confined = false});
    } catch (const std::runtime_error&) {
      continue;
    }
    INFO(entry.path());
    (compare(entry.path(), count, false) ? compared : refused) += 1;
  }
  WARN(compared << " worlds compared, with " << count.bodies << " bodies, " << count.shapes << " collisions, " << count.visuals
                << " visuals, " << count.joints << " joints and " << count.lights << " lights; libsdformat refused " << refused);
  CHECK(compared > 0);
}
