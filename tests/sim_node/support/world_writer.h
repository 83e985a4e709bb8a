// Worlds as scene files, so that a world that broke a law can be kept as a test.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/sim_node/support/random_worlds.h"

namespace tactus::sim::test {

class WorldWriter {
 public:
  // Writes FOLDER/NAME.sdf, and an OBJ file beside it for each mesh. Returns the path. Throws std::runtime_error with one
  // sentence for joints and heightmaps, which it does not write, and when a file cannot be written.
  static std::filesystem::path write(const RandomWorld& w, const std::string& says, const std::filesystem::path& folder, const std::string& name) {
    if (!w.world.joints.empty() || !w.world.heightfields.empty())
      throw std::runtime_error("world_writer: " + name + " has joints or a heightmap, which are not written; draw it again by its family and seed");
    std::filesystem::create_directories(folder);
    WorldWriter out(w, folder, name);
    out.add_world(says);
    const std::filesystem::path file = folder / (name + ".sdf");
    save(file, out.text_.str());
    return file;
  }

 private:
  WorldWriter(const RandomWorld& w, const std::filesystem::path& folder, const std::string& name) : w_(w), folder_(folder), name_(name) {
    text_.precision(17);
  }
  static void save(const std::filesystem::path& file, const std::string& text) {
    std::ofstream out(file);
    out << text;
    if (!out.flush()) throw std::runtime_error("world_writer: cannot write " + file.string() + "; free space or choose another folder");
  }
  void add_world(const std::string& says) {
    const char* expected = w_.expectation == Expectation::kRests ? "rest" : w_.expectation == Expectation::kMomentum ? "momentum" : "mild";
    text_ << "<?xml version=\"1.0\"?>\n<!--\n" << says << "\nseconds " << w_.seconds << "\nexpect " << expected << "\n" << (w_.touching ? "touching\n" : "") << "-->\n"
          << "<sdf version=\"1.9\" xmlns:tactus=\"https://tactus.dev/sdf\">\n<world name=\"case\">\n <gravity>";
    add(w_.world.gravity_m_s2);
    text_ << "</gravity>\n";
    for (std::size_t i = 0; i < w_.world.bodies.size(); ++i) add_body(i);
    text_ << "</world>\n</sdf>\n";
  }
  void add_body(std::size_t i) {
    const BodyDef& b = w_.world.bodies[i];
    text_ << " <model name=\"b" << i << "\">\n  <static>" << (b.is_static ? "true" : "false") << "</static>\n  ";
    add(b.pose);
    text_ << "\n  <link name=\"l\">\n";
    if (!b.is_static) {
      const Eigen::Matrix3d& m = b.inertia_kg_m2;
      text_ << "   <inertial>";
      add(Eigen::Isometry3d(Eigen::Translation3d(b.centre_of_mass_m)));
      text_ << "<mass>" << b.mass_kg << "</mass><inertia><ixx>" << m(0, 0) << "</ixx><iyy>" << m(1, 1) << "</iyy><izz>" << m(2, 2) << "</izz><ixy>" << m(0, 1)
            << "</ixy><ixz>" << m(0, 2) << "</ixz><iyz>" << m(1, 2) << "</iyz></inertia></inertial>\n";
      add_rate("velocity", b.velocity_m_s);
      add_rate("spin", b.spin_rad_s);
    }
    for (const ShapeDef& s : w_.world.shapes)
      if (s.body == static_cast<int>(i)) add_shape(s);
    text_ << "  </link>\n </model>\n";
  }
  void add_rate(const char* name, const Eigen::Vector3d& value) {
    if (value.isZero(0)) return;
    text_ << "   <tactus:" << name << ">";
    add(value);
    text_ << "</tactus:" << name << ">\n";
  }
  void add_shape(const ShapeDef& s) {
    text_ << "   <collision name=\"c" << shapes_++ << "\">";
    add(s.pose);
    text_ << "<geometry>";
    add_geometry(s);
    text_ << "</geometry><surface><friction><ode><mu>" << s.friction << "</mu></ode></friction><bounce><restitution_coefficient>" << s.restitution
          << "</restitution_coefficient></bounce></surface></collision>\n";
  }
  void add_geometry(const ShapeDef& s) {
    const auto round = [&](const char* kind) {
      text_ << "<" << kind << "><radius>" << s.size_m.x() << "</radius>";
      if (s.kind != ShapeKind::kSphere) text_ << "<length>" << s.size_m.z() << "</length>";
      text_ << "</" << kind << ">";
    };
    switch (s.kind) {
      case ShapeKind::kSphere: return round("sphere");
      case ShapeKind::kCylinder: return round("cylinder");
      case ShapeKind::kCapsule: return round("capsule");
      case ShapeKind::kPlane: text_ << "<plane><normal>0 0 1</normal><size>" << s.size_m.x() << " " << s.size_m.y() << "</size></plane>"; return;
      case ShapeKind::kMesh: text_ << "<mesh><uri>" << save_mesh(w_.world.meshes[static_cast<std::size_t>(s.mesh)]) << "</uri></mesh>"; return;
      default: break;
    }
    text_ << "<box><size>";
    add(s.size_m);
    text_ << "</size></box>";
  }
  std::string save_mesh(const TriangleMesh& m) {
    std::ostringstream obj;
    obj.precision(17);
    for (const Eigen::Vector3d& v : m.vertices) obj << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
    for (std::size_t i = 0; i + 2 < m.indices.size(); i += 3) obj << "f " << m.indices[i] + 1 << " " << m.indices[i + 1] + 1 << " " << m.indices[i + 2] + 1 << "\n";
    const std::string file = name_ + "_" + std::to_string(meshes_++) + ".obj";
    save(folder_ / file, obj.str());
    return file;
  }
  void add(const Eigen::Vector3d& v) { text_ << v.x() << " " << v.y() << " " << v.z(); }
  void add(const Eigen::Isometry3d& pose) {
    const Eigen::Quaterniond q(pose.linear());
    text_ << "<pose rotation_format=\"quat_xyzw\">";
    add(Eigen::Vector3d(pose.translation()));
    text_ << " " << q.x() << " " << q.y() << " " << q.z() << " " << q.w() << "</pose>";
  }

  const RandomWorld& w_;
  std::filesystem::path folder_;
  std::string name_;
  std::ostringstream text_;
  int shapes_ = 0, meshes_ = 0;
};

}  // namespace tactus::sim::test
