#include "sim_node/scene/shapes.h"

#include <sstream>

#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
const char* kCube = R"(o cube
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";
ShapeDef only(SceneFile& file) {
  const WorldDef w = file.load();
  REQUIRE(w.shapes.size() == 1);
  return w.shapes.front();
}
}  // namespace

TEST_CASE("Every kind of geometry becomes its shape") {
  SceneFile file;
  const auto shape = [&](const std::string& geometry) {
    file.write("scene.sdf", link(collision(geometry)));
    return only(file);
  };
  ShapeDef s = shape("<box><size>1 2 3</size></box>");
  CHECK(s.kind == ShapeKind::kBox);
  CHECK(s.size_m == Vector3d(1, 2, 3));
  s = shape("<sphere><radius>0.5</radius></sphere>");
  CHECK(s.kind == ShapeKind::kSphere);
  CHECK(s.size_m == Vector3d(0.5, 0, 0));
  s = shape("<cylinder><radius>0.5</radius><length>2</length></cylinder>");
  CHECK(s.kind == ShapeKind::kCylinder);
  CHECK(s.size_m == Vector3d(0.5, 0, 2));
  s = shape("<capsule><radius>0.5</radius><length>2</length></capsule>");
  CHECK(s.kind == ShapeKind::kCapsule);
  CHECK(s.size_m == Vector3d(0.5, 0, 2));
  CHECK(file.warnings.empty());
  s = shape("<plane><normal>1 0 0</normal><size>4 5</size></plane>");
  CHECK(s.kind == ShapeKind::kPlane);
  CHECK(s.size_m == Vector3d(4, 5, 0));
  CHECK((s.pose.linear().col(2) - Vector3d::UnitX()).norm() < 1e-12);  // z of the shape is the normal
}

TEST_CASE("A size of zero or less is rejected with its line") {
  SceneFile file;
  const auto load_error = [&](const std::string& geometry) {
    file.write("scene.sdf", link(collision("\n" + geometry)));
    return file.load_error();
  };
  for (const std::string geometry :
       {"<box><size>1 0 3</size></box>", "<box><size>1 nan 3</size></box>", "<sphere><radius>-1</radius></sphere>",
        "<cylinder><radius>0.5</radius><length>0</length></cylinder>", "<box><size>1 inf 3</size></box>"}) {
    INFO(geometry);
    CHECK_THAT(load_error(geometry), Catch::StartsWith("scene.sdf:6: "));
  }
  CHECK_THAT(load_error("<plane><normal>0 0 0</normal><size>1 1</size></plane>"), Catch::Contains("scene.sdf:6"));
}

TEST_CASE("A mesh is found beside its file, scaled and shared by equal references") {
  SceneFile file(link("<collision name='a'><geometry><mesh><uri>cube.obj</uri><scale>2 1 1</scale></mesh></geometry>"
                      "</collision><visual name='b'><geometry><mesh><uri>model://cube.obj</uri><scale>2 1 1</scale></mesh>"
                      "</geometry></visual><visual name='c'><geometry><mesh><uri>file://cube.obj</uri></mesh></geometry></visual>"));
  file.write("cube.obj", kCube);
  const WorldDef w = file.load();
  REQUIRE(w.meshes.size() == 2);
  CHECK(w.shapes[0].mesh == w.visuals[0].shape.mesh);
  CHECK(w.meshes[0].indices.size() == 36);
  const Eigen::AlignedBox3d around = bounds(w, w.shapes[0]);
  CHECK((around.max() - Vector3d(2, 1, 1)).norm() < 1e-6);
  CHECK(w.meshes[0].normals.size() == w.meshes[0].vertices.size());
}

