#include "sim_node/scene/view.h"

#include "tests/sim_node/support/scene_file.h"

using namespace tactus::sim;
using Eigen::Vector3d;

namespace {
WorldDef load_world(const std::string& inside) {
  SceneFile file(world(inside));
  const WorldDef w = file.load();
  CHECK(file.warnings.empty());
  return w;
}
const std::string kGui = "<gui><camera name='c'><pose>1 2 3 0 0 1.5707963267948966</pose></camera></gui>";
const std::string kSensor =
    "<model name='m'><static>true</static><pose>5 0 0 0 0 0</pose><link name='l'><sensor name='s' type='camera'><pose>0 0 1 0 0 0"
    "</pose><camera><horizontal_fov>0.75</horizontal_fov><image><width>4</width><height>3</height></image><clip><near>0.1</near>"
    "<far>9</far></clip></camera></sensor></link></model>";
}  // namespace

TEST_CASE("The camera is that of Tactus, then of the window, then of a sensor, then a default") {
  const WorldDef ours = load_world("<tactus:camera pose='0 0 1 0 0 0' fov='90deg'/>" + kGui);
  CHECK(ours.camera.translation() == Vector3d(0, 0, 1));
  CHECK(ours.camera_fov_rad == Approx(EIGEN_PI / 2));
  const WorldDef window = load_world(kGui + kSensor);
  CHECK(window.camera.translation() == Vector3d(1, 2, 3));
}

TEST_CASE("A camera sensor is used without a warning if there is no other camera") {
  const WorldDef w = load_world(kSensor);
  CHECK((w.camera.translation() - Vector3d(5, 0, 1)).norm() < 1e-9);
  CHECK(w.camera_fov_rad == 0.75);
}

TEST_CASE("The default camera shows every body") {
  const WorldDef w = load_world("<model name='a'><pose>3 4 0 0 0 0</pose><link name='l'>" + collision("<box><size>1 1 1</size></box>") +
                          "</link></model><model name='b'><pose>-1 0 2 0 0 0</pose><link name='l'>" +
                          collision("<sphere><radius>0.5</radius></sphere>") + "</link></model>");
  const double across = std::tan(w.camera_fov_rad / 2), up = across * 0.75;  // a picture of 4:3
  for (const BodyDef& b : w.bodies) {
    const Vector3d p = w.camera.inverse() * b.pose.translation();
    CHECK(p.x() > 0.5);
    CHECK(std::abs(p.y()) < across * p.x());
    CHECK(std::abs(p.z()) < up * p.x());
  }
  CHECK(w.camera.linear().determinant() == Approx(1));
}

TEST_CASE("A camera looks from one point at another, and the listener is at the camera unless placed") {
  const WorldDef w = load_world("<tactus:camera position='-1 0 1' look_at='0 0 0'/>");
  CHECK((w.camera.linear().col(0) - Vector3d(1, 0, -1).normalized()).norm() < 1e-9);
  CHECK(w.camera.linear().col(2).z() > 0);
  CHECK(w.listener.isApprox(w.camera));
  CHECK(load_world("<tactus:listener pose='1 1 1 0 0 0'/>").listener.translation() == Vector3d(1, 1, 1));
}

TEST_CASE("Ambient light and background come from the scene, otherwise from the defaults of SDF") {
  CHECK(load_world("").ambient == Vector3d(0.4, 0.4, 0.4));
  CHECK(load_world("").background == Vector3d(0.7, 0.7, 0.7));
  const WorldDef w = load_world("<scene><ambient>0.25 0.5 0.75 1</ambient><background>0 0 0 1</background></scene>");
  CHECK((w.ambient - Vector3d(0.25, 0.5, 0.75)).norm() < 1e-6);
  CHECK(w.background == Vector3d(0, 0, 0));
}

TEST_CASE("An invalid camera is rejected with its line") {
  const auto load_error = [](const std::string& element) {
    SceneFile file(world(element));
    return file.load_error();
  };
  CHECK_THAT(load_error("<tactus:camera/>"), Catch::StartsWith("scene.sdf:3: ") && Catch::Contains("lacks its pose"));
  CHECK_THAT(load_error("\n<tactus:camera pose='0 0 1 0 0'/>"), Catch::StartsWith("scene.sdf:4: ") && Catch::Contains("6 finite"));
  CHECK_THAT(load_error("<tactus:camera pose='0 0 nan 0 0 0'/>"), Catch::Contains("6 finite"));
  CHECK_THAT(load_error("<tactus:camera pose='0 0 1 0 0 0' fov='200deg'/>"), Catch::Contains("fov"));
  CHECK_THAT(load_error("<tactus:camera position='0 0 1'/>"), Catch::Contains("look_at"));
}