TEST_CASE("An unreadable mesh is rejected with file, line and remedy") {
  SceneFile file(link("<collision name='a'><geometry>\n<mesh><uri>cube.obj</uri></mesh></geometry></collision>"));
  CHECK(file.load_error() == "scene.sdf:6: /sdf/world[@name=\"w\"]/model[@name=\"m\"]/link[@name=\"l\"]/collision[@name=\"a\"]/"
                          "geometry/mesh names \"cube.obj\", which is not found: put it beside the scene file");
  file.write("cube.obj", "this is no mesh");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:6: ") && Catch::Contains("cannot be read"));
  file.write("cube.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK_THAT(file.load_error(), Catch::StartsWith("scene.sdf:6: ") && Catch::Contains("cannot be read"));
  file.write("cube.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  CHECK_THAT(file.load_error(), Catch::Contains("zero area"));
}

TEST_CASE("The bounding box of a rotated shape is tight") {
  // Compared with points sampled on the surface: the largest of n on a circle is too small by at most r (1 -
  // cos(pi/n)).
  WorldDef w;
  ShapeDef s;
  s.pose = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());
  s.size_m = {0.3, 0, 0.8};
  constexpr int kAround = 2000;
  for (const auto kind : {ShapeKind::kCylinder, ShapeKind::kCapsule}) {
    s.kind = kind;
    const Eigen::AlignedBox3d box = bounds(w, s);
    Eigen::AlignedBox3d sampled;
    for (int i = 0; i < kAround; ++i) {
      const double a = 2 * EIGEN_PI * i / kAround;
      const Vector3d rim(0.3 * std::cos(a), 0.3 * std::sin(a), 0);
      for (const double z : {-0.4, 0.4}) {
        if (kind == ShapeKind::kCylinder) {
          sampled.extend(s.pose * (rim + Vector3d(0, 0, z)));
          continue;
        }
        for (int j = 0; j < 200; ++j) {
          const double b = EIGEN_PI * j / 200;
          sampled.extend(s.pose * Vector3d(rim.x() * std::sin(b), rim.y() * std::sin(b), z + 0.3 * std::cos(b)));
        }
      }
    }
    CHECK(box.contains(Eigen::AlignedBox3d(sampled.min() + Vector3d::Constant(1e-9), sampled.max() - Vector3d::Constant(1e-9))));
    CHECK((box.sizes() - sampled.sizes()).norm() < 2e-4);
  }
}

TEST_CASE("A mesh that is inside out touches like the right one, and a warning names it") {
  const std::string text = link(collision("<mesh><uri>cube.obj</uri></mesh>"));
  SceneFile right, wrong;
  right.write("scene.sdf", text), right.write("cube.obj", kCube);
  std::string turned;
  std::istringstream lines(kCube);
  for (std::string line; std::getline(lines, line); turned += line + "\n")
    if (line[0] == 'f') std::swap(line[2], line[8]), std::swap(line[4], line[6]);
  wrong.write("scene.sdf", text), wrong.write("cube.obj", turned);
  const WorldDef a = right.load(), b = wrong.load();
  CHECK(right.warnings.empty());
  REQUIRE(wrong.short_warnings().size() == 1);
  CHECK_THAT(wrong.short_warnings()[0], Catch::Contains("cube.obj") && Catch::Contains("12 triangles facing inwards are turned for contact"));
  const auto faces = [](const WorldDef& w) {
    const TriangleMesh& mesh = w.meshes[static_cast<std::size_t>(w.shapes.front().mesh)];
    std::vector<double> outwards;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(mesh.indices[i + k])]; };
      const Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
      outwards.push_back(normal.dot((at(0) + at(1) + at(2)) / 3 - Vector3d(0.5, 0.5, 0.5)));
      CHECK(mesh.normals[static_cast<std::size_t>(mesh.indices[i])].dot(normal) > 0);
    }
    return outwards;
  };
  for (const WorldDef* w : {&a, &b})
    for (const double outwards : faces(*w)) CHECK(outwards == Approx(0.5));
}

TEST_CASE("A plane or heightmap of a body that moves causes a warning that names the collision") {
  const auto warnings = [](const std::string& is_static, const std::string& geometry) {
    SceneFile file(world("<model name='m'>" + is_static + "<link name='l'><inertial><mass>1</mass></inertial><collision name='c'><geometry>" + geometry +
                         "</geometry></collision></link></model>"));
    file.load();
    return file.short_warnings();
  };
  const auto moving = warnings("", "<plane><size>1 1</size></plane>");
  REQUIRE(moving.size() == 1);
  CHECK_THAT(moving[0], Catch::Contains("collision[@name=\"c\"] is a plane of a body that moves") && Catch::Contains("use a <box>"));
  CHECK(warnings("<static>true</static>", "<plane><size>1 1</size></plane>").empty());
  CHECK(warnings("", "<box><size>1 1 1</size></box>").empty());
}
